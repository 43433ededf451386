// The system calls that a device node needs, as one thin seam: tests play a driver behind it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "realtime/base/instant.hpp"

namespace orcart {

/// Every call answers at once but wait(). What fails answers with the negative error number and leaves errno
/// alone.
class DeviceCalls {
 public:
  virtual ~DeviceCalls() = default;
  /// A new descriptor, close-on-exec.
  virtual int open(const char* path, int flags) noexcept = 0;
  virtual void close(int fd) noexcept = 0;
  virtual int control(int fd, unsigned long request, void* argument) noexcept = 0;
  virtual std::int64_t read(int fd, void* into, std::size_t size) noexcept = 0;
  /// Shared and writable; null where the kernel refuses.
  virtual void* map(int fd, std::size_t size, std::uint64_t offset) noexcept = 0;
  virtual void unmap(void* address, std::size_t size) noexcept = 0;
  /// poll()'s revents of one descriptor, 0 at the deadline.
  virtual int wait(int fd, short events, Instant deadline) noexcept = 0;
};

/// The kernel's own. Interrupted calls are repeated, but for wait(). Any thread.
DeviceCalls& system_calls() noexcept;

/// One descriptor opened through a seam of calls, and closed through it.
class OpenDevice {
 public:
  OpenDevice() = default;
  OpenDevice(DeviceCalls& calls, int fd) noexcept : calls_(&calls), fd_(fd) {}
  OpenDevice(OpenDevice&& other) noexcept : calls_(other.calls_), fd_(other.fd_) { other.fd_ = -1; }
  OpenDevice& operator=(OpenDevice&& other) noexcept {
    if (this == &other) return *this;
    reset();
    calls_ = other.calls_;
    fd_ = other.fd_;
    other.fd_ = -1;
    return *this;
  }
  ~OpenDevice() { reset(); }

  bool valid() const noexcept { return fd_ >= 0; }
  int fd() const noexcept { return fd_; }
  void reset() noexcept {
    if (fd_ >= 0) calls_->close(fd_);
    fd_ = -1;
  }
  int control(unsigned long request, void* argument) const noexcept {
    return calls_->control(fd_, request, argument);
  }
  DeviceCalls& calls() const noexcept { return *calls_; }

 private:
  DeviceCalls* calls_ = nullptr;
  int fd_ = -1;
};

}  // namespace orcart
