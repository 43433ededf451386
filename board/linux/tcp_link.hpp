// The tracker over the network: a Polaris Vega listens on port 8765.
#pragma once

#include <netinet/in.h>

#include <memory>
#include <string>

#include "board/linux/byte_stream.hpp"
#include "board/ports/byte_link.hpp"

namespace orcart {

struct TcpAddress {
  std::string host;
  std::uint16_t port = 8765;
};

/// One thread. A network device has no line: set_line() changes nothing, send_break() is not supported.
class TcpLink final : public ByteLink {
 public:
  /// What reopen() waits at most: a device on the cart's network answers within a millisecond or is not
  /// there, and the thread that asks must not look hung (HeartbeatStage::kHung).
  static constexpr Nanos kReopenPatience = 100ms;
  /// Resolves the name once and connects within the patience; refused in a sentence.
  static Result<std::unique_ptr<TcpLink>> open(const TcpAddress& address, Nanos patience = 2s);

  Result<void, PortFault> write(std::span<const std::byte> bytes) noexcept override {
    return stream_.write(bytes);
  }
  Result<std::size_t, PortFault> read(std::span<std::byte> into) noexcept override {
    return stream_.read(into);
  }
  Instant last_arrival() const noexcept override { return stream_.last_arrival(); }
  void discard_input() noexcept override;
  Result<void, PortFault> set_line(const LineSettings&) noexcept override { return {}; }
  Result<void, PortFault> send_break() noexcept override { return tl::unexpected(PortFault::unsupported); }
  /// Blocks for kReopenPatience at most.
  Result<void, PortFault> reopen() noexcept override;
  void wait(Instant deadline) noexcept override { stream_.wait(deadline); }

 private:
  explicit TcpLink(const sockaddr_in& peer) noexcept : peer_(peer) {}
  Result<void, PortFault> connect(Nanos patience) noexcept;

  sockaddr_in peer_;
  ByteStream stream_;
};

}  // namespace orcart
