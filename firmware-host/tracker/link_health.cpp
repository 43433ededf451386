// The verdicts on a polled tracker.
#include "firmware-host/tracker/link_health.hpp"

#include <algorithm>
#include <cmath>

namespace orcart {
namespace {

constexpr std::uint32_t kDamagedInARow = 3;
constexpr double kDamagedShare = 0.01;
/// A device that has just begun repeats frame 0 until its first measurement, and may measure slower than it
/// was told to.
constexpr Nanos kFirstFramePatience = 1s;

std::int64_t second_of(Instant t) noexcept {
  return nanos_since_zero(t) / 1'000'000'000;
}

}  // namespace

LinkHealth::LinkHealth(double poll_rate_hz, double device_rate_hz) noexcept
    : suspect_after_(std::max<Nanos>(50ms, 3 * period_of(poll_rate_hz))),
      lost_after_(std::max<Nanos>(100ms, 4 * period_of(poll_rate_hz))),
      stuck_after_(5 * period_of(std::min(poll_rate_hz, device_rate_hz)) / 2),
      tolerated_(static_cast<std::uint32_t>(
          std::max(1.0, std::ceil(kDamagedShare * static_cast<double>(kWindowSeconds) * poll_rate_hz)))) {}

void LinkHealth::begin(Instant now) noexcept {
  last_good_ = frame_changed_at_ = now;
  frame_ = 0;
  frame_seen_ = frame_stuck_ = false;
  frames_came_each_ = {};
  frame_rate_hz_ = 0;
  damaged_in_a_row_ = 0;
}

void LinkHealth::on_good_reply(Instant now) noexcept {
  last_good_ = now;
  damaged_in_a_row_ = 0;
}

void LinkHealth::on_damaged_reply(Instant now) noexcept {
  ++damaged_in_a_row_;
  const std::int64_t index = second_of(now);
  Second& second = window_[static_cast<std::size_t>(index) % kWindowSeconds];
  if (second.index != index) second = {.index = index};
  ++second.damaged;
}

/// Four are enough for a mean, and have come 0.1 s after the first at 60 Hz.
void LinkHealth::time_frames(Instant now) noexcept {
  constexpr int kFrames = 4;
  constexpr Nanos kCounted = 3s;
  if (!frame_seen_) {
    four_began_ = count_began_ = now;
    of_four_ = counted_ = 0;
    return;
  }
  if (++of_four_ == kFrames) {
    frames_came_each_ = (now - four_began_) / kFrames;
    four_began_ = now;
    of_four_ = 0;
  }
  ++counted_;
  if (now - count_began_ >= kCounted) {
    frame_rate_hz_ = counted_ / seconds(now - count_began_);
    count_began_ = now;
    counted_ = 0;
  }
}

Nanos LinkHealth::frame_patience() const noexcept {
  if (frames_came_each_ == Nanos{}) return std::max(stuck_after_, kFirstFramePatience);
  return std::max(stuck_after_, 5 * frames_came_each_ / 2);
}

bool LinkHealth::on_frame(std::uint32_t frame, Instant now) noexcept {
  const bool fresh = frame != frame_ && frame != 0;
  frame_ = frame;
  if (fresh) {
    time_frames(now);
    frame_seen_ = true;
    frame_changed_at_ = now;
  }
  frame_stuck_ = !fresh && now - frame_changed_at_ >= frame_patience();
  return fresh;
}

std::uint32_t LinkHealth::damaged_in_window(Instant now) const noexcept {
  const std::int64_t oldest = second_of(now) - static_cast<std::int64_t>(kWindowSeconds);
  std::uint32_t damaged = 0;
  for (const Second& second : window_) damaged += second.index > oldest ? second.damaged : 0;
  return damaged;
}

bool LinkHealth::line_is_bad(Instant now) const noexcept {
  return damaged_in_a_row_ >= kDamagedInARow || damaged_in_window(now) >= tolerated_;
}

Instant LinkHealth::next_verdict(Instant now) const noexcept {
  Instant next = Instant::max();
  for (const Instant at : {last_good_ + suspect_after_, last_good_ + lost_after_}) {
    if (at > now) next = std::min(next, at);
  }
  return next;
}

}  // namespace orcart
