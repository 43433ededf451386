// From the project's own types to the shaders' numbers.
#include "render/atlas/paint_uniforms.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include <glm/gtc/type_ptr.hpp>

namespace orcart {
namespace {

static_assert(std::is_trivially_copyable_v<PaintUniforms> && alignof(PaintUniforms) == alignof(float));

float narrow(double value) {
  return static_cast<float>(value);
}

int number_of(LensModel model) {
  switch (model) {
    case LensModel::brown:
      return 0;
    case LensModel::poly4:
      return 1;
    case LensModel::fisheye:
      break;
  }
  return 2;
}

}  // namespace

PaintChoices choices_of(const ScopeModel& scope, const PainterSettings& settings) noexcept {
  return {.lens_model = number_of(scope.lens.model),
          .best = settings.policy == PaintPolicy::best,
          .yield = settings.highlights == Highlights::yield,
          .light = settings.light != LightModel::as_seen};
}

PaintUniforms uniforms_of(const ScopeModel& scope, const PainterSettings& settings, double texel_mm,
                          const DepthPinhole& pinhole) {
  PaintUniforms u{};
  const Lens& lens = scope.lens;
  u.u_aspect = narrow(lens.fx_px / lens.fy_px);
  u.u_pixel_rad = narrow(1.0 / lens.fx_px);
  u.u_texel_mm = narrow(texel_mm);
  u.u_facing = settings.seen_from == SeenFrom::outside ? 1.0F : -1.0F;
  u.u_cos_cone = narrow(std::cos(std::min(scope.cone_half_angle_rad, lens.max_angle_rad)));
  u.u_far_mm = narrow(scope.far_mm);
  u.u_cos_obliquity = narrow(std::cos(settings.max_obliquity_rad));
  u.u_depth_tangent = pinhole.tangent;
  u.u_depth_near = pinhole.near_mm;
  u.u_depth_far = pinhole.far_mm;
  u.u_depth_size = static_cast<float>(pinhole.size_texels);
  u.u_light = {narrow(scope.fall_off.reference_mm), narrow(scope.fall_off.vignetting_cos_power), 1.0F};
  u.u_view_error = {narrow(scope.residual_mm), 0.0F, narrow(scope.residual_px)};
  u.u_picture_size = {static_cast<float>(scope.width_px), static_cast<float>(scope.height_px)};
  set_optics(u, optics_at(scope, 0));
  return u;
}

void set_pose(PaintUniforms& uniforms, const Pose<C, M>& X_CM) noexcept {
  const Eigen::Matrix3f r = X_CM.rotation.cast<float>();
  const Eigen::Vector3f t = X_CM.translation_mm.cast<float>();
  uniforms.u_rotation_CM = glm::make_mat3(r.data());
  uniforms.u_translation_CM = glm::make_vec3(t.data());
}

void set_optics(PaintUniforms& uniforms, const TurnedOptics& optics) noexcept {
  const Lens& lens = optics.lens;
  uniforms.u_intrinsics = {narrow(lens.fx_px), narrow(lens.fy_px), narrow(lens.cx_px), narrow(lens.cy_px)};
  std::transform(lens.coefficients.begin(), lens.coefficients.end(), std::begin(uniforms.u_coefficients),
                 narrow);
  uniforms.u_distortion_centre = {narrow(lens.distortion_centre_px.x()),
                                  narrow(lens.distortion_centre_px.y())};
  const CircularMask& mask = optics.mask;
  uniforms.u_circle = {narrow(mask.cx_px), narrow(mask.cy_px), narrow(mask.radius_px),
                       narrow(std::max(mask.soft_edge_px, 1e-3))};
  uniforms.u_notch = {0, 0};
  if (optics.notch_rad)
    uniforms.u_notch = {narrow(std::cos(*optics.notch_rad)), narrow(std::sin(*optics.notch_rad))};
}

}  // namespace orcart
