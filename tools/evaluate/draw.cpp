// Noise and fits.
#include "tools/evaluate/draw.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "board/sim/ndi/marker_fit.hpp"
#include "realtime/registration/rigid_fit.hpp"

namespace orcart {

namespace {

Twist twist_of(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation_mm) {
  const Eigen::AngleAxisd turn(rotation);
  Twist twist;
  twist << translation_mm, turn.angle() * turn.axis();
  return twist;
}

template <int N>
Eigen::Matrix<double, N, 1> gaussians(RandomStream& random) {
  Eigen::Matrix<double, N, 1> numbers;
  for (double& number : numbers) number = random.gaussian();
  return numbers;
}

bool has(const ComponentSet& set, Component component) {
  return set[static_cast<std::size_t>(component)];
}

}  // namespace

Twist drawn_body(const std::vector<Eigen::Vector3d>& markers_mm, double marker_rms_mm, RandomStream& random) {
  std::vector<Eigen::Vector3d> seen;
  seen.reserve(markers_mm.size());
  for (const Eigen::Vector3d& marker : markers_mm)
    seen.push_back(marker + marker_rms_mm / std::numbers::sqrt3 * random.gaussian3());
  const MarkerFit fit = fit_markers(markers_mm, seen);
  return twist_of(fit.rotation.toRotationMatrix(), fit.translation_mm);
}

Twist drawn_registration(const EvaluationScene& scene, const ErrorModel& model,
                         const std::vector<Eigen::Vector3d>& fiducials_M_mm, RandomStream& random) {
  std::vector<Eigen::Vector3d> touched_R, found_M;
  const Pose<R, M> X_RM = scene.X_MR.inverse();
  for (const Eigen::Vector3d& fiducial : fiducials_M_mm) {
    touched_R.push_back((X_RM * Point<M>{fiducial}).mm);
    found_M.push_back(fiducial + model.fiducial_rms_mm / std::numbers::sqrt3 * random.gaussian3());
  }
  const auto fit = rigid_fit({.from_mm = touched_R, .to_mm = found_M});
  if (!fit) return Twist::Zero();
  const Eigen::Matrix3d back = scene.X_MR.rotation.transpose();
  return twist_of(back * fit->rotation, back * (fit->translation_mm - scene.X_MR.translation_mm));
}

DrawnErrors drawn_errors(const EvaluationScene& scene, const ErrorModel& model, const ComponentSet& set,
                         const std::vector<Eigen::Vector3d>& fiducials_M_mm, RandomStream& random) {
  DrawnErrors all;
  all.scope = drawn_body(scene.scope_markers_mm, model.marker_rms_mm, random);
  all.reference = drawn_body(scene.reference_markers_mm, model.marker_rms_mm, random);
  all.registration = model.registration_root ? Twist(*model.registration_root * gaussians<6>(random))
                                             : drawn_registration(scene, model, fiducials_M_mm, random);
  all.hand_eye << model.hand_eye_mm * random.gaussian3(), model.hand_eye_rad * random.gaussian3();
  if (model.hand_eye_root) all.hand_eye = *model.hand_eye_root * gaussians<6>(random);
  const double cx = random.gaussian(), cy = random.gaussian(), focal = random.gaussian(),
               edge = random.gaussian();
  all.lens << model.lens_centre_px * cx, model.lens_centre_px * cy, model.lens_focal * focal,
      model.lens_edge_px * edge;
  if (model.lens_root) {
    all.lens.setZero();
    all.lens_numbers = *model.lens_root * gaussians<kLensNumbers>(random);
  }
  all.refraction = model.refraction * random.gaussian();
  all.time_s = model.time_s * random.gaussian();
  if (model.light_post_rad > 0) all.light_post_rad = model.light_post_rad * random.gaussian();
  DrawnErrors kept;
  if (has(set, Component::tracker)) {
    kept.scope = all.scope;
    kept.reference = all.reference;
  }
  if (has(set, Component::registration)) kept.registration = all.registration;
  if (has(set, Component::hand_eye)) kept.hand_eye = all.hand_eye;
  if (has(set, Component::lens)) {
    kept.lens = all.lens;
    kept.lens_numbers = all.lens_numbers;
  }
  if (has(set, Component::medium)) kept.refraction = all.refraction;
  if (has(set, Component::light_post)) kept.light_post_rad = all.light_post_rad;
  if (has(set, Component::time)) kept.time_s = all.time_s;
  return kept;
}

LandmarkErrors drawn_landmark_errors(const ErrorModel& model, const ComponentSet& set, RandomStream& random) {
  LandmarkErrors own;
  own.picture_px.x() = model.picture_px * random.gaussian();
  own.picture_px.y() = model.picture_px * random.gaussian();
  own.texel_mm.x() = model.texel_mm * (random.uniform() - 0.5);
  own.texel_mm.y() = model.texel_mm * (random.uniform() - 0.5);
  return has(set, Component::mapping) ? own : LandmarkErrors{};
}

}  // namespace orcart
