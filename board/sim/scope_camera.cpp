// Rays, light and colour of one simulated picture; see scope_camera.hpp.
#include "board/sim/scope_camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "board/sim/baked_tissue.hpp"
#include "board/sim/sensor.hpp"
#include "board/sim/surface_normals.hpp"
#include "realtime/optics/scope_turn.hpp"

namespace orcart {
namespace {

constexpr float kFar_mm = 200;
constexpr float kLightReference_mm = 10;  ///< at this distance light of gain 1 is 1
constexpr float kRimSoftness_px = 2.5F;   ///< the picture's own edge, centred on the mask's radius
constexpr int kCoarse = 97;               ///< fitting_gain looks at every 97th pixel
constexpr float kMeanWanted = 0.20F, kBrightWanted = 0.75F, kHighestGain = 12;

/// A black tooth that points inward from the rim, where the passport has a notch.
constexpr double kNotchDepth = 0.09, kNotchHalfWidth_rad = 0.05;
constexpr float kNotchSoftness_px = 1.2F;

/// What falls on a point at gain 1: a factor on the reflectance, and what is mirrored.
struct Illumination {
  Eigen::Array3f diffuse = Eigen::Array3f::Zero();
  float specular = 0;
};

float smooth_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

/// 0 within the notch. `radius` and angle about the mask's centre, square pixels.
float beside_notch(const ScopeModel& scope, double radius_px, double angle_rad) {
  if (!scope.notch_rad) return 1;
  const double depth = (radius_px / scope.mask.radius_px - (1 - kNotchDepth)) / kNotchDepth;
  const double along = std::abs(std::remainder(angle_rad - *scope.notch_rad, 2 * std::numbers::pi));
  const double off_px = (along - kNotchHalfWidth_rad * std::max(depth, -1.0)) * radius_px;
  return smooth_step(-kNotchSoftness_px, kNotchSoftness_px, static_cast<float>(off_px));
}

/// The pixel as the mask and the lens have it; nothing where it stays black.
std::optional<ScopePixel> pixel_at(const ScopeModel& scope, int x, int y) {
  const double aspect = scope.lens.fy_px / scope.lens.fx_px;
  const Eigen::Vector2d off(x - scope.mask.cx_px, (y - scope.mask.cy_px) / aspect);
  const double radius = off.norm();
  const auto beyond = static_cast<float>(radius - scope.mask.radius_px);
  if (beyond > kRimSoftness_px) return std::nullopt;
  const auto direction = direction_of(scope.lens, {static_cast<double>(x), static_cast<double>(y)});
  if (!direction) return std::nullopt;
  const float rim = smooth_step(0.80F, 1.03F, static_cast<float>(radius / scope.mask.radius_px));
  const double off_axis = std::pow(std::max(direction->z(), 0.05), scope.fall_off.vignetting_cos_power);
  return ScopePixel{.index = static_cast<std::uint32_t>(y * scope.width_px + x),
                    .direction = direction->cast<float>(),
                    .weight = (1 - smooth_step(-kRimSoftness_px, kRimSoftness_px, beyond)) *
                              beside_notch(scope, radius, std::atan2(off.y(), off.x())),
                    .vignetting = static_cast<float>(off_axis) * (1 - 0.45F * rim)};
}

std::vector<ScopePixel> pixels_of(ScopeModel scope, bool coded) {
  if (coded) scope.notch_rad.reset();  // the code is what the surface shows, all of it
  std::vector<ScopePixel> pixels;
  for (int y = 0; y < scope.height_px; ++y)
    for (int x = 0; x < scope.width_px; ++x)
      if (const auto pixel = pixel_at(scope, x, y)) pixels.push_back(*pixel);
  return pixels;
}

}  // namespace

struct ScopeCamera::State {
  const TriangleMesh& mesh;
  const RayScene& rays;
  ScopeModel scope;
  SceneLook look;
  std::vector<Eigen::Vector3f> normals;
  std::vector<ScopePixel> pixels;      ///< at the passport's turn
  std::unique_ptr<BakedTissue> baked;  ///< null for coded tissue

  bool coded() const { return std::holds_alternative<CodedTissue>(look.tissue); }
  bool lit() const { return look.lighting == Effect::on && !coded(); }
  Eigen::Vector3f normal_at(const RayHit& hit) const;
  Illumination illumination(const RayHit& hit, const Eigen::Vector3f& direction) const;
  Eigen::Vector3f reflectance(const RayHit& hit, const Pose<M, C>& X_MC,
                              const Eigen::Vector3f& direction) const;
  const std::vector<ScopePixel>& pixels_at(double turn_rad, Scratch& scratch) const;
  void light_up(const std::vector<ScopePixel>& seen, Scratch& scratch, float gain) const;
  void trace(const std::vector<ScopePixel>& seen, const Pose<M, C>& X_MC, std::size_t every,
             Scratch& scratch) const;
};

Eigen::Vector3f ScopeCamera::State::normal_at(const RayHit& hit) const {
  const auto& t = mesh.triangles[hit.triangle];
  return ((1 - hit.b1 - hit.b2) * normals[t[0]] + hit.b1 * normals[t[1]] + hit.b2 * normals[t[2]])
      .normalized();
}

/// Light at the tip beside the lens: 1/d^2, wrapped Lambert (red scatters furthest under the skin), a little
/// light that the walls throw back, and highlights where wet tissue faces the light.
Illumination ScopeCamera::State::illumination(const RayHit& hit, const Eigen::Vector3f& direction) const {
  const float facing = std::abs(normal_at(hit).dot(direction));
  const float near = kLightReference_mm / std::max(hit.distance_mm, 1.5F);
  const Eigen::Array3f wrap(0.35F, 0.18F, 0.14F), bounced(0.055F, 0.035F, 0.028F);
  Illumination light{.diffuse = near * near * (facing + wrap) / (1 + wrap) + bounced * near};
  const float tilt = 1 - facing;  // about half the square of the angle between normal and light
  if (look.specular == Effect::off || tilt > 0.25F) return light;
  const float gloss = baked->at(hit).gloss;
  const float sheen = std::exp(-tilt / 0.05F) * smooth_step(0.50F, 0.95F, gloss);
  const float spark = std::exp(-tilt / 0.007F) * smooth_step(0.42F, 0.85F, gloss);
  light.specular = near * near * (0.10F * sheen + 1.0F * spark);
  return light;
}

/// What the surface itself shows at a hit: reflectance, or coded tissue's displayed grey.
Eigen::Vector3f ScopeCamera::State::reflectance(const RayHit& hit, const Pose<M, C>& X_MC,
                                                const Eigen::Vector3f& direction) const {
  if (hit.distance_mm < 0) return Eigen::Vector3f::Zero();
  if (const auto* code = std::get_if<CodedTissue>(&look.tissue))
    return Eigen::Vector3f::Constant(
        coded_grey(X_MC.translation_mm.cast<float>() + hit.distance_mm * direction, *code));
  return baked->at(hit).colour;
}

/// Multiplies what the pixels show by the light that falls there; `scratch` holds the rays of the middle
/// pose. Light changes so slowly that one pose stands for the exposure; only what it falls on is blurred.
void ScopeCamera::State::light_up(const std::vector<ScopePixel>& seen, Scratch& scratch, float gain) const {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (scratch.hits[i].distance_mm < 0) continue;
    const Illumination light = illumination(scratch.hits[i], scratch.directions[i]);
    Eigen::Vector3f& shown = scratch.light[seen[i].index];
    shown = gain * seen[i].vignetting * (shown.array() * light.diffuse + seen[i].weight * light.specular);
  }
}

/// A turned scope's own are worked out anew for each turn: slow, and drawing is not in a hurry.
const std::vector<ScopePixel>& ScopeCamera::State::pixels_at(double turn_rad, Scratch& scratch) const {
  if (turn_rad == 0) return pixels;
  if (scratch.pixels.empty() || scratch.turn_rad != turn_rad) {
    scratch.pixels = pixels_of(turned(scope, turn_rad), coded());
    scratch.turn_rad = turn_rad;
  }
  return scratch.pixels;
}

/// Fills scratch.hits with what every `every`-th of the pixels sees.
void ScopeCamera::State::trace(const std::vector<ScopePixel>& seen, const Pose<M, C>& X_MC, std::size_t every,
                               Scratch& scratch) const {
  const Eigen::Matrix3f rotation = X_MC.rotation.cast<float>();
  scratch.directions.clear();
  for (std::size_t i = 0; i < seen.size(); i += every)
    scratch.directions.emplace_back(rotation * seen[i].direction);
  scratch.hits.resize(scratch.directions.size());
  rays.nearest_many(X_MC.translation_mm.cast<float>(), scratch.directions, kFar_mm, scratch.hits);
}

ScopeCamera::ScopeCamera(const TriangleMesh& mesh, const RayScene& rays, const ScopeModel& scope,
                         const SceneLook& look)
    : state_(new State{.mesh = mesh,
                       .rays = rays,
                       .scope = scope,
                       .look = look,
                       .normals = vertex_normals(mesh),
                       .pixels = pixels_of(scope, std::holds_alternative<CodedTissue>(look.tissue)),
                       .baked = nullptr}) {
  if (const auto* living = std::get_if<LivingTissue>(&look.tissue))
    state_->baked = std::make_unique<BakedTissue>(mesh, *living, look.texel_mm);
}

ScopeCamera::~ScopeCamera() = default;
ScopeCamera::ScopeCamera(ScopeCamera&&) noexcept = default;
const SceneLook& ScopeCamera::look() const noexcept {
  return state_->look;
}
const ScopeModel& ScopeCamera::scope() const noexcept {
  return state_->scope;
}

void ScopeCamera::draw(const Exposure& exposure, Scratch& scratch, const ImageDescriptor& image) const {
  const State& s = *state_;
  scratch.light.assign(static_cast<std::size_t>(image.width_px * image.height_px), Eigen::Vector3f::Zero());
  const std::vector<ScopePixel>& seen = s.pixels_at(exposure.turn_rad, scratch);
  const std::size_t count = exposure.poses.size(), middle = count / 2;
  for (std::size_t i = 0; i < count; ++i) {
    const Pose<M, C>& X_MC = exposure.poses[(middle + 1 + i) % count];  // the middle one last: its rays stay
    s.trace(seen, X_MC, 1, scratch);
    for (std::size_t p = 0; p < seen.size(); ++p)
      scratch.light[seen[p].index] += seen[p].weight / static_cast<float>(count) *
                                      s.reflectance(scratch.hits[p], X_MC, scratch.directions[p]);
  }
  if (s.lit()) s.light_up(seen, scratch, exposure.gain);
  if (!s.coded()) {
    if (s.look.noise == Effect::on) add_sensor_noise(scratch.light, exposure.frame);
    for (Eigen::Vector3f& light : scratch.light) light = light.unaryExpr(&displayed);
  }
  pack_yuv(scratch.light, image);
}

float ScopeCamera::fitting_gain(const Pose<M, C>& X_MC, Scratch& scratch) const {
  const State& s = *state_;
  if (!s.lit()) return 1;
  s.trace(s.pixels, X_MC, kCoarse, scratch);
  std::vector<float> brightness;
  for (std::size_t i = 0; i < scratch.hits.size(); ++i) {
    if (scratch.hits[i].distance_mm < 0) continue;
    const Illumination light = s.illumination(scratch.hits[i], scratch.directions[i]);
    brightness.push_back(s.pixels[i * kCoarse].vignetting *
                         (light.diffuse * s.baked->at(scratch.hits[i]).colour.array()).mean());
  }
  if (brightness.empty()) return 1;
  std::ranges::sort(brightness);
  double sum = 0;
  for (const float b : brightness) sum += std::min(b, 4 * brightness[brightness.size() / 2]);
  const auto mean = static_cast<float>(sum / static_cast<double>(brightness.size()));
  const float bright = brightness[brightness.size() * 9 / 10];
  return std::min(
      {kMeanWanted / std::max(mean, 1e-6F), kBrightWanted / std::max(bright, 1e-6F), kHighestGain});
}

}  // namespace orcart
