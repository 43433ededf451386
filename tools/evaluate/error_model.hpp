// What may be wrong between an endoscope's picture and the surface it is painted on, and by how much.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "firmware-host/stages/assumed_errors.hpp"

namespace orcart {

/// Where an error comes from. Each can be drawn alone.
enum class Component { tracker, hand_eye, registration, lens, medium, time, light_post, mapping };
inline constexpr std::size_t kComponents = 8;
inline constexpr std::array<const char*, kComponents> kComponentNames{
    "tracker", "hand-eye", "registration", "lens", "medium", "time", "light post", "mapping"};

/// Which components are drawn.
using ComponentSet = std::array<bool, kComponents>;
inline constexpr ComponentSet kAllComponents{true, true, true, true, true, true, true, true};
constexpr ComponentSet only(Component component) {
  ComponentSet set{};
  set[static_cast<std::size_t>(component)] = true;
  return set;
}

/// Where a standard deviation comes from.
enum class ErrorFrom { assumed, told, session, passport };

/// One standard deviation each, unless said otherwise. Gaussian, independent from set-up to set-up.
struct ErrorModel {
  /// RMS of a marker's 3-D error, as a tracker's accuracy is stated; each axis has it divided by sqrt(3).
  /// Drawn for every marker of scope and reference, and the bodies are fitted to them.
  double marker_rms_mm = kAssumedErrors.marker_rms_mm;
  double fiducial_rms_mm =
      kAssumedErrors
          .fiducial_rms_mm;  ///< RMS of a fiducial's 3-D localisation error, image and pointer together
  int fiducials = 6;
  double hand_eye_mm = kAssumedErrors.hand_eye_mm;        ///< of C's place in the scope marker, each axis
  double hand_eye_rad = kAssumedErrors.hand_eye_rad;      ///< of its turn, each axis
  double lens_centre_px = kAssumedErrors.lens_centre_px;  ///< each axis
  double lens_focal = kAssumedErrors.lens_focal;          ///< relative
  double lens_edge_px =
      kAssumedErrors
          .lens_edge_px;  ///< of the distortion, at the edge of the picture; with lens_root: of the lens
  double refraction =
      kAssumedErrors.refraction;          ///< relative, of the medium's index against the calibration's
  double time_s = kAssumedErrors.time_s;  ///< of the calibrated offset and the tracker's latency together
  double speed_mm_s = kAssumedErrors.speed_mm_s;  ///< of the tip at a capture, in a direction of chance
  double turn_rad_s = kAssumedErrors.turn_rad_s;  ///< likewise
  double light_post_rad =
      0;  ///< of an angled scope's turn; with_stated() fills it in where there is [turning]
  double picture_px = kAssumedErrors.picture_px;  ///< of a landmark's place in the picture, each axis
  double texel_mm = 0.15;                         ///< edge of a texel of the atlas: the paint's own grain

  /// Where passport and registration state what they leave open: columns whose squares sum up to the
  /// covariance. They take the place of the standard deviations above (see stated_errors.hpp).
  std::optional<Eigen::Matrix<double, 6, 6>> hand_eye_root;      ///< of a twist in C
  std::optional<Eigen::Matrix<double, 6, 6>> registration_root;  ///< of a twist in R
  std::optional<Eigen::Matrix<double, 11, 11>> lens_root;        ///< of the lens's numbers, as LensStep
  std::optional<Eigen::Matrix3d> window_root;  ///< of the window's place in C, mm: the tip's
  ErrorFrom time_from = ErrorFrom::assumed, light_post_from = ErrorFrom::assumed;
};

}  // namespace orcart
