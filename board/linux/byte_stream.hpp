// Bytes to and from a file descriptor that never blocks: what serial lines and sockets have in common.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "board/linux/file_descriptor.hpp"
#include "board/ports/port_fault.hpp"
#include "realtime/base/instant.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// What errno says, as a port's fault.
PortFault port_fault_of(int error_number) noexcept;

/// One thread. The descriptor must be non-blocking.
class ByteStream {
 public:
  /// Takes over an open descriptor; anything unsent is dropped.
  void adopt(FileDescriptor descriptor) noexcept;
  void close() noexcept { adopt(FileDescriptor{}); }
  bool is_open() const noexcept { return descriptor_.valid(); }
  int descriptor() const noexcept { return descriptor_.get(); }

  /// All or nothing: what the kernel does not take at once is kept and goes out with the next call of any
  /// kind.
  Result<void, PortFault> write(std::span<const std::byte> bytes) noexcept;
  Result<std::size_t, PortFault> read(std::span<std::byte> into) noexcept;
  /// Until there is something to read, a fault, or the deadline.
  void wait(Instant deadline) noexcept;
  Instant last_arrival() const noexcept { return last_arrival_; }

 private:
  Result<void, PortFault> flush() noexcept;

  FileDescriptor descriptor_;
  std::array<std::byte, 4096> unsent_{};
  std::size_t unsent_size_ = 0;
  bool is_socket_ = false;
  Instant last_arrival_{};
};

}  // namespace orcart
