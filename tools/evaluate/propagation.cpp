// Each part is moved by one standard deviation to either side; half the difference is a column of the root of
// the covariance.
#include "tools/evaluate/propagation.hpp"

#include <numbers>

#include <Eigen/Cholesky>

#include "realtime/registration/body_covariance.hpp"

namespace orcart {

namespace {

constexpr double kChiSquare95 = 5.991464547107979;

class Propagation {
 public:
  Propagation(const EvaluationScene& scene, const Capture& capture, const Landmark& landmark)
      : scene_(scene), capture_(capture), landmark_(landmark), tangents_(tangents_of(landmark.normal)) {}

  void add(const DrawnErrors& step, const LandmarkErrors& own = {}) {
    const auto plus = painted_on_plane(scene_, capture_, landmark_, step, own);
    const auto minus = painted_on_plane(scene_, capture_, landmark_, negated(step), negated(own));
    if (!plus || !minus) {
      grazed_ = true;
      return;
    }
    const Eigen::Vector2d half = tangents_.transpose() * (*plus - *minus) / 2;
    sum_ += half * half.transpose();
  }

  void add_twists(const Eigen::Matrix<double, 6, 6>& root, Twist DrawnErrors::*part) {
    for (int column = 0; column < 6; ++column) {
      DrawnErrors step;
      step.*part = root.col(column);
      add(step);
    }
  }

  std::optional<PredictedError> result(double texel_mm) const {
    if (grazed_) return std::nullopt;
    return PredictedError{.covariance_mm2 = sum_ + texel_mm * texel_mm / 12 * Eigen::Matrix2d::Identity()};
  }

 private:
  static DrawnErrors negated(const DrawnErrors& e) {
    return {.scope = -e.scope,
            .reference = -e.reference,
            .registration = -e.registration,
            .hand_eye = -e.hand_eye,
            .lens = -e.lens,
            .lens_numbers = -e.lens_numbers,
            .refraction = -e.refraction,
            .light_post_rad = -e.light_post_rad,
            .time_s = -e.time_s};
  }
  static LandmarkErrors negated(const LandmarkErrors& e) {
    return {.picture_px = -e.picture_px, .texel_mm = -e.texel_mm};
  }

  const EvaluationScene& scene_;
  const Capture& capture_;
  const Landmark& landmark_;
  Eigen::Matrix<double, 3, 2> tangents_;
  Eigen::Matrix2d sum_ = Eigen::Matrix2d::Zero();
  bool grazed_ = false;
};

void add_lens(const ErrorModel& model, Propagation& sum) {
  if (model.lens_root) {
    for (int i = 0; i < kLensNumbers; ++i)
      if (!model.lens_root->col(i).isZero(0)) sum.add({.lens_numbers = model.lens_root->col(i)});
    return;
  }
  const Eigen::Vector4d lens(model.lens_centre_px, model.lens_centre_px, model.lens_focal,
                             model.lens_edge_px);
  for (int i = 0; i < 4; ++i) {
    DrawnErrors step;
    step.lens[i] = lens[i];
    sum.add(step);
  }
}

}  // namespace

bool PredictedError::covers(const Eigen::Vector2d& error_mm) const {
  return error_mm.dot(covariance_mm2.ldlt().solve(error_mm)) <= kChiSquare95;
}

Eigen::Matrix<double, 6, 6> body_spread(const std::vector<Eigen::Vector3d>& points_mm, double sigma_mm) {
  return body_covariance(points_mm, sigma_mm).llt().matrixL();
}

ErrorSpread spread_of(const EvaluationScene& scene, const ErrorModel& model,
                      const std::vector<Eigen::Vector3d>& fiducials_M_mm) {
  std::vector<Eigen::Vector3d> fiducials_R_mm;
  fiducials_R_mm.reserve(fiducials_M_mm.size());
  const Pose<R, M> X_RM = scene.X_MR.inverse();
  for (const Eigen::Vector3d& fiducial : fiducials_M_mm)
    fiducials_R_mm.push_back((X_RM * Point<M>{fiducial}).mm);
  const double marker_mm = model.marker_rms_mm / std::numbers::sqrt3;
  return {.scope = body_spread(scene.scope_markers_mm, marker_mm),
          .reference = body_spread(scene.reference_markers_mm, marker_mm),
          .registration = model.registration_root
                              ? *model.registration_root
                              : body_spread(fiducials_R_mm, model.fiducial_rms_mm / std::numbers::sqrt3)};
}

std::optional<PredictedError> predict(const EvaluationScene& scene, const ErrorModel& model,
                                      const ErrorSpread& spread, const Capture& capture,
                                      const Landmark& landmark, const ComponentSet& set) {
  const auto has = [&](Component component) { return set[static_cast<std::size_t>(component)]; };
  Propagation sum(scene, capture, landmark);
  if (has(Component::tracker)) {
    sum.add_twists(spread.scope, &DrawnErrors::scope);
    sum.add_twists(spread.reference, &DrawnErrors::reference);
  }
  if (has(Component::registration)) sum.add_twists(spread.registration, &DrawnErrors::registration);
  if (has(Component::hand_eye)) {
    Eigen::Matrix<double, 6, 6> root = Eigen::Matrix<double, 6, 6>::Zero();
    root.diagonal() << Eigen::Vector3d::Constant(model.hand_eye_mm),
        Eigen::Vector3d::Constant(model.hand_eye_rad);
    if (model.hand_eye_root) root = *model.hand_eye_root;
    sum.add_twists(root, &DrawnErrors::hand_eye);
  }
  if (has(Component::lens)) add_lens(model, sum);
  if (has(Component::medium)) sum.add({.refraction = model.refraction});
  if (has(Component::light_post) && model.light_post_rad > 0)
    sum.add({.light_post_rad = model.light_post_rad});
  if (has(Component::time)) sum.add({.time_s = model.time_s});
  if (!has(Component::mapping)) return sum.result(0);
  sum.add({}, {.picture_px = {model.picture_px, 0}});
  sum.add({}, {.picture_px = {0, model.picture_px}});
  return sum.result(model.texel_mm);
}

}  // namespace orcart
