// What a part of the chain is taken to be off by where neither passport nor registration states it.
#pragma once

namespace orcart {

/// One standard deviation each, unless said otherwise; shared by the cart and `orcart evaluate`.
struct AssumedErrors {
  /// RMS of a marker's 3-D error, as a tracker's accuracy is stated; each axis has it divided by sqrt(3).
  double marker_rms_mm = 0.12;
  double fiducial_rms_mm = 0.3;    ///< RMS of a fiducial's 3-D localisation error, image and pointer together
  double hand_eye_mm = 0.12;       ///< of C's place in the scope marker, each axis
  double hand_eye_rad = 0.0012;    ///< of its turn, each axis
  double lens_centre_px = 0.4;     ///< each axis
  double lens_focal = 0.001;       ///< relative
  double lens_edge_px = 0.3;       ///< of the distortion, at the edge of the picture
  double refraction = 0.001;       ///< relative, of the medium's index against the calibration's
  double time_s = 0.002;           ///< of the calibrated offset and the tracker's latency together
  double speed_mm_s = 10;          ///< of the tip at a capture, in a direction of chance
  double turn_rad_s = 0.1;         ///< likewise
  double light_post_rad = 0.0035;  ///< of an angled scope's turn, told or followed: 0.2 degrees
  double picture_px = 0.3;         ///< of a feature's place in the picture, each axis
};
inline constexpr AssumedErrors kAssumedErrors{};

}  // namespace orcart
