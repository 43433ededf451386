// How fast a device's frame counter runs, told by its replies: it need not be the rate at which it measures.
#pragma once

#include <cmath>
#include <cstdint>

#include "realtime/base/instant.hpp"

namespace orcart {

/// A Polaris counts at 60 Hz whatever it measures at; a device that refuses a rate keeps its own. Devices
/// count at whole tens of Hz, and replies come up to a device frame late: where two seconds in a row say the
/// same ten, and it is more than 5 % from what was assumed, that is the counter's rate. One thread.
class CounterRate {
 public:
  explicit CounterRate(double assumed_hz) noexcept : hz_(assumed_hz) {}

  /// True where the rate has just been found to be another one.
  bool observe(std::uint32_t device_frame, Instant arrived_at) noexcept {
    const auto frames = static_cast<std::int32_t>(device_frame - first_frame_);
    const bool goes_on = started_ && frames >= 0 && arrived_at - last_ < kLongestGap;
    last_ = arrived_at;
    if (!goes_on) {
      told_hz_ = 0;
      begin(device_frame, arrived_at);
      return false;
    }
    if (arrived_at - began_ < kWindow) return false;
    const double hz = nearest_ten(frames / seconds(arrived_at - began_));
    const bool again = hz > 0 && hz == told_hz_;
    told_hz_ = hz;
    begin(device_frame, arrived_at);
    if (!again || std::abs(hz - hz_) <= kTolerated * hz_) return false;
    hz_ = hz;
    return true;
  }

  double hz() const noexcept { return hz_; }

 private:
  static constexpr Nanos kWindow = 1s;
  static constexpr Nanos kLongestGap = 300ms;
  static constexpr double kTolerated = 0.05;

  void begin(std::uint32_t frame, Instant at) noexcept {
    started_ = true;
    first_frame_ = frame;
    began_ = at;
  }
  /// 0 where none is within 3 %.
  static double nearest_ten(double hz) noexcept {
    const double ten = 10 * std::round(hz / 10);
    return std::abs(hz - ten) <= 0.03 * ten ? ten : 0;
  }

  double hz_;
  double told_hz_ = 0;  ///< by the second before; 0 where by none
  bool started_ = false;
  std::uint32_t first_frame_ = 0;
  Instant began_{}, last_{};
};

}  // namespace orcart
