// Looks faults up by time and by reply.
#include "board/sim/ndi/fault_schedule.hpp"

#include <algorithm>
#include <utility>

namespace orcart {
namespace {

constexpr auto kNames = std::to_array<std::pair<std::string_view, NdiFault>>({
    {"silence", NdiFault::silence},
    {"late", NdiFault::late},
    {"truncated", NdiFault::truncated},
    {"garbage", NdiFault::garbage},
    {"bad-crc", NdiFault::bad_crc},
    {"wrong-handle", NdiFault::wrong_handle},
    {"frozen-frame", NdiFault::frozen_frame},
    {"infrared", NdiFault::infrared},
    {"disabled", NdiFault::disabled},
    {"unplugged", NdiFault::unplugged},
    {"reset", NdiFault::reset},
    {"bump", NdiFault::bump},
    {"alert", NdiFault::alert},
    {"cut", NdiFault::cut},
});

bool open_at(const NdiFaultWindow& window, Instant now) {
  return window.from <= now && now < window.until;
}

}  // namespace

std::optional<NdiFault> ndi_fault_named(std::string_view name) noexcept {
  for (const auto& [known, fault] : kNames) {
    if (known == name) return fault;
  }
  return std::nullopt;
}

bool NdiFaultSchedule::add(const NdiFaultWindow& window) noexcept {
  if (count_ == kMax) return false;
  windows_[count_++] = window;
  return true;
}

const NdiFaultWindow* NdiFaultSchedule::active(NdiFault fault, Instant now,
                                               std::uint64_t reply) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    const NdiFaultWindow& window = windows_[i];
    const bool due = window.every <= 1 || reply % window.every == 0;
    if (window.fault == fault && open_at(window, now) && due) return &window;
  }
  return nullptr;
}

bool NdiFaultSchedule::hits_tool(NdiFault fault, Instant now, std::int64_t tool) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (windows_[i].fault == fault && windows_[i].amount == tool && open_at(windows_[i], now)) return true;
  }
  return false;
}

std::optional<NdiFaultWindow> NdiFaultSchedule::take_due(NdiFault fault, Instant now) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (windows_[i].fault != fault || windows_[i].from > now) continue;
    const NdiFaultWindow due = windows_[i];
    windows_[i] = windows_[--count_];
    return due;
  }
  return std::nullopt;
}

Instant NdiFaultSchedule::next_reset() const noexcept {
  Instant next = Instant::max();
  for (std::size_t i = 0; i < count_; ++i) {
    if (windows_[i].fault == NdiFault::reset) next = std::min(next, windows_[i].from);
  }
  return next;
}

}  // namespace orcart
