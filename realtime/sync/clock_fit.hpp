// From a device's own frame number to the host's clock: a running line under the arrivals, so that no late
// one pulls it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "realtime/base/instant.hpp"

namespace orcart {

struct ClockFitSettings {
  double rate_hz = 60;     ///< nominal rate of the device's frame number
  Nanos device_latency{};  ///< from the device frame to the earliest arrival of its reply; taken off every
                           ///< answer
  Nanos window = 10s;      ///< how far back arrivals count
  Nanos settling = 2s;     ///< below this span the nominal rate is believed
  Nanos jump_tolerance = 20ms;   ///< an arrival earlier than the line by more is a jump of the frame number
  Nanos late_tolerance = 100ms;  ///< arrivals later than the line by more, 8 in a row, are a jump as well
  double max_drift_ppm = 300;    ///< no oscillator of a position sensor is worse; bounds what noise may do
};

/// Arrival = line(frame) + delay, delay >= 0. The line is the one below all arrivals of the window with the
/// least sum of distances: the edge of their lower convex hull above the mean frame number (Moon, Skelly and
/// Towsley, INFOCOM 1999). Of each 1/64 of the window only the earliest arrival is kept, so an observation
/// costs at most 64 steps at any rate. One thread.
class ClockFit {
 public:
  enum class Seen : std::uint8_t {
    used,       ///< the frame number advanced as it should
    repeated,   ///< the same device frame once more: says nothing, changes nothing
    restarted,  ///< it jumped, forward or back: the fit starts again from this observation
  };

  explicit ClockFit(const ClockFitSettings& settings);

  /// `arrived_at`: host time at which the frame's reply was complete. Frame numbers wrap at 2^32.
  Seen observe(std::uint32_t device_frame, Instant arrived_at) noexcept;

  /// When the device measured this frame. Frames within 2^31 of the last observed one; Instant{} before the
  /// first.
  Instant host_time(std::uint32_t device_frame) const noexcept;

  /// The window spans enough that the device's rate is measured, not assumed.
  bool settled() const noexcept { return settled_; }
  /// How much longer the device's period is than its nominal one; 0 until settled.
  double drift_ppm() const noexcept { return slope_ns_ / period_ns_ * 1e6; }
  std::uint32_t restarts() const noexcept { return restarts_; }

 private:
  static constexpr std::size_t kBins = 64;
  static constexpr std::uint32_t kLateInARow = 8;
  /// An arrival: frames since the fit's start, and nanoseconds after the nominal line through it.
  struct Arrival {
    std::int64_t frame = 0;
    double after_ns = 0;
  };
  struct Bin {
    std::int64_t number = -1;  ///< of the stretch of frames it stands for
    Arrival earliest;
  };
  using Arrivals = std::array<Arrival, kBins>;

  void restart(std::uint32_t device_frame, Instant arrived_at) noexcept;
  bool jumped(std::int64_t step, const Arrival& arrival) noexcept;
  void keep(const Arrival& arrival) noexcept;
  void fit() noexcept;
  std::size_t arrivals_of_window(Arrivals& into) const noexcept;
  double nominal_ns(std::int64_t frame) const noexcept { return static_cast<double>(frame) * period_ns_; }
  double line_ns(std::int64_t frame) const noexcept {
    return offset_ns_ + static_cast<double>(frame) * slope_ns_;
  }

  ClockFitSettings settings_;
  double period_ns_;
  std::int64_t frames_per_bin_;
  std::array<Bin, kBins> bins_{};
  Instant origin_{};  ///< arrival of frame 0 of the fit
  std::uint32_t last_device_frame_ = 0;
  std::int64_t last_frame_ = 0;  ///< the same, since the fit's start, without wraps
  double offset_ns_ = 0, slope_ns_ = 0;
  std::uint32_t late_in_a_row_ = 0;
  std::uint32_t restarts_ = 0;
  bool started_ = false, settled_ = false;
};

}  // namespace orcart
