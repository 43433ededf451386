// A TCP port as the emulated tracker's network side.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "tools/emulate/emulator_port.hpp"

namespace orcart {
namespace {

class TcpPort final : public EmulatorPort {
 public:
  TcpPort(FileDescriptor listener, std::string name) noexcept
      : listener_(std::move(listener)), name_(std::move(name)) {}

  const std::string& name() const override { return name_; }

  void wait(Nanos time) override {
    const timespec timeout{.tv_sec = time / 1s, .tv_nsec = (time % 1s).count()};
    pollfd watched{.fd = client_.valid() ? client_.get() : listener_.get(), .events = POLLIN, .revents = 0};
    ::ppoll(&watched, 1, &timeout, nullptr);
    if (!client_.valid() && (watched.revents & POLLIN) != 0) admit();
  }
  std::size_t read(std::span<std::byte> into) override {
    if (!client_.valid()) return 0;
    const ssize_t count = ::read(client_.get(), into.data(), into.size());
    if (count == 0 || (count < 0 && errno != EAGAIN)) client_.reset();
    return count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  void write(std::span<const std::byte> bytes) override {
    if (client_.valid()) ::send(client_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  std::uint32_t baud() override { return 0; }

 private:
  void admit() {
    client_ = FileDescriptor(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    const int on = 1;
    if (client_.valid()) ::setsockopt(client_.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }

  FileDescriptor listener_;
  FileDescriptor client_;
  std::string name_;
};

}  // namespace

Result<std::unique_ptr<EmulatorPort>> open_tcp_port(const ListenAddress& at) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(at.port);
  if (::inet_pton(AF_INET, at.address.c_str(), &address.sin_addr) != 1) {
    return fail("listen address " + at.address +
                " is none; an IPv4 address such as 127.0.0.1 would be accepted");
  }
  FileDescriptor listener(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  ::setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const bool listening = ::bind(listener.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
                         ::listen(listener.get(), 1) == 0;
  if (!listening) {
    return fail("TCP port " + std::to_string(at.port) + " of " + at.address + " cannot be listened on: " +
                std::strerror(errno) + "; a free port above 1023 would be accepted");
  }
  socklen_t size = sizeof address;
  ::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size);
  const std::string name = at.address + ":" + std::to_string(ntohs(address.sin_port));
  return std::make_unique<TcpPort>(std::move(listener), name);
}

}  // namespace orcart
