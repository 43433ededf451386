// Draws the errors of a set-up as they arise: noise on each marker and fiducial, then the fits.
#pragma once

#include "tools/evaluate/error_chain.hpp"

namespace orcart {

/// How a body with these markers moves when a tracker fits it to noisy ones: measured, not linearised.
Twist drawn_body(const std::vector<Eigen::Vector3d>& markers_mm, double marker_rms_mm, RandomStream& random);

/// Of X_MR, in R: every fiducial's place is wrong by chance, the rigid fit spreads it.
Twist drawn_registration(const EvaluationScene& scene, const ErrorModel& model,
                         const std::vector<Eigen::Vector3d>& fiducials_M_mm, RandomStream& random);

/// What stays the same from capture to capture of a set-up (hand-eye, registration, lens, medium, time), and
/// the tracker's noise of one capture. What is not in `set` is zero, but drawn all the same, so that a
/// component alone has the very errors that it has among all.
DrawnErrors drawn_errors(const EvaluationScene& scene, const ErrorModel& model, const ComponentSet& set,
                         const std::vector<Eigen::Vector3d>& fiducials_M_mm, RandomStream& random);

LandmarkErrors drawn_landmark_errors(const ErrorModel& model, const ComponentSet& set, RandomStream& random);

}  // namespace orcart
