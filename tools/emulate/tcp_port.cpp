// A TCP port as the emulated tracker's network side.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "tools/emulate/listening_port.hpp"

namespace orcart {

namespace {

Result<FileDescriptor> listen_at(const ListenAddress& at) {
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
  return listener;
}

}  // namespace

Result<std::unique_ptr<EmulatorPort>> open_tcp_port(const ListenAddress& at) {
  auto listener = listen_at(at);
  if (!listener) return tl::unexpected(listener.error());
  sockaddr_in address{};
  socklen_t size = sizeof address;
  ::getsockname(listener->get(), reinterpret_cast<sockaddr*>(&address), &size);
  const ListenAddress same{.address = at.address, .port = ntohs(address.sin_port)};
  const std::string name = same.address + ":" + std::to_string(same.port);
  return std::make_unique<ListeningPort>(std::move(*listener), name, [same] { return listen_at(same); });
}

}  // namespace orcart
