// Non-blocking reads and writes.
#include "board/linux/byte_stream.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

#include "realtime/kernel/clock.hpp"

namespace orcart {
namespace {

bool would_block(int error_number) {
  return error_number == EAGAIN || error_number == EINTR;
}

}  // namespace

PortFault port_fault_of(int error_number) noexcept {
  switch (error_number) {
    case EAGAIN:
      return PortFault::nothing_yet;
    case EBUSY:
      return PortFault::busy;
    case EACCES:
    case EPERM:
      return PortFault::no_permission;
    case EIO:
    case ENODEV:
    case ENXIO:
    case ENOENT:
    case EPIPE:
    case ENOTCONN:
    case ECONNRESET:
    case ECONNREFUSED:
      return PortFault::disconnected;
    case ETIMEDOUT:
      return PortFault::timed_out;
    case ENOTTY:
    case EINVAL:
      return PortFault::unsupported;
    default:
      return PortFault::io;
  }
}

void ByteStream::adopt(FileDescriptor descriptor) noexcept {
  descriptor_ = std::move(descriptor);
  unsent_size_ = 0;
  struct stat status {};
  is_socket_ = is_open() && ::fstat(descriptor_.get(), &status) == 0 && S_ISSOCK(status.st_mode);
}

Result<void, PortFault> ByteStream::flush() noexcept {
  if (unsent_size_ == 0) return {};
  // A socket whose other side is gone would end the program by a signal.
  const ssize_t sent = is_socket_ ? ::send(descriptor_.get(), unsent_.data(), unsent_size_, MSG_NOSIGNAL)
                                  : ::write(descriptor_.get(), unsent_.data(), unsent_size_);
  if (sent < 0 && !would_block(errno)) return tl::unexpected(port_fault_of(errno));
  if (sent > 0) {
    std::copy(unsent_.begin() + sent, unsent_.begin() + static_cast<std::ptrdiff_t>(unsent_size_),
              unsent_.begin());
    unsent_size_ -= static_cast<std::size_t>(sent);
  }
  return {};
}

Result<void, PortFault> ByteStream::write(std::span<const std::byte> bytes) noexcept {
  if (!is_open()) return tl::unexpected(PortFault::disconnected);
  if (bytes.size() > unsent_.size() - unsent_size_) return tl::unexpected(PortFault::timed_out);
  std::copy(bytes.begin(), bytes.end(), unsent_.begin() + static_cast<std::ptrdiff_t>(unsent_size_));
  unsent_size_ += bytes.size();
  return flush();
}

Result<std::size_t, PortFault> ByteStream::read(std::span<std::byte> into) noexcept {
  if (!is_open()) return tl::unexpected(PortFault::disconnected);
  if (const auto flushed = flush(); !flushed) return tl::unexpected(flushed.error());
  if (into.empty()) return std::size_t{0};
  const ssize_t count = ::read(descriptor_.get(), into.data(), into.size());
  if (count > 0) {
    last_arrival_ = RealClock{}.now();
    return static_cast<std::size_t>(count);
  }
  if (count < 0 && would_block(errno)) return std::size_t{0};
  // Shut at once, so that wait() sleeps from now on instead of finding the same fault again and again.
  const PortFault fault = count == 0 ? PortFault::disconnected : port_fault_of(errno);
  close();
  return tl::unexpected(fault);
}

void ByteStream::wait(Instant deadline) noexcept {
  RealClock clock;
  if (!is_open()) return clock.sleep_until(deadline);
  const std::int64_t left = std::max<std::int64_t>(0, (deadline - clock.now()).count());
  const timespec timeout{.tv_sec = left / 1'000'000'000, .tv_nsec = left % 1'000'000'000};
  const int wanted = POLLIN | (unsent_size_ > 0 ? POLLOUT : 0);
  pollfd watched{.fd = descriptor_.get(), .events = static_cast<short>(wanted), .revents = 0};
  ::ppoll(&watched, 1, &timeout, nullptr);
}

}  // namespace orcart
