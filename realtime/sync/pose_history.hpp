// The tracker's last samples in a fixed ring, and where the scope was in the patient's reference at an
// instant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "realtime/geometry/twist.hpp"
#include "realtime/sync/pose_sample.hpp"

namespace orcart {

struct PoseHistorySettings {
  Nanos period{};                   ///< of the samples as they are polled
  Nanos exact_within = 200us;       ///< a sample this near is the answer as it stands
  Nanos longest_prediction = 50ms;  ///< beyond the newest sample nothing is said after this
  std::size_t capacity = 128;
  bool needs_turn = false;  ///< a sample without turn_rad counts as one in which the scope was not seen
};

/// One thread. Memory is taken in the constructor only.
class PoseHistory {
 public:
  explicit PoseHistory(const PoseHistorySettings& settings);

  /// Samples must rise in measured_at and not be from after their own arrival: else refused, counted and
  /// false.
  bool push(const PoseSample& sample) noexcept;

  /// Interpolates X_RS, never X_TS: the sensor's own movement drops out. `interpolated` only between complete
  /// samples at most 2 periods apart (one may be missing between them); `predicted` goes on with the velocity
  /// of the last two complete samples, and only where the newest sample is complete.
  PoseAnswer at(Instant t) const noexcept;

  /// No sample still to come can make at(t) a pose that may paint, or turn it into another one.
  bool decided(Instant t) const noexcept;

  /// Of the samples next to t, one shows scope and reference but does not tell the turn that is needed.
  bool lacks_turn_around(Instant t) const noexcept;

  /// There are samples within a period of t on both sides: where at(t) is none, a tool was not seen.
  bool sampled_around(Instant t) const noexcept;

  /// How the scope marker moves in the reference about t: a twist a second (mm/s, rad/s in S's axes) between
  /// the complete sample next after t, else before, and the oldest no more than `over` before that one. So
  /// long a base keeps the tracker's noise small. Nothing where the samples span less than half of it.
  std::optional<Twist> velocity(Instant t, Nanos over = 100ms) const noexcept;

  /// measured_at of the newest sample, complete or not; Instant{} before the first.
  Instant newest() const noexcept { return size_ == 0 ? Instant{} : back(0).measured_at; }
  std::uint32_t refused() const noexcept { return refused_; }

 private:
  /// The complete samples next to an instant; null where there is none.
  struct Neighbours {
    const PoseSample* before = nullptr;  ///< the last one not after the instant
    const PoseSample* after = nullptr;   ///< the first one after it
  };
  const PoseSample& back(std::size_t age) const noexcept {
    return ring_[(next_ + ring_.size() - 1 - age) % ring_.size()];
  }
  bool complete(const PoseSample& sample) const noexcept {
    return sample.complete() && (!settings_.needs_turn || sample.turn_rad);
  }
  Neighbours neighbours(Instant t) const noexcept;
  PoseAnswer predict(const PoseSample& last, Instant t) const noexcept;
  /// Stamps come off a fitted line: a tenth of a period is more than it moves between two samples.
  Nanos longest_gap() const noexcept { return settings_.period * 2 + settings_.period / 10; }

  PoseHistorySettings settings_;
  std::vector<PoseSample> ring_;
  std::size_t next_ = 0, size_ = 0;
  std::uint32_t refused_ = 0;
};

}  // namespace orcart
