// A passport made in air for use in fluid: refraction at a flat window, and what a single viewpoint then
// leaves.
#pragma once

#include "realtime/base/result.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

/// Index of refraction at 20 to 37 degrees in visible light: air 1, water 1.333, saline (0.9 %) 1.335.
double refractive_index(Medium medium);

/// What the conversion is not sure of.
struct MediumDoubt {
  double window_mm = 0.3;  ///< standard deviation of the window's place before C
  double index = 0.003;    ///< of the fluid's index: warmth, salt, blood
};

struct MediumConversion {
  ScopeModel scope;             ///< in the fluid
  double viewpoint_mm = 0;      ///< by how much the optical centre moves back from the window
  double viewpoint_rms_px = 0;  ///< what one viewpoint cannot bring together between 5 and 60 mm
  double viewpoint_worst_px = 0;
  double added_px = 0;  ///< of viewpoint, window and index together, RMS
  double added_mm = 0;  ///< the same on a surface 20 mm before the window
};

/// A point in fluid, `depth_mm` before the window, that a pixel of a scope calibrated in air sees: its ray
/// leaves the window where it did in air and bends there (Snell). C's frame in air. Nothing where the pixel
/// sees nothing.
std::optional<Eigen::Vector3d> seen_in_fluid(const ScopeModel& air, const Eigen::Vector2d& pixel,
                                             double index, double depth_mm);

/// Refuses a passport that is not made in air, fluid that is air, and a window that is not known (X_CE).
Result<MediumConversion> to_fluid(const ScopeModel& air, Medium fluid, const MediumDoubt& doubt);

/// The view's angle against radius in air and fluid, and what one viewpoint leaves at each depth. `text` is
/// the answer as the terminal shows it.
std::string medium_page(const ScopeModel& air, const MediumConversion& fluid, const std::string& text);

}  // namespace orcart
