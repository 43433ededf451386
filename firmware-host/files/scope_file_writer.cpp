// Writes scope.toml and registration.toml: every number in the fewest digits that read back to the same
// value.
#include <array>
#include <charconv>
#include <cstdio>
#include <string_view>

#include "firmware-host/files/lens_rows.hpp"
#include "firmware-host/files/passport_check.hpp"
#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/whole_file.hpp"

namespace orcart {
namespace {

std::string text_of(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

std::string text_of(std::string_view words) {
  std::string out = "\"";
  for (const char c : words) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7F) {
      out += c;
      continue;
    }
    std::array<char, 8> escape{};
    std::snprintf(escape.data(), escape.size(), "\\u%04X", static_cast<unsigned>(c));
    out += escape.data();
  }
  return out + "\"";
}

template <class A, class B>
std::string text_of(const Pose<A, B>& pose) {
  std::string out = "[\n";
  for (int row = 0; row < 3; ++row) {
    out += "  ";
    for (int column = 0; column < 3; ++column) out += text_of(pose.rotation(row, column)) + ", ";
    out += text_of(pose.translation_mm[row]) + ",\n";
  }
  return out + "]";
}

template <class Value>
std::string line(std::string_view key, const Value& value) {
  return std::string(key) + " = " + text_of(value) + "\n";
}

std::string list(std::string_view key, const double* values, std::size_t count) {
  std::string out = std::string(key) + " = [";
  for (std::size_t i = 0; i < count; ++i) out += (i > 0 ? ", " : "") + text_of(values[i]);
  return out + "]\n";
}

struct LensWords {
  std::string_view model;
  std::size_t coefficients;
};

LensWords words_for(LensModel model) {
  switch (model) {
    case LensModel::poly4:
      return {"poly4", 3};
    case LensModel::fisheye:
      return {"fisheye", 4};
    case LensModel::brown:
      break;
  }
  return {"brown", 5};
}

std::string lens_text(const Lens& lens) {
  const LensWords words = words_for(lens.model);
  std::string out = line("model", words.model) + line("fx_px", lens.fx_px) + line("fy_px", lens.fy_px) +
                    line("cx_px", lens.cx_px) + line("cy_px", lens.cy_px) +
                    list("coefficients", lens.coefficients.data(), words.coefficients);
  if (lens.model == LensModel::poly4)
    out += list("distortion_centre_px", lens.distortion_centre_px.data(), 2);
  return out;
}

std::string turning_text(const Turning& turning) {
  const bool on_head = turning.marker == TurnMarker::head;
  std::string out = "\n[turning]\n" + line("view_angle_rad", turning.view_angle_rad) +
                    list("centre_px", turning.centre_px.data(), 2) +
                    line("centre_deviation_px", turning.centre_deviation_px) +
                    line("marker", std::string_view(on_head ? "head" : "shaft"));
  if (on_head || turning.R_SL) out += list("axis", turning.axis.data(), 3);
  if (on_head) out += list("axis_point_mm", turning.axis_point_mm.data(), 3);
  if (turning.R_SL) {
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = *turning.R_SL;
    out += list("R_SL", rows.data(), 9);
  }
  if (turning.notch_deviation_rad) out += line("notch_deviation_rad", *turning.notch_deviation_rad);
  return out;
}

std::string square(std::string_view key, const Eigen::MatrixXd& matrix) {
  std::string out = std::string(key) + " = [\n";
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    out += " ";
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) out += " " + text_of(matrix(i, j)) + ",";
    out += "\n";
  }
  return out + "]\n";
}

std::string covariance_text(const ScopeModel& scope) {
  if (!scope.lens_covariance && !scope.hand_eye_covariance && !scope.window_covariance) return {};
  std::string out = "\n[covariance]\n";
  if (scope.lens_covariance) {
    const std::vector<int> rows = lens_rows(scope.lens.model, *scope.lens_covariance);
    out += "# Of fx fy cx cy, the coefficients" +
           std::string(scope.lens.model == LensModel::poly4 ? ", the distortion centre" : "") +
           ", as far as they were free.\n" +
           square("lens", Eigen::MatrixXd((*scope.lens_covariance)(rows, rows)));
  }
  if (scope.hand_eye_covariance)
    out += "# Of a small motion of C in its own axes: x y z in mm, rotation vector in rad.\n" +
           square("hand_eye", *scope.hand_eye_covariance);
  if (scope.window_covariance)
    out +=
        "# Of the window's place, X_CE, along C's axes in mm; 0 across where E is the point in which C's z "
        "axis "
        "leaves it.\n" +
        square("window", *scope.window_covariance);
  return out;
}

}  // namespace

Result<void> write_scope(const std::filesystem::path& file, const ScopeModel& scope) {
  std::string out =
      "# The calibration passport of a scope. Lengths in mm or px, angles in rad; poses are row-major 3x4.\n";
  out += line("name", std::string_view(scope.name));
  if (!scope.serial.empty()) out += line("serial", std::string_view(scope.serial));
  out += line("width_px", scope.width_px) + line("height_px", scope.height_px) +
         line("medium", word_for(scope.medium));
  if (!scope.calibrated_on.empty()) out += line("calibrated_on", std::string_view(scope.calibrated_on));
  if (!scope.expires_on.empty()) out += line("expires_on", std::string_view(scope.expires_on));
  out += "\n[lens]\n" + lens_text(scope.lens);
  out += "\n[mask]\n" + line("cx_px", scope.mask.cx_px) + line("cy_px", scope.mask.cy_px) +
         line("radius_px", scope.mask.radius_px) + line("soft_edge_px", scope.mask.soft_edge_px);
  if (scope.notch_rad) out += line("notch_rad", *scope.notch_rad);
  out += "\n[cone]\n" + line("half_angle_rad", scope.cone_half_angle_rad) + line("far_mm", scope.far_mm);
  out += "\n[poses]\n" + line("X_SC", scope.X_SC) + line("X_CE", scope.X_CE);
  if (scope.turning) out += turning_text(*scope.turning);
  out += "\n[fall_off]\n" + line("reference_mm", scope.fall_off.reference_mm) +
         line("vignetting_cos_power", scope.fall_off.vignetting_cos_power);
  out += "\n[residuals]\n" + line("px", scope.residual_px) + line("mm", scope.residual_mm);
  return write_whole_file(file, out + covariance_text(scope));
}

Result<void> write_registration(const std::filesystem::path& file, const RegistrationFile& registration) {
  return write_whole_file(
      file, "# The patient's reference in mesh space (LPS, mm): row-major 3x4.\n" +
                line("X_MR", registration.X_MR) +
                line("surface_hash", std::string_view(registration.surface_hash)) +
                line("fre_mm", registration.fre_mm) +
                line("predicted_tre_mm", registration.predicted_tre_mm) +
                (registration.covariance ? "# Of a twist in the reference: x y z in mm, rotation vector in "
                                           "rad; row by row.\n" +
                                               square("covariance", *registration.covariance)
                                         : std::string()));
}

}  // namespace orcart
