// What the inside of a head looks like: colour as a pure function of the point in mesh space, so that paint
// can be judged.
#pragma once

#include <cstdint>
#include <numbers>
#include <variant>

#include <Eigen/Core>

namespace orcart {

enum class TissueKind : std::uint8_t {
  ventricle,  ///< ependyma: pale, yellowish pink, fine veins
  cortex,     ///< pia over grey matter: pinker, with larger vessels
};

/// Tissue with mottling and branching veins.
struct LivingTissue {
  std::uint32_t seed = 1;
  TissueKind kind = TissueKind::ventricle;
};

/// A wave of grey along one axis of mesh space, which tells WHERE on the surface a light came from. Drawn as
/// it is: no light, no noise, no blur. Grey = 0.5 + 0.45 sin(2 pi coordinate / period + phase), 0 black, 1
/// white as displayed.
struct CodedTissue {
  int axis = 0;  ///< 0 x, 1 y, 2 z of M
  double period_mm = 40;
  double phase_rad = 0;
};

using Tissue = std::variant<LivingTissue, CodedTissue>;

/// Linear reflectance, red green blue, 0..1, of a point in mm (M), and how wet it glistens there, 0..1.
struct TissueSample {
  Eigen::Vector3f colour = Eigen::Vector3f::Zero();
  float gloss = 0;
};
TissueSample tissue_sample(const Eigen::Vector3f& point_mm, const LivingTissue& tissue);

/// The colour alone, of the ventricle's tissue unless told otherwise.
Eigen::Vector3f tissue_colour(const Eigen::Vector3f& point_mm, std::uint32_t seed,
                              TissueKind kind = TissueKind::ventricle);

/// The displayed grey of coded tissue.
float coded_grey(const Eigen::Vector3f& point_mm, const CodedTissue& tissue);

}  // namespace orcart
