// The turn of a scope's light post from picture to picture, by the notch: what one picture says is believed
// where its neighbours bear it out, and is kept for pictures without one only shortly.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "realtime/base/instant.hpp"

namespace orcart {

/// By what the cart knows how far the light post is turned.
enum class TurnSource : std::uint8_t {
  told,     ///< once for the whole run
  marker,   ///< a second marker on the other side of the coupler
  encoder,  ///< one on the coupler
  notch,    ///< the notch in each picture
};

/// One thread; frames in order of mid-exposure.
class NotchTurn {
 public:
  static constexpr Nanos kHeldFor = 100ms;   ///< from the last sighting, and only where the post stood still
  static constexpr Nanos kShownFor = 250ms;  ///< now(): as long as the newest picture counts as live
  static constexpr Nanos kForgotten = 500ms;
  static constexpr double kFastest_rad_s = 2 * std::numbers::pi;  ///< of a hand
  static constexpr double kSlack_rad = 3 * std::numbers::pi / 180;
  static constexpr double kStill_rad = 0.5 * std::numbers::pi / 180;  ///< between the last two sightings

  /// `seen`: what this picture's notch says. A turn that cannot be reached from the sightings before, and the
  /// first one after kForgotten without any, waits for the next picture to bear it out. A picture without a
  /// notch has the last turn where that is at most kHeldFor old and did not change, else none.
  std::optional<double> follow(Instant mid_exposure, std::optional<double> seen) noexcept {
    newest_ = {};
    newest_at_ = mid_exposure;
    if (seen) {
      const Sighting here{mid_exposure, *seen};
      if (reached(last_, here) || reached(unproved_, here)) {
        still_ =
            reached(last_, here) && here.at - last_->at <= kHeldFor && between(*last_, here) <= kStill_rad;
        last_ = here;
        unproved_.reset();
        newest_ = seen;
      } else {
        unproved_ = here;
        still_ = false;
      }
    } else if (last_ && still_ && mid_exposure - last_->at <= kHeldFor) {
      newest_ = last_->turn_rad;
    }
    return newest_;
  }

  /// For what is shown, not painted: the newest picture's turn while that picture may count as live.
  std::optional<double> now(Instant now) const noexcept {
    return now - newest_at_ <= kShownFor ? newest_ : std::nullopt;
  }

 private:
  struct Sighting {
    Instant at{};
    double turn_rad = 0;
  };
  static double between(const Sighting& a, const Sighting& b) noexcept {
    return std::abs(std::remainder(b.turn_rad - a.turn_rad, 2 * std::numbers::pi));
  }
  static bool reached(const std::optional<Sighting>& from, const Sighting& to) noexcept {
    if (!from || to.at <= from->at || to.at - from->at > kForgotten) return false;
    return between(*from, to) <= kFastest_rad_s * seconds(to.at - from->at) + kSlack_rad;
  }

  std::optional<Sighting> last_, unproved_;
  bool still_ = false;
  std::optional<double> newest_;
  Instant newest_at_{};
};

}  // namespace orcart
