// What a tracker does with the markers it sees: noise on each, then the rigid body that fits them best.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>

#include "board/sim/tool_motion.hpp"

namespace orcart {

inline constexpr std::size_t kMaxToolMarkers = 20;

/// A fitted body: marker frame in tracker space.
struct MarkerFit {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();
  double error_mm = 0;  ///< RMS of the markers' residuals, as a tracker reports it
};

/// The rotation and translation that take `model` to `seen` with the least sum of squares (Gauss-Newton on
/// the rotation, from the identity; the step is the least-norm one, so that a turn about the axis of
/// collinear markers, which they cannot show, stays 0). Both spans have one length, 3 to kMaxToolMarkers.
/// Allocates nothing.
MarkerFit fit_markers(std::span<const Eigen::Vector3d> model, std::span<const Eigen::Vector3d> seen) noexcept;

struct MarkerNoise {
  double sigma_mm = 0;  ///< standard deviation on each axis of each marker
  std::uint64_t seed = 1;
};

/// Measures a tool: noise on each marker, drawn from (seed, tool, frame) alone, then the fit. The
/// orientation's noise so follows from where the markers sit.
MarkerFit measure_tool(std::span<const Eigen::Vector3d> markers_mm, const TrueToolPose& truth,
                       const MarkerNoise& noise, int tool, std::uint32_t frame) noexcept;

}  // namespace orcart
