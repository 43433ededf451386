// The truth that a simulated tracker measures: where each tool really is at an instant, and whether it can be
// seen.
#pragma once

#include <Eigen/Geometry>

#include "realtime/base/instant.hpp"

namespace orcart {

/// A tool's marker frame in tracker space T.
struct TrueToolPose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();
  bool visible = true;
};

/// Any thread may ask; deterministic.
class ToolMotion {
 public:
  virtual ~ToolMotion() = default;
  virtual TrueToolPose pose_of(int tool, Instant at) const noexcept = 0;
};

}  // namespace orcart
