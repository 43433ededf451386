// A motion for emulated tools that nobody moves: each on its own slow circle inside the measurement volume.
#pragma once

#include <cmath>
#include <numbers>

#include "board/sim/tool_motion.hpp"

namespace orcart {

/// 100 mm circles 1.5 m in front of the sensor, one turn in 10 s, side by side; each tool also turns about
/// its own axis.
class CirclingTools final : public ToolMotion {
 public:
  TrueToolPose pose_of(int tool, Instant at) const noexcept override {
    const double turn = 2 * std::numbers::pi * std::fmod(seconds(at - Instant{}), 10.0) / 10.0 + tool;
    const Eigen::Vector3d centre_mm(-150.0 + 100.0 * (tool % 4), 0, -1500.0 - 50.0 * (tool % 3));
    TrueToolPose pose;
    pose.rotation = Eigen::AngleAxisd(turn, Eigen::Vector3d(1, 0.5, 0.25).normalized());
    pose.translation_mm = centre_mm + 100.0 * Eigen::Vector3d(std::cos(turn), std::sin(turn), 0);
    return pose;
  }
};

}  // namespace orcart
