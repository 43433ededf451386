// getrusage counts; a software perf event says where, by a ring that is read without a system call.
#include "tools/guards/page_faults.hpp"

#include <linux/perf_event.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstring>

#include "tools/guards/system_calls.hpp"

// Where the linker puts what touches the ring.
extern "C" const char __start_orcart_guard[], __stop_orcart_guard[];  // NOLINT(bugprone-reserved-identifier)

namespace orcart::guards {
namespace {

constexpr std::size_t kPage = 4096;
constexpr std::size_t kDataBytes = 16 * kPage;

perf_event_attr sampling_every_fault() {
  perf_event_attr attributes{};
  attributes.size = sizeof attributes;
  attributes.type = PERF_TYPE_SOFTWARE;
  attributes.config = PERF_COUNT_SW_PAGE_FAULTS;
  attributes.sample_period = 1;
  attributes.sample_type = PERF_SAMPLE_IP;
  attributes.exclude_kernel = 1;
  attributes.exclude_hv = 1;
  return attributes;
}

}  // namespace

std::uint64_t PageFaults::counted() noexcept {
  rusage usage{};
  unwatched_call(SYS_getrusage, {RUSAGE_THREAD, reinterpret_cast<long>(&usage)});
  return static_cast<std::uint64_t>(usage.ru_minflt) + static_cast<std::uint64_t>(usage.ru_majflt);
}

void PageFaults::open() noexcept {
  close();
  perf_event_attr attributes = sampling_every_fault();
  event_ = static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, PERF_FLAG_FD_CLOEXEC));
  if (event_ >= 0) {
    void* const ring = mmap(nullptr, kPage + kDataBytes, PROT_READ | PROT_WRITE, MAP_SHARED, event_, 0);
    ring_ = ring != MAP_FAILED ? ring : nullptr;
  }
  touch_ring();
  before_ = counted();
}

// The first access to each of its pages is a fault of ours, not of who is watched: made here, and its record
// dropped.
void PageFaults::touch_ring() noexcept {
  if (ring_ == nullptr) return;
  auto* const page = static_cast<perf_event_mmap_page*>(ring_);
  std::atomic_ref(page->data_tail).store(0, std::memory_order_release);
  const auto* const bytes = static_cast<const volatile unsigned char*>(ring_);
  for (std::size_t at = kPage; at < kPage + kDataBytes; at += kPage) (void)bytes[at];
  for (const void* at = nullptr; next_site(at);) {
  }
}

void PageFaults::close() noexcept {
  if (ring_ != nullptr) munmap(ring_, kPage + kDataBytes);
  if (event_ >= 0) ::close(event_);
  ring_ = nullptr;
  event_ = -1;
}

bool PageFaults::is_of_the_guard(const void* at) noexcept {
  const auto address = reinterpret_cast<std::uintptr_t>(at);
  return address >= reinterpret_cast<std::uintptr_t>(__start_orcart_guard) &&
         address < reinterpret_cast<std::uintptr_t>(__stop_orcart_guard);
}

__attribute__((section("orcart_guard"))) bool PageFaults::next_site(const void*& at) noexcept {
  if (ring_ == nullptr) return false;
  auto* const page = static_cast<perf_event_mmap_page*>(ring_);
  const auto* const data = static_cast<const unsigned char*>(ring_) + kPage;
  // The kernel's side of the ring: data_head is released by it, data_tail acquired.
  const std::uint64_t head = std::atomic_ref(page->data_head).load(std::memory_order_acquire);
  std::uint64_t tail = page->data_tail;
  bool found = false;
  while (tail < head && !found) {  // bound: what the ring holds
    perf_event_header header;      // records are multiples of 8 bytes, so neither part ever wraps
    std::memcpy(&header, data + tail % kDataBytes, sizeof header);
    if (header.type == PERF_RECORD_SAMPLE) {
      const void* address = nullptr;
      std::memcpy(&address, data + (tail + sizeof header) % kDataBytes, sizeof address);
      at = address;
      found = true;
    }
    tail += header.size;
  }
  std::atomic_ref(page->data_tail).store(tail, std::memory_order_release);
  return found;
}

}  // namespace orcart::guards
