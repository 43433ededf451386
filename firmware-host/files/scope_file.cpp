// scope.toml and registration.toml, both ways.
#include "firmware-host/files/scope_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "firmware-host/files/toml_pose.hpp"
#include "firmware-host/files/toml_reader.hpp"
#include "firmware-host/files/whole_file.hpp"

namespace orcart {
namespace {

constexpr double kWidestSearched = 1.5;

std::size_t coefficient_count(LensModel model) {
  switch (model) {
    case LensModel::brown: return 5;
    case LensModel::fisheye: return 4;
    case LensModel::poly4: break;
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
  std::copy_n(coefficients.begin(), std::min(coefficients.size(), lens.coefficients.size()), lens.coefficients.begin());
  if (lens.model == LensModel::poly4) {
    const auto centre = section.numbers("distortion_centre_px", 2);
    if (centre.size() == 2) lens.distortion_centre_px = {centre[0], centre[1]};
  }
}

void read_mask(const TomlSection& section, const ScopeModel& scope, CircularMask& mask) {
  mask.cx_px = section.number("cx_px", {.min = 0, .max = double(scope.width_px)});
  mask.cy_px = section.number("cy_px", {.min = 0, .max = double(scope.height_px)});
  mask.radius_px = section.number("radius_px", {.min = 1, .max = 1e5});
  mask.soft_edge_px = section.number("soft_edge_px", {.min = 0, .max = 500, .fallback = 6.0});
}

/// The largest angle off the axis that the mask shows inside the picture; nothing where the lens cannot be inverted there.
std::optional<double> widest_angle_seen(const ScopeModel& scope) {
  Lens lens = scope.lens;
  lens.max_angle_rad = largest_monotone_angle_rad(lens, kWidestSearched);
  double widest = 0;
  constexpr int kDirections = 64;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const double x = scope.mask.cx_px + scope.mask.radius_px * std::cos(angle);
    const double y = scope.mask.cy_px + scope.mask.radius_px * std::sin(angle) * lens.fy_px / lens.fx_px;
    const Eigen::Vector2d seen(std::clamp(x, 0.0, scope.width_px - 1.0), std::clamp(y, 0.0, scope.height_px - 1.0));
    const auto direction = direction_of(lens, seen);
    if (!direction) return std::nullopt;
    widest = std::max(widest, std::acos(std::clamp(direction->z(), -1.0, 1.0)));
  }
  return widest;
}

void check_lens(const TomlSection& lens_section, const TomlSection& cone_section, ScopeModel& scope) {
  if (scope.lens.fx_px <= 0 || scope.lens.fy_px <= 0 || scope.mask.radius_px <= 0) return;
  scope.lens.max_angle_rad = largest_monotone_angle_rad(scope.lens, kWidestSearched);
  if (!widest_angle_seen(scope)) {
    lens_section.refuse("coefficients",
                        "make the lens fold back inside the mask's circle (it is monotone to " +
                            std::to_string(scope.lens.max_angle_rad) +
                            " rad only); a lens that is monotone to the circle's edge is accepted");
    return;
  }
  if (scope.cone_half_angle_rad > scope.lens.max_angle_rad) {
    cone_section.refuse("half_angle_rad", "is wider than the lens is monotone (" +
                                              std::to_string(scope.lens.max_angle_rad) + " rad); less is accepted");
  }
}

std::string number_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

template <class A, class B>
std::string pose_text(const Pose<A, B>& pose) {
  std::string out = "[\n";
  for (int r = 0; r < 3; ++r) {
    out += "  ";
    for (int c = 0; c < 3; ++c) out += number_text(pose.rotation(r, c)) + ", ";
    out += number_text(pose.translation_mm[r]) + ",\n";
  }
  return out + "]";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

const char* word_for(Medium medium) {
  switch (medium) {
    case Medium::water: return "water";
    case Medium::saline: return "saline";
    case Medium::air: break;
  }
  return "air";
}

std::string lens_text(const Lens& lens) {
  const char* model = lens.model == LensModel::brown ? "brown" : lens.model == LensModel::poly4 ? "poly4" : "fisheye";
  std::string out = "[lens]\nmodel = \"" + std::string(model) + "\"\nfx_px = " + number_text(lens.fx_px) + "\nfy_px = " +
                    number_text(lens.fy_px) + "\ncx_px = " + number_text(lens.cx_px) + "\ncy_px = " +
                    number_text(lens.cy_px) + "\ncoefficients = [";
  for (std::size_t i = 0; i < coefficient_count(lens.model); ++i) out += (i > 0 ? ", " : "") + number_text(lens.coefficients[i]);
  out += "]\n";
  if (lens.model == LensModel::poly4) {
    out += "distortion_centre_px = [" + number_text(lens.distortion_centre_px.x()) + ", " +
           number_text(lens.distortion_centre_px.y()) + "]\n";
  }
  return out;
}

}  // namespace

Result<ScopeModel> read_scope(const std::filesystem::path& file) {
  auto opened = TomlReader::open(file);
  if (!opened) return tl::unexpected(opened.error());
  TomlReader& reader = **opened;
  ScopeModel scope;
  const TomlSection top = reader.top();
  scope.name = top.text("name");
  scope.width_px = static_cast<int>(top.integer("width_px", {.min = 16, .max = 16'384}));
  scope.height_px = static_cast<int>(top.integer("height_px", {.min = 16, .max = 16'384}));
  scope.medium = top.choice_of<Medium>("medium", {{"air", Medium::air}, {"water", Medium::water}, {"saline", Medium::saline}});
  scope.calibrated_on = top.text("calibrated_on", "");
  const TomlSection lens = reader.section("lens");
  read_lens(lens, scope.lens);
  read_mask(reader.section("mask"), scope, scope.mask);
  const TomlSection cone = reader.section("cone");
  scope.cone_half_angle_rad = cone.number("half_angle_rad", {.min = 0.02, .max = 1.48});
  scope.far_mm = cone.number("far_mm", {.min = 1, .max = 1000, .fallback = 60.0});
  const TomlSection poses = reader.section("poses");
  scope.X_SC = pose_from_toml<S, C>(poses, "X_SC");
  scope.X_CE = pose_from_toml<C, E>(poses, "X_CE", Pose<C, E>{});
  const TomlSection fall_off = reader.section("fall_off");
  scope.fall_off.reference_mm = fall_off.number("reference_mm", {.min = 0.1, .max = 1000, .fallback = 20.0});
  scope.fall_off.vignetting_cos_power = fall_off.number("vignetting_cos_power", {.min = 0, .max = 16, .fallback = 0.0});
  const TomlSection residuals = reader.section("residuals");
  scope.residual_px = residuals.number("px", {.min = 0, .fallback = 0.0});
  scope.residual_mm = residuals.number("mm", {.min = 0, .fallback = 0.0});
  check_lens(lens, cone, scope);
  if (auto finished = reader.finish(); !finished) return tl::unexpected(finished.error());
  return scope;
}

Result<void> write_scope(const std::filesystem::path& file, const ScopeModel& scope) {
  std::string out = "# The calibration passport of a scope. Lengths in mm or px, angles in rad; poses are row-major 3x4.\n";
  out += "name = " + quoted(scope.name) + "\nwidth_px = " + std::to_string(scope.width_px) + "\nheight_px = " +
         std::to_string(scope.height_px) + "\nmedium = \"" + word_for(scope.medium) + "\"\n";
  if (!scope.calibrated_on.empty()) out += "calibrated_on = " + quoted(scope.calibrated_on) + "\n";
  out += "\n" + lens_text(scope.lens);
  out += "\n[mask]\ncx_px = " + number_text(scope.mask.cx_px) + "\ncy_px = " + number_text(scope.mask.cy_px) +
         "\nradius_px = " + number_text(scope.mask.radius_px) + "\nsoft_edge_px = " + number_text(scope.mask.soft_edge_px) + "\n";
  out += "\n[cone]\nhalf_angle_rad = " + number_text(scope.cone_half_angle_rad) + "\nfar_mm = " + number_text(scope.far_mm) + "\n";
  out += "\n[poses]\nX_SC = " + pose_text(scope.X_SC) + "\nX_CE = " + pose_text(scope.X_CE) + "\n";
  out += "\n[fall_off]\nreference_mm = " + number_text(scope.fall_off.reference_mm) + "\nvignetting_cos_power = " +
         number_text(scope.fall_off.vignetting_cos_power) + "\n";
  out += "\n[residuals]\npx = " + number_text(scope.residual_px) + "\nmm = " + number_text(scope.residual_mm) + "\n";
  return write_whole_file(file, out);
}

Result<RegistrationFile> read_registration(const std::filesystem::path& file) {
  auto opened = TomlReader::open(file);
  if (!opened) return tl::unexpected(opened.error());
  TomlReader& reader = **opened;
  const TomlSection top = reader.top();
  RegistrationFile registration;
  registration.X_MR = pose_from_toml<M, R>(top, "X_MR");
  registration.surface_hash = top.text("surface_hash");
  registration.fre_mm = top.number("fre_mm", {.min = 0, .max = 1000});
  registration.predicted_tre_mm = top.number("predicted_tre_mm", {.min = 0, .max = 1000});
  if (auto finished = reader.finish(); !finished) return tl::unexpected(finished.error());
  return registration;
}

Result<void> write_registration(const std::filesystem::path& file, const RegistrationFile& registration) {
  return write_whole_file(file, "# The patient's reference in mesh space (LPS, mm): row-major 3x4.\nX_MR = " +
                                    pose_text(registration.X_MR) + "\nsurface_hash = " + quoted(registration.surface_hash) +
                                    "\nfre_mm = " + number_text(registration.fre_mm) + "\npredicted_tre_mm = " +
                                    number_text(registration.predicted_tre_mm) + "\n");
}

}  // namespace orcart
