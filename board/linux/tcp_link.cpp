// Connects without ever blocking longer than it was told.
#include "board/linux/tcp_link.hpp"

#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

namespace orcart {
namespace {

Result<sockaddr_in> resolve(const TcpAddress& address) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(address.host.c_str(), nullptr, &hints, &found) != 0) {
    return fail("tracker host " + address.host +
                " is not known; a name or an address such as 169.254.9.239 is wanted");
  }
  sockaddr_in peer{};
  std::memcpy(&peer, found->ai_addr, sizeof peer);
  ::freeaddrinfo(found);
  peer.sin_port = htons(address.port);
  return peer;
}

/// Waits for a connection that is being made; its outcome as errno.
int outcome_of_connect(int fd, Nanos patience) noexcept {
  pollfd watched{.fd = fd, .events = POLLOUT, .revents = 0};
  const int ready = ::poll(&watched, 1, static_cast<int>(patience / 1ms));
  if (ready <= 0) return ETIMEDOUT;
  int error_number = 0;
  socklen_t size = sizeof error_number;
  ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error_number, &size);
  return error_number;
}

}  // namespace

Result<std::unique_ptr<TcpLink>> TcpLink::open(const TcpAddress& address, Nanos patience) {
  const auto peer = resolve(address);
  if (!peer) return tl::unexpected(peer.error());
  std::unique_ptr<TcpLink> link(new TcpLink(*peer));
  if (const auto opened = link->connect(patience); !opened) {
    return fail("tracker at " + address.host + ":" + std::to_string(address.port) + " does not answer (" +
                std::string(word_for(opened.error())) + "); switch it on, or name another host");
  }
  return link;
}

Result<void, PortFault> TcpLink::reopen() noexcept {
  return connect(kReopenPatience);
}

Result<void, PortFault> TcpLink::connect(Nanos patience) noexcept {
  stream_.close();
  FileDescriptor descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!descriptor.valid()) return tl::unexpected(port_fault_of(errno));
  const int on = 1;
  ::setsockopt(descriptor.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  const int begun = ::connect(descriptor.get(), reinterpret_cast<const sockaddr*>(&peer_), sizeof peer_);
  int error_number = begun == 0 ? 0 : errno;
  if (error_number == EINPROGRESS) error_number = outcome_of_connect(descriptor.get(), patience);
  if (error_number != 0) return tl::unexpected(port_fault_of(error_number));
  stream_.adopt(std::move(descriptor));
  return {};
}

void TcpLink::discard_input() noexcept {
  std::array<std::byte, 512> sink;
  for (int i = 0; i < 64; ++i) {
    const auto count = stream_.read(sink);
    if (!count || *count < sink.size()) return;
  }
}

}  // namespace orcart
