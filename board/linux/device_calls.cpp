// The kernel's side of the seam.
#include "board/linux/device_calls.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

#include "realtime/kernel/clock.hpp"

namespace orcart {
namespace {

class SystemCalls final : public DeviceCalls {
 public:
  int open(const char* path, int flags) noexcept override {
    const int fd = ::open(path, flags | O_CLOEXEC);
    return fd < 0 ? -errno : fd;
  }
  void close(int fd) noexcept override { ::close(fd); }
  int control(int fd, unsigned long request, void* argument) noexcept override {
    int answer = 0;
    do {  // bound: as often as a signal comes in between
      answer = ::ioctl(fd, request, argument);
    } while (answer < 0 && errno == EINTR);
    return answer < 0 ? -errno : answer;
  }
  std::int64_t read(int fd, void* into, std::size_t size) noexcept override {
    const ssize_t count = ::read(fd, into, size);
    return count < 0 ? -errno : count;
  }
  void* map(int fd, std::size_t size, std::uint64_t offset) noexcept override {
    void* address = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd, static_cast<off_t>(offset));
    return address == MAP_FAILED ? nullptr : address;
  }
  void unmap(void* address, std::size_t size) noexcept override { ::munmap(address, size); }
  int wait(int fd, short events, Instant deadline) noexcept override {
    const std::int64_t left = std::max<std::int64_t>(0, (deadline - RealClock{}.now()).count());
    const timespec timeout{.tv_sec = left / 1'000'000'000, .tv_nsec = left % 1'000'000'000};
    pollfd watched{.fd = fd, .events = events, .revents = 0};
    return ::ppoll(&watched, 1, &timeout, nullptr) > 0 ? watched.revents : 0;
  }
};

}  // namespace

DeviceCalls& system_calls() noexcept {
  static SystemCalls calls;
  return calls;
}

}  // namespace orcart
