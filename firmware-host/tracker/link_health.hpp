// Judges a polled tracker by its replies alone: silence, damage, and frames that stand still.
#pragma once

#include <array>
#include <cstdint>

#include "realtime/base/instant.hpp"

namespace orcart {

/// How far the tracker may be believed.
enum class TrackerHealth : std::uint8_t {
  starting,  ///< never tracked yet
  live,
  suspect,  ///< silent for max(50 ms, 3 periods): nothing is painted
  lost,     ///< silent for max(100 ms, 4 periods), frame stuck, or disconnected: being started again
};

/// One thread; allocates nothing.
class LinkHealth {
 public:
  LinkHealth(double poll_rate_hz, double device_rate_hz) noexcept;

  /// Tracking has begun: the times count from here.
  void begin(Instant now) noexcept;
  void on_good_reply(Instant now) noexcept;
  void on_damaged_reply(Instant now) noexcept;
  /// The newest device frame of a good reply. True where it differs from the one before.
  bool on_frame(std::uint32_t frame, Instant now) noexcept;

  /// At which new frames come, over some seconds; 0 where that is not known.
  double frame_rate_hz() const noexcept { return frame_rate_hz_; }

  bool suspect(Instant now) const noexcept { return now - last_good_ >= suspect_after_; }
  bool silent(Instant now) const noexcept { return now - last_good_ >= lost_after_; }
  /// Good replies have come for three periods of the device and all told the same frame. The period is the
  /// wished one, or what four frames took where they came slower.
  bool frame_stuck() const noexcept { return frame_stuck_; }
  /// 3 damaged replies in a row, or 1 % of what was to come in 10 s.
  bool line_is_bad(Instant now) const noexcept;
  /// When suspect() or silent() will change unless a reply comes.
  Instant next_verdict(Instant now) const noexcept;

 private:
  void time_frames(Instant now) noexcept;
  Nanos frame_patience() const noexcept;

  static constexpr std::size_t kWindowSeconds = 10;
  struct Second {
    std::int64_t index = -1;
    std::uint32_t damaged = 0;
  };
  std::uint32_t damaged_in_window(Instant now) const noexcept;

  Nanos suspect_after_;
  Nanos lost_after_;
  Nanos stuck_after_;        ///< 2.5 wished periods: replies come once a period, so the third repeat counts
                             ///< whatever its jitter
  std::uint32_t tolerated_;  ///< damaged replies in the window below which the line is good
  Instant last_good_{};
  Instant frame_changed_at_{};
  std::uint32_t frame_ = 0;
  bool frame_seen_ = false;
  Nanos frames_came_each_{};  ///< mean of the newest four; 0 until so many have come
  Instant four_began_{};
  int of_four_ = 0;
  double frame_rate_hz_ = 0;
  Instant count_began_{};
  int counted_ = 0;
  bool frame_stuck_ = false;
  std::uint32_t damaged_in_a_row_ = 0;
  std::array<Second, kWindowSeconds> window_{};
};

}  // namespace orcart
