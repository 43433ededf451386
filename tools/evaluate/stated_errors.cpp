// Roots of covariances, by correlations: a lens's numbers differ by ten powers of ten.
#include "tools/evaluate/stated_errors.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "tools/registration/json_text.hpp"

namespace orcart {

namespace {

/// Columns whose squares sum up to the covariance; rounding below zero counts as zero.
template <int N>
Eigen::Matrix<double, N, N> root_of(const Eigen::Matrix<double, N, N>& covariance) {
  using Square = Eigen::Matrix<double, N, N>;
  const Eigen::Matrix<double, N, 1> deviations = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  Square correlations = Square::Identity();
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j)
      if (const double both = deviations[i] * deviations[j]; both > 0)
        correlations(i, j) = covariance(i, j) / both;
  const Eigen::SelfAdjointEigenSolver<Square> solver(correlations);
  return deviations.asDiagonal() * solver.eigenvectors() *
         solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

/// Off the axis, of the mask's edge.
double edge_rad(const ScopeModel& scope) {
  const auto edge = direction_of(scope.lens, {scope.mask.cx_px + scope.mask.radius_px, scope.mask.cy_px});
  return edge ? std::acos(edge->z()) : scope.cone_half_angle_rad;
}

const char* word_for(bool stated, const char* by) {
  return stated ? by : "assumed";
}

const char* word_for(ErrorFrom from) {
  switch (from) {
    case ErrorFrom::told:
      return "told";
    case ErrorFrom::session:
      return "session";
    case ErrorFrom::passport:
      return "passport";
    case ErrorFrom::assumed:
      break;
  }
  return "assumed";
}

/// Whether the scope turns, as far as the model knows.
bool turns(const ErrorModel& m) {
  return m.light_post_rad > 0 || m.light_post_from != ErrorFrom::assumed;
}

}  // namespace

ErrorModel with_stated(const ErrorModel& assumed, const ScopeModel& scope,
                       const RegistrationFile& registration) {
  ErrorModel model = assumed;
  if (scope.hand_eye_covariance) {
    model.hand_eye_root = root_of(*scope.hand_eye_covariance);
    model.hand_eye_mm = std::sqrt(scope.hand_eye_covariance->topLeftCorner<3, 3>().trace() / 3);
    model.hand_eye_rad = std::sqrt(scope.hand_eye_covariance->bottomRightCorner<3, 3>().trace() / 3);
  }
  if (scope.lens_covariance) {
    const LensCovariance& lens = *scope.lens_covariance;
    model.lens_root = root_of(lens);
    model.lens_centre_px = std::sqrt((lens(2, 2) + lens(3, 3)) / 2);
    model.lens_focal = std::sqrt(lens(0, 0)) / scope.lens.fx_px;
    model.lens_edge_px = lens_deviation_px(scope.lens, lens, edge_rad(scope));
  }
  if (scope.window_covariance) model.window_root = root_of(*scope.window_covariance);
  if (scope.turning && !turns(model)) {
    const std::optional<double>& notch_rad = scope.turning->notch_deviation_rad;
    model = notch_rad ? with_turn(model, *notch_rad, ErrorFrom::passport)
                      : with_turn(model, kAssumedErrors.light_post_rad, ErrorFrom::assumed);
  }
  if (registration.covariance) model.registration_root = root_of(*registration.covariance);
  return model;
}

ErrorModel with_time(const ErrorModel& assumed, double deviation_s, ErrorFrom from) {
  ErrorModel model = assumed;
  model.time_s = deviation_s;
  model.time_from = from;
  return model;
}

ErrorModel with_turn(const ErrorModel& assumed, double deviation_rad, ErrorFrom from) {
  ErrorModel model = assumed;
  model.light_post_rad = deviation_rad;
  model.light_post_from = from;
  return model;
}

Result<void> check_turn_told(const ErrorModel& model, const ScopeModel& scope) {
  if (scope.turning || model.light_post_from != ErrorFrom::told) return {};
  return fail("--turn-deviation-deg is told of the scope " + scope.name +
              ", whose passport has no [turning]; one of a scope that turns is accepted");
}

Result<void> check_surface(const RegistrationFile& registration, const std::string& surface_hash) {
  if (registration.surface_hash == surface_hash || registration.surface_hash == "unstated") return {};
  return fail("belongs to the surface " + registration.surface_hash + ", not to this one, " + surface_hash +
              "; register again on this surface, or bring the one that was registered");
}

std::string sources_text(const ErrorModel& m) {
  std::string registration = "from its file (registration)";
  if (!m.registration_root)
    registration = json::format("%d fiducials of %.2f mm RMS (assumed)", m.fiducials, m.fiducial_rms_mm);
  return json::format("hand-eye %.3f mm and %.2f mrad an axis (%s); ", m.hand_eye_mm, 1e3 * m.hand_eye_rad,
                      word_for(m.hand_eye_root.has_value(), "passport")) +
         json::format("lens %.2f px at its centre, %.3f %% of focal length, %.2f px at the edge (%s); ",
                      m.lens_centre_px, 100 * m.lens_focal, m.lens_edge_px,
                      word_for(m.lens_root.has_value(), "passport")) +
         "registration " + registration +
         json::format("; medium %.2f %% (assumed); time %.1f ms (%s)", 100 * m.refraction, 1e3 * m.time_s,
                      word_for(m.time_from)) +
         (m.window_root ? json::format("; window %.2f mm (passport)", m.window_root->norm())
                        : std::string()) +
         (turns(m) ? json::format("; light post's turn %.2f degrees (%s)",
                                  m.light_post_rad * 180 / std::numbers::pi, word_for(m.light_post_from))
                   : std::string());
}

std::string sources_json(const ErrorModel& m) {
  return json::format(
      "{\"hand-eye\": \"%s\", \"lens\": \"%s\", \"registration\": \"%s\", \"medium\": \"assumed\", \"time\": "
      "\"%s\"%s}",
      word_for(m.hand_eye_root.has_value(), "passport"), word_for(m.lens_root.has_value(), "passport"),
      word_for(m.registration_root.has_value(), "registration"), word_for(m.time_from),
      turns(m) ? json::format(", \"light post\": \"%s\"", word_for(m.light_post_from)).c_str() : "");
}

}  // namespace orcart
