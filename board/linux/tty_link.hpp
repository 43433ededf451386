// The tracker over a serial line of the kernel: a USB converter's /dev/ttyUSB0, a real port, a
// pseudo-terminal.
#pragma once

#include <memory>
#include <string>

#include "board/linux/byte_stream.hpp"
#include "board/ports/byte_link.hpp"

namespace orcart {

/// Opened at 9600 baud and for this program alone. One thread. send_break() takes up to half a second.
class TtyLink final : public ByteLink {
 public:
  /// Refused with the device's name and the remedy: absent, busy, no permission, no serial line.
  static Result<std::unique_ptr<TtyLink>> open(const std::string& device);

  Result<void, PortFault> write(std::span<const std::byte> bytes) noexcept override {
    return stream_.write(bytes);
  }
  Result<std::size_t, PortFault> read(std::span<std::byte> into) noexcept override {
    return stream_.read(into);
  }
  Instant last_arrival() const noexcept override { return stream_.last_arrival(); }
  void discard_input() noexcept override;
  Result<void, PortFault> set_line(const LineSettings& line) noexcept override;
  Result<void, PortFault> send_break() noexcept override;
  Result<void, PortFault> reopen() noexcept override;
  void wait(Instant deadline) noexcept override { stream_.wait(deadline); }

 private:
  explicit TtyLink(std::string device) noexcept : device_(std::move(device)) {}

  std::string device_;
  ByteStream stream_;
  LineSettings line_;
};

}  // namespace orcart
