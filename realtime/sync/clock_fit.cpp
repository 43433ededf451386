// Keeps the earliest arrival of each stretch of the window and lays the line under their lower convex hull.
#include "realtime/sync/clock_fit.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace orcart {
namespace {

/// Difference of two frame numbers that wrap at 2^32, -2^31 .. 2^31-1.
std::int64_t frames_between(std::uint32_t from, std::uint32_t to) {
  return static_cast<std::int32_t>(to - from);
}

/// Slope from a to b.
template <class Arrival>
double slope(const Arrival& a, const Arrival& b) {
  return (b.after_ns - a.after_ns) / static_cast<double>(b.frame - a.frame);
}

/// Leaves the lower convex hull at the front, in order; returns its size (Andrew 1979). Frames must rise.
template <class Arrival>
std::size_t lower_hull(std::span<Arrival> arrivals) {
  std::size_t size = 0;
  for (const Arrival& next : arrivals) {
    while (size >= 2 && slope(arrivals[size - 2], arrivals[size - 1]) >= slope(arrivals[size - 1], next))
      --size;
    arrivals[size++] = next;
  }
  return size;
}

}  // namespace

ClockFit::ClockFit(const ClockFitSettings& settings)
    : settings_(settings),
      period_ns_(1e9 / settings.rate_hz),
      frames_per_bin_(
          std::max<std::int64_t>(1, std::llround(seconds(settings.window) * settings.rate_hz / kBins))) {}

ClockFit::Seen ClockFit::observe(std::uint32_t device_frame, Instant arrived_at) noexcept {
  if (!started_) {
    restart(device_frame, arrived_at);
    return Seen::used;
  }
  const std::int64_t step = frames_between(last_device_frame_, device_frame);
  if (step == 0) return Seen::repeated;
  const std::int64_t frame = last_frame_ + step;
  const Arrival arrival{.frame = frame,
                        .after_ns = static_cast<double>((arrived_at - origin_).count()) - nominal_ns(frame)};
  if (jumped(step, arrival)) {
    ++restarts_;
    restart(device_frame, arrived_at);
    return Seen::restarted;
  }
  last_device_frame_ = device_frame;
  last_frame_ = frame;
  keep(arrival);
  fit();
  return Seen::used;
}

Instant ClockFit::host_time(std::uint32_t device_frame) const noexcept {
  if (!started_) return {};
  const std::int64_t frame = last_frame_ + frames_between(last_device_frame_, device_frame);
  return origin_ + Nanos{std::llround(nominal_ns(frame) + line_ns(frame))} - settings_.device_latency;
}

void ClockFit::restart(std::uint32_t device_frame, Instant arrived_at) noexcept {
  bins_.fill({});
  origin_ = arrived_at;
  last_device_frame_ = device_frame;
  last_frame_ = 0;
  offset_ns_ = slope_ns_ = 0;
  late_in_a_row_ = 0;
  settled_ = false;
  started_ = true;
  keep({});
}

bool ClockFit::jumped(std::int64_t step, const Arrival& arrival) noexcept {
  const double late_ns = arrival.after_ns - line_ns(arrival.frame);
  const bool late = late_ns > static_cast<double>(settings_.late_tolerance.count());
  late_in_a_row_ = late ? late_in_a_row_ + 1 : 0;
  return step < 0 || late_ns < -static_cast<double>(settings_.jump_tolerance.count()) ||
         late_in_a_row_ >= kLateInARow;
}

void ClockFit::keep(const Arrival& arrival) noexcept {
  const std::int64_t number = arrival.frame / frames_per_bin_;
  Bin& bin = bins_[static_cast<std::size_t>(number) % kBins];
  const bool earlier =
      arrival.after_ns - line_ns(arrival.frame) < bin.earliest.after_ns - line_ns(bin.earliest.frame);
  if (bin.number != number || earlier) bin = {.number = number, .earliest = arrival};
}

std::size_t ClockFit::arrivals_of_window(Arrivals& into) const noexcept {
  const std::int64_t newest = last_frame_ / frames_per_bin_;
  std::size_t count = 0;
  for (std::int64_t number = std::max<std::int64_t>(0, newest - static_cast<std::int64_t>(kBins) + 1);
       number <= newest; ++number) {
    const Bin& bin = bins_[static_cast<std::size_t>(number) % kBins];
    if (bin.number == number) into[count++] = bin.earliest;
  }
  return count;
}

void ClockFit::fit() noexcept {
  Arrivals arrivals;
  const std::size_t count = arrivals_of_window(arrivals);
  double mean_frame = 0;
  for (std::size_t i = 0; i < count; ++i) mean_frame += static_cast<double>(arrivals[i].frame) / count;

  Arrivals hull = arrivals;
  const std::size_t corners = lower_hull(std::span(hull.data(), count));
  const double span_ns = nominal_ns(arrivals[count - 1].frame - arrivals[0].frame);
  settled_ = corners >= 2 && span_ns >= static_cast<double>(settings_.settling.count());
  slope_ns_ = 0;
  if (settled_) {
    std::size_t edge = 1;
    while (edge + 1 < corners && static_cast<double>(hull[edge].frame) < mean_frame) ++edge;
    const double limit_ns = settings_.max_drift_ppm * 1e-6 * period_ns_;
    slope_ns_ = std::clamp(slope(hull[edge - 1], hull[edge]), -limit_ns, limit_ns);
  }
  offset_ns_ = HUGE_VAL;
  for (std::size_t i = 0; i < corners; ++i)
    offset_ns_ = std::min(offset_ns_, hull[i].after_ns - static_cast<double>(hull[i].frame) * slope_ns_);
}

}  // namespace orcart
