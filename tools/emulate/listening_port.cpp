// A listening socket as the emulated tracker's far end: whoever connects is its client.
#include "tools/emulate/listening_port.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>

namespace orcart {

void ListeningPort::wait(Nanos time) {
  const timespec timeout{.tv_sec = time / 1s, .tv_nsec = (time % 1s).count()};
  // A negative descriptor is passed over: while the cable is out this only sleeps.
  const int speaker = said_all_ ? -1 : client_.get();
  std::array<pollfd, 2> watched{pollfd{.fd = speaker, .events = POLLIN | POLLRDHUP, .revents = 0},
                                pollfd{.fd = listener_.get(), .events = POLLIN, .revents = 0}};
  ::ppoll(watched.data(), watched.size(), &timeout, nullptr);
  if ((watched[1].revents & POLLIN) == 0) return;
  if (!client_.valid() || said_all_) return admit();
  // One that has hung up is read to its end first; the next waits at the door meanwhile.
  if ((watched[0].revents & (POLLRDHUP | POLLHUP | POLLERR)) == 0) turn_away();
}

void ListeningPort::turn_away() {
  const FileDescriptor second(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
}

std::size_t ListeningPort::read(std::span<std::byte> into) {
  if (!client_.valid() || said_all_) return 0;
  const ssize_t count = ::read(client_.get(), into.data(), into.size());
  if (count == 0) said_all_ = true;
  if (count < 0 && errno != EAGAIN) client_.reset();
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

void ListeningPort::write(std::span<const std::byte> bytes) {
  if (client_.valid()) ::send(client_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

void ListeningPort::owe_nothing() {
  if (said_all_) client_.reset();
  said_all_ = false;
}

void ListeningPort::cut() {
  client_.reset();
  said_all_ = false;
  listener_.reset();
}

void ListeningPort::mend() {
  if (listener_.valid()) return;
  if (auto listener = again_()) listener_ = std::move(*listener);  // else tried again at the next turn
}

void ListeningPort::admit() {
  client_ = FileDescriptor(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  arrived_ = client_.valid();
  said_all_ = false;
  const int on = 1;
  // Refused on a local socket, which holds nothing back.
  if (client_.valid()) ::setsockopt(client_.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

}  // namespace orcart
