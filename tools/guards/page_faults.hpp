// Counts the page faults of one thread, and where each of them happened where the kernel tells.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace orcart::guards {

/// The counting thread's own: open, then take() over and over, close.
class PageFaults {
 public:
  PageFaults() = default;
  PageFaults(const PageFaults&) = delete;
  PageFaults& operator=(const PageFaults&) = delete;
  ~PageFaults() { close(); }

  void open() noexcept;
  void close() noexcept;
  bool knows_sites() const noexcept { return ring_ != nullptr; }

  /// Faults since the last call, by the kernel's own count; calls `site(instruction)` for each whose place is
  /// known.
  template <class Site>
  std::uint64_t take(Site&& site) noexcept {
    const std::uint64_t now = counted();
    const std::uint64_t fresh = now - before_;
    before_ = now;
    for (const void* at = nullptr; next_site(at);) {
      if (is_of_the_guard(at))
        ++own_;
      else
        site(at);
    }
    // One of the guard's own may have been sampled before it is counted.
    const std::uint64_t own = std::min(own_, fresh);
    own_ -= own;
    return fresh - own;
  }

 private:
  static std::uint64_t counted() noexcept;
  bool next_site(const void*& at) noexcept;
  /// Whether reading the ring itself faulted: the kernel may take a page of it out of the table at any time.
  static bool is_of_the_guard(const void* at) noexcept;
  void touch_ring() noexcept;

  std::uint64_t before_ = 0, own_ = 0;
  int event_ = -1;
  void* ring_ = nullptr;
};

}  // namespace orcart::guards
