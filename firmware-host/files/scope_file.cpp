// Reads scope.toml and registration.toml, and refuses a lens that the cart could not paint through.
#include "firmware-host/files/scope_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "firmware-host/files/covariance_toml.hpp"
#include "firmware-host/files/lens_rows.hpp"
#include "firmware-host/files/toml_pose.hpp"
#include "firmware-host/files/toml_reader.hpp"

namespace orcart {
namespace {

constexpr double kWidestSearchedRad = 1.5;

std::size_t coefficient_count(LensModel model) {
  switch (model) {
    case LensModel::brown:
      return 5;
    case LensModel::fisheye:
      return 4;
    case LensModel::poly4:
      break;
  }
  return 3;
}

void read_lens(const TomlSection& section, Lens& lens) {
  lens.model = section.choice_of<LensModel>(
      "model", {{"brown", LensModel::brown}, {"poly4", LensModel::poly4}, {"fisheye", LensModel::fisheye}});
  lens.fx_px = section.number("fx_px", {.min = 1, .max = 1e5});
  lens.fy_px = section.number("fy_px", {.min = 1, .max = 1e5});
  lens.cx_px = section.number("cx_px", {.min = -1e5, .max = 1e5});
  lens.cy_px = section.number("cy_px", {.min = -1e5, .max = 1e5});
  const auto coefficients = section.numbers("coefficients", coefficient_count(lens.model));
  std::copy_n(coefficients.begin(), std::min(coefficients.size(), lens.coefficients.size()),
              lens.coefficients.begin());
  if (lens.model != LensModel::poly4) return;
  const auto centre = section.numbers("distortion_centre_px", 2);
  if (centre.size() == 2) lens.distortion_centre_px = {centre[0], centre[1]};
}

void read_mask(const TomlSection& section, const ScopeModel& scope, CircularMask& mask) {
  mask.cx_px = section.number("cx_px", {.min = 0, .max = static_cast<double>(scope.width_px)});
  mask.cy_px = section.number("cy_px", {.min = 0, .max = static_cast<double>(scope.height_px)});
  mask.radius_px = section.number("radius_px", {.min = 1, .max = 1e5});
  mask.soft_edge_px = section.number("soft_edge_px", {.min = 0, .max = 500, .fallback = 6.0});
}

std::optional<LensCovariance> read_lens_covariance(const TomlSection& section, std::string_view key,
                                                   LensModel model) {
  const auto read = covariance_from_toml(section, key, lens_row_counts(model));
  if (!read) return std::nullopt;
  const std::vector<int> rows = lens_rows(model, static_cast<int>(read->rows()));
  LensCovariance whole = LensCovariance::Zero();
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < rows.size(); ++j)
      whole(rows[i], rows[j]) = (*read)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return whole;
}

std::optional<TwistCovariance> read_twist_covariance(const TomlSection& section, std::string_view key) {
  constexpr std::array<int, 1> kSix{6};
  const auto read = covariance_from_toml(section, key, kSix);
  return read ? std::optional<TwistCovariance>(*read) : std::nullopt;
}

void read_rest(TomlReader& reader, ScopeModel& scope) {
  const TomlSection poses = reader.section("poses");
  scope.X_SC = pose_from_toml<S, C>(poses, "X_SC");
  scope.X_CE = pose_from_toml<C, E>(poses, "X_CE", Pose<C, E>{});
  const TomlSection fall_off = reader.section("fall_off");
  scope.fall_off.reference_mm = fall_off.number("reference_mm", {.min = 0.1, .max = 1000, .fallback = 20.0});
  scope.fall_off.vignetting_cos_power =
      fall_off.number("vignetting_cos_power", {.min = 0, .max = 16, .fallback = 0.0});
  const TomlSection residuals = reader.section("residuals");
  scope.residual_px = residuals.number("px", {.min = 0, .fallback = 0.0});
  scope.residual_mm = residuals.number("mm", {.min = 0, .fallback = 0.0});
  // Where passports kept the lens's before they had a section for it; poly4's in powers of 500 px.
  scope.lens_covariance = read_lens_covariance(residuals, "covariance", scope.lens.model);
  if (scope.lens_covariance && scope.lens.model == LensModel::poly4) {
    LensStep scale = LensStep::Ones();
    for (int i = 0; i < 3; ++i) scale[4 + i] = std::pow(500.0, -1 - i);
    scope.lens_covariance = scale.asDiagonal() * *scope.lens_covariance * scale.asDiagonal();
  }
  const TomlSection covariance = reader.section("covariance");
  if (auto lens = read_lens_covariance(covariance, "lens", scope.lens.model)) scope.lens_covariance = lens;
  scope.hand_eye_covariance = read_twist_covariance(covariance, "hand_eye");
  constexpr std::array<int, 1> kThree{3};
  if (const auto window = covariance_from_toml(covariance, "window", kThree))
    scope.window_covariance = Eigen::Matrix3d(*window);
}

/// Row by row.
Eigen::Matrix3d read_second_marker(const TomlSection& section) {
  constexpr double kLargestDeviation = 0.01;
  const auto numbers = section.numbers("R_SL", 9);
  if (numbers.size() != 9) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d given;
  for (Eigen::Index i = 0; i < 9; ++i) given(i / 3, i % 3) = numbers[static_cast<std::size_t>(i)];
  const NearestRotation nearest = nearest_rotation(given);
  if (nearest.reflected || !(nearest.deviation <= kLargestDeviation))
    section.refuse("R_SL", "is no rotation; nine numbers, row by row, are accepted");
  return nearest.rotation;
}

void read_turning(const TomlSection& section, ScopeModel& scope) {
  if (!section.present()) return;
  Turning turning;
  turning.view_angle_rad = section.number("view_angle_rad", {.min = 0, .max = 2.1});
  const auto centre = section.numbers("centre_px", 2);
  if (centre.size() == 2) turning.centre_px = {centre[0], centre[1]};
  turning.centre_deviation_px =
      section.number("centre_deviation_px", {.min = 0, .max = 100, .fallback = 0.0});
  if (section.has("notch_deviation_rad"))
    turning.notch_deviation_rad = section.number("notch_deviation_rad", {.min = 0, .max = 0.35});
  turning.marker =
      section.choice_of<TurnMarker>("marker", {{"shaft", TurnMarker::shaft}, {"head", TurnMarker::head}});
  const bool on_head = turning.marker == TurnMarker::head, second = section.has("R_SL");
  if (second) turning.R_SL = read_second_marker(section);
  if (on_head) {
    const auto point = section.numbers("axis_point_mm", 3);
    if (point.size() == 3) turning.axis_point_mm = {point[0], point[1], point[2]};
  }
  if (on_head || second) {
    const auto axis = section.numbers("axis", 3);
    if (axis.size() == 3) turning.axis = {axis[0], axis[1], axis[2]};
    if (std::abs(turning.axis.norm() - 1) > 0.01)
      section.refuse("axis", "is not of length 1; a direction in the marker's axes is accepted");
    turning.axis.normalize();
  }
  scope.turning = turning;
}

/// Whether every pixel of the circle that lies in the picture has a direction: the lens is monotone there.
/// The edge decides, and of a circle that reaches beyond the picture its part on the picture's border.
bool sees_to_the_edge(const ScopeModel& scope) {
  constexpr int kDirections = 64;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const double x = scope.mask.cx_px + scope.mask.radius_px * std::cos(angle);
    const double y =
        scope.mask.cy_px + scope.mask.radius_px * std::sin(angle) * scope.lens.fy_px / scope.lens.fx_px;
    const Eigen::Vector2d seen(std::clamp(x, 0.0, scope.width_px - 1.0),
                               std::clamp(y, 0.0, scope.height_px - 1.0));
    if (!direction_of(scope.lens, seen)) return false;
  }
  return true;
}

/// Sets how far the lens is good for. Says nothing where a number it needs was refused already.
void check_lens(const TomlSection& lens, const TomlSection& cone, ScopeModel& scope) {
  if (scope.lens.fx_px <= 0 || scope.lens.fy_px <= 0 || scope.mask.radius_px <= 0 || scope.width_px <= 0 ||
      scope.height_px <= 0)
    return;
  scope.lens.max_angle_rad = largest_monotone_angle_rad(scope.lens, kWidestSearchedRad);
  std::array<char, 32> limit{};
  std::snprintf(limit.data(), limit.size(), "%.4g rad", scope.lens.max_angle_rad);
  if (!sees_to_the_edge(scope))
    lens.refuse("coefficients", std::string("fold the picture back inside the mask's circle, beyond ") +
                                    limit.data() +
                                    "; a lens that is monotone to the circle's edge is accepted");
  else if (scope.cone_half_angle_rad > scope.lens.max_angle_rad)
    cone.refuse("half_angle_rad",
                std::string("is wider than the lens is good for; up to ") + limit.data() + " is accepted");
}

Result<void> finish(TomlReader& reader, std::vector<std::string>* notes) {
  if (notes != nullptr) *notes = reader.notes();
  return reader.finish();
}

Result<ScopeModel> scope_from(TomlReader& reader, std::vector<std::string>* notes) {
  ScopeModel scope;
  const TomlSection top = reader.top();
  scope.name = top.text("name");
  if (top.has("serial")) scope.serial = top.text("serial");
  scope.width_px = static_cast<int>(top.integer("width_px", {.min = 16, .max = 16'384}));
  scope.height_px = static_cast<int>(top.integer("height_px", {.min = 16, .max = 16'384}));
  scope.medium = top.choice_of<Medium>(
      "medium", {{"air", Medium::air}, {"water", Medium::water}, {"saline", Medium::saline}});
  scope.calibrated_on = top.text("calibrated_on", "");
  scope.expires_on = top.text("expires_on", "");
  const TomlSection lens = reader.section("lens");
  read_lens(lens, scope.lens);
  const TomlSection mask = reader.section("mask");
  read_mask(mask, scope, scope.mask);
  if (mask.has("notch_rad")) scope.notch_rad = mask.number("notch_rad", {.min = -7, .max = 7});
  const TomlSection cone = reader.section("cone");
  scope.cone_half_angle_rad = cone.number("half_angle_rad", {.min = 0.02, .max = 1.48});
  scope.far_mm = cone.number("far_mm", {.min = 1, .max = 1000, .fallback = 60.0});
  read_rest(reader, scope);
  read_turning(reader.section("turning"), scope);
  check_lens(lens, cone, scope);
  if (auto finished = finish(reader, notes); !finished) return tl::unexpected(finished.error());
  return scope;
}

}  // namespace

Result<ScopeModel> read_scope(const std::filesystem::path& file, std::vector<std::string>* notes) {
  const auto opened = TomlReader::open(file);
  if (!opened) return tl::unexpected(opened.error());
  return scope_from(**opened, notes);
}

Result<ScopeModel> read_scope_text(std::string_view text, const std::filesystem::path& file) {
  const auto opened = TomlReader::parse(text, file);
  if (!opened) return tl::unexpected(opened.error());
  return scope_from(**opened, nullptr);
}

Result<RegistrationFile> read_registration(const std::filesystem::path& file,
                                           std::vector<std::string>* notes) {
  const auto opened = TomlReader::open(file);
  if (!opened) return tl::unexpected(opened.error());
  TomlReader& reader = **opened;
  const TomlSection top = reader.top();
  RegistrationFile registration;
  registration.X_MR = pose_from_toml<M, R>(top, "X_MR");
  registration.surface_hash = top.text("surface_hash");
  registration.fre_mm = top.number("fre_mm", {.min = 0, .max = 1000});
  registration.predicted_tre_mm = top.number("predicted_tre_mm", {.min = 0, .max = 1000});
  registration.covariance = read_twist_covariance(top, "covariance");
  if (auto finished = finish(reader, notes); !finished) return tl::unexpected(finished.error());
  return registration;
}

}  // namespace orcart
