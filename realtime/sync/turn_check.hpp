// Whether the turn that is followed and the notch in the pictures say the same. A marker that slips about the
// shaft turns as the light post does, and only the picture knows better.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "realtime/base/instant.hpp"

namespace orcart {

/// One thread; pictures in order of time. A single picture decides nothing: its notch may be another dark
/// spot.
class TurnCheck {
 public:
  static constexpr std::size_t kLooked = 15;  ///< the newest pictures that tell both
  static constexpr std::size_t kEnough = 12;  ///< of them must agree with each other
  static constexpr Nanos kForgotten = 2s;     ///< after so long without any they are counted anew

  /// `most_rad`: further apart is another turn.
  explicit TurnCheck(double most_rad) : most_rad_(most_rad) {}

  void compare(Instant at, double followed_rad, double by_notch_rad) noexcept {
    if (size_ > 0 && at - newest_ > kForgotten) next_ = size_ = 0;
    newest_ = at;
    ring_[next_] = std::remainder(by_notch_rad - followed_rad, 2 * std::numbers::pi);
    next_ = (next_ + 1) % kLooked;
    size_ = size_ < kLooked ? size_ + 1 : kLooked;
    std::size_t apart = 0;
    for (std::size_t i = 0; i < size_; ++i) apart += std::abs(ring_[i]) > most_rad_;
    if (apart >= kEnough) differs_ = true;
    if (size_ - apart >= kEnough) differs_ = false;
  }

  /// What was compared no longer counts.
  void forget() noexcept {
    next_ = size_ = 0;
    differs_ = false;
  }

  /// Stays until as many pictures say otherwise.
  bool differs() const noexcept { return differs_; }

  /// By how much the notch is further round, -pi..pi: the mean of the newest kEnough pictures.
  double difference_rad() const noexcept {
    double along = 0, across = 0;
    for (std::size_t age = 1; age <= std::min(size_, kEnough); ++age) {
      const double one = ring_[(next_ + kLooked - age) % kLooked];
      along += std::cos(one), across += std::sin(one);
    }
    return std::atan2(across, along);
  }

  /// The same where kLooked pictures all agree with it; nothing: not yet, or they do not.
  std::optional<double> steady_rad(double within_rad) const noexcept {
    if (size_ < kLooked) return std::nullopt;
    const double mean = difference_rad();
    for (const double one : ring_)
      if (std::abs(std::remainder(one - mean, 2 * std::numbers::pi)) > within_rad) return std::nullopt;
    return mean;
  }

 private:
  double most_rad_;
  std::array<double, kLooked> ring_{};
  std::size_t next_ = 0, size_ = 0;
  Instant newest_{};
  bool differs_ = false;
};

}  // namespace orcart
