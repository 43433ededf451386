// Samples and frames for the tests of sync: a scope that moves evenly along the reference's x axis.
#pragma once

#include "realtime/sync/captured_frame.hpp"
#include "realtime/sync/pose_sample.hpp"

namespace orcart::testing {

inline constexpr double kSpeed_mm_per_s = 50;

/// Counted from the simulated clock's own start.
constexpr Instant at_ms(double ms) {
  return instant_from_nanos(1'000'000'000) + from_seconds(ms * 1e-3);
}

inline double x_mm_at(Instant t) {
  return kSpeed_mm_per_s * seconds(t - at_ms(0));
}

/// Both tools seen; arrived 10 ms later. The sensor itself is somewhere and turned.
inline PoseSample sample_at(Instant t) {
  PoseSample sample{.measured_at = t, .arrived_at = t + 10ms};
  sample.scope = sample.reference = ToolState::seen;
  sample.X_TR.rotation = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  sample.X_TR.translation_mm = {100, -50, 900};
  Pose<R, S> X_RS;
  X_RS.translation_mm = {x_mm_at(t), 2, 3};
  sample.X_TS = sample.X_TR * X_RS;
  return sample;
}

inline PoseSample unseen_at(Instant t) {
  PoseSample sample = sample_at(t);
  sample.scope = ToolState::unseen;
  return sample;
}

/// Exposed for 8 ms around `mid`, dequeued 2 ms after.
inline CapturedFrame frame_at(Instant mid, std::uint32_t sequence = 0) {
  CapturedFrame frame{.buffer = sequence % 10, .sequence = sequence};
  frame.exposure_start = mid - 4ms;
  frame.exposure_end = mid + 4ms;
  frame.dequeued_at = mid + 6ms;
  return frame;
}

}  // namespace orcart::testing
