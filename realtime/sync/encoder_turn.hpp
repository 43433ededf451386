// The turn of a scope's light post by an encoder, at any instant of the last half second. What the encoder
// cannot have seen is not told.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>

#include "realtime/base/instant.hpp"

namespace orcart {

/// The encoder stands at an angle from `at` on. Angles of one run belong together.
struct EncoderAngle {
  Instant at{};
  double angle_rad = 0;
  std::uint32_t run = 0;
};

struct EncoderTurnSettings {
  /// The turn at the start of the first run; nothing: nobody said.
  std::optional<double> told_rad;
  bool absolute = false;  ///< the angle itself is the turn, in every run
};

/// One thread. A relative encoder's angle becomes a turn by its zero, and the zero is lost with its run.
class EncoderTurn {
 public:
  static constexpr std::size_t kKept = 512;
  static constexpr Nanos kApart = 1ms;  ///< readings nearer than this become one: what is kept lasts 0.5 s

  explicit EncoderTurn(const EncoderTurnSettings& settings = {}) : settings_(settings) {}

  /// In order of time.
  void push(const EncoderAngle& reading) noexcept {
    if (size_ == 0 && settings_.told_rad && !settings_.absolute)
      zero_ = Zero{reading.run, *settings_.told_rad - reading.angle_rad};
    if (size_ > 1 && back(0).run == reading.run && reading.at - back(1).at < kApart) {
      back(0) = reading;
      return;
    }
    ring_[next_] = reading;
    next_ = (next_ + 1) % kKept;
    size_ = size_ < kKept ? size_ + 1 : kKept;
  }

  /// Everything until then was pushed. `connected`: the device was there then.
  void heard(Instant until, bool connected) noexcept {
    connected_ = connected;
    if (connected) heard_until_ = until;
  }
  bool connected() const noexcept { return connected_; }

  /// at(t) will not change any more.
  bool decided(Instant t) const noexcept { return t <= heard_until_ || !connected_; }

  /// Whether the run at hand has a zero.
  bool zero_known() const noexcept {
    return settings_.absolute || (size_ > 0 && zero_ && zero_->run == back(0).run);
  }

  /// The angle at t, with its run and without a zero; nothing where at(t) would tell nothing with any zero.
  std::optional<EncoderAngle> angle_at(Instant t) const noexcept {
    const EncoderAngle* const reading = reading_at(t);
    return reading != nullptr ? std::optional(*reading) : std::nullopt;
  }
  /// The turn at angle 0 of a run: found by other means than being told.
  void set_zero(std::uint32_t run, double turn_rad) noexcept { zero_ = Zero{run, turn_rad}; }

  /// -pi..pi. Nothing where the encoder was not there, was not heard yet, has no zero, or lost steps between
  /// the readings around t.
  std::optional<double> at(Instant t) const noexcept {
    const EncoderAngle* const reading = reading_at(t);
    if (reading == nullptr) return std::nullopt;
    if (settings_.absolute) return std::remainder(reading->angle_rad, 2 * std::numbers::pi);
    if (!zero_ || zero_->run != reading->run) return std::nullopt;
    return std::remainder(reading->angle_rad + zero_->turn_rad, 2 * std::numbers::pi);
  }

 private:
  struct Zero {
    std::uint32_t run = 0;
    double turn_rad = 0;  ///< where the angle is 0
  };
  const EncoderAngle& back(std::size_t age) const noexcept {
    return ring_[(next_ + kKept - 1 - age) % kKept];
  }
  EncoderAngle& back(std::size_t age) noexcept { return ring_[(next_ + kKept - 1 - age) % kKept]; }
  /// The last one not after t, where nothing was lost since; null: not known.
  const EncoderAngle* reading_at(Instant t) const noexcept {
    if (t > heard_until_) return nullptr;
    for (std::size_t age = 0; age < size_; ++age)
      if (back(age).at <= t) return age > 0 && back(age - 1).run != back(age).run ? nullptr : &back(age);
    return nullptr;
  }

  EncoderTurnSettings settings_;
  std::array<EncoderAngle, kKept> ring_{};
  std::size_t next_ = 0, size_ = 0;
  std::optional<Zero> zero_;
  Instant heard_until_ = Instant::min();
  bool connected_ = false;
};

}  // namespace orcart
