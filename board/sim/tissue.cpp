// Simulated tissue: mottled ground, and veins along the walls of bent Voronoi cells, whose joints branch as
// veins do.
#include "board/sim/tissue.hpp"

#include <algorithm>
#include <cmath>

#include "board/sim/lattice_noise.hpp"

namespace orcart {
namespace {

/// One generation of vessels. Of the cell walls only some carry one, and it thins out along its way.
struct Vessels {
  float cell_mm = 0;   ///< distance between branches, about
  float width_mm = 0;  ///< half the width of the thickest
  float presence = 0;  ///< share of the walls that carry one
  float depth = 0;     ///< how far it takes the ground's place, 0..1
};

/// Linear colours and sizes of one kind of tissue.
struct Recipe {
  Eigen::Vector3f pale, flushed, vein;
  Vessels trunks, branches, capillaries;
};

const Recipe& recipe_for(TissueKind kind) {
  static const Recipe ventricle{
      .pale = {0.84F, 0.58F, 0.39F},
      .flushed = {0.66F, 0.30F, 0.22F},
      .vein = {0.34F, 0.075F, 0.065F},
      .trunks = {.cell_mm = 9, .width_mm = 0.34F, .presence = 0.36F, .depth = 0.92F},
      .branches = {.cell_mm = 3.6F, .width_mm = 0.15F, .presence = 0.40F, .depth = 0.7F},
      .capillaries = {.cell_mm = 1.3F, .width_mm = 0.075F, .presence = 0.42F, .depth = 0.34F}};
  static const Recipe cortex{
      .pale = {0.66F, 0.38F, 0.32F},
      .flushed = {0.55F, 0.20F, 0.17F},
      .vein = {0.22F, 0.02F, 0.03F},
      .trunks = {.cell_mm = 17, .width_mm = 0.85F, .presence = 0.45F, .depth = 0.95F},
      .branches = {.cell_mm = 6.5F, .width_mm = 0.3F, .presence = 0.45F, .depth = 0.85F},
      .capillaries = {.cell_mm = 2.2F, .width_mm = 0.1F, .presence = 0.5F, .depth = 0.45F}};
  return kind == TissueKind::ventricle ? ventricle : cortex;
}

float smooth_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

Eigen::Vector3f bent(const Eigen::Vector3f& point, float scale_mm, float reach_mm, std::uint32_t seed) {
  const Eigen::Vector3f p = point / scale_mm;
  return point + reach_mm * Eigen::Vector3f(fractal_noise(p, seed, 2), fractal_noise(p, seed + 11, 2),
                                            fractal_noise(p, seed + 23, 2));
}

/// How much of a vessel is at a point, 0..1: core, and a faint halo of blood shining through.
float vessel_at(const Eigen::Vector3f& point, const Vessels& vessels, std::uint32_t seed) {
  const Eigen::Vector3f p = bent(point, 0.6F * vessels.cell_mm, 0.55F * vessels.cell_mm, seed);
  const CellWall wall = nearest_cell_wall(p / vessels.cell_mm, seed + 5);
  const float chosen = static_cast<float>(hash32(wall.name) & 0xffffU) / 65536.0F;
  const float swell = 0.5F + 0.5F * gradient_noise(point / (1.7F * vessels.cell_mm), seed + 7);
  const float strength = smooth_step(0.0F, 0.25F, vessels.presence + 0.35F * (swell - 0.5F) - chosen);
  const float half_mm = vessels.width_mm * (0.35F + 0.65F * swell) * strength;
  if (half_mm <= 0) return 0;
  const float across_mm = wall.distance * vessels.cell_mm;
  const float core = 1 - smooth_step(0.25F * half_mm, 1.15F * half_mm, across_mm);
  const float halo = 0.22F * strength * std::exp(-across_mm / (1.6F * vessels.width_mm));
  return vessels.depth * std::max(core, halo);
}

}  // namespace

TissueSample tissue_sample(const Eigen::Vector3f& point_mm, const LivingTissue& tissue) {
  const Recipe& recipe = recipe_for(tissue.kind);
  const std::uint32_t seed = hash32(tissue.seed);
  const float flush = smooth_step(-0.25F, 0.55F, fractal_noise(point_mm / 9.0F, seed + 101, 3));
  const float mottle = fractal_noise(point_mm / 1.1F, seed + 131, 4);
  const float grain = fractal_noise(point_mm / 0.22F, seed + 151, 2);
  Eigen::Vector3f ground = recipe.pale + 0.75F * flush * (recipe.flushed - recipe.pale);
  ground *= 1 + 0.5F * mottle + 0.2F * grain;
  ground.y() *= 1 - 0.08F * mottle;  // the darker speckles are the browner ones
  float blood = vessel_at(point_mm, recipe.capillaries, seed + 211);
  blood = std::max(blood, vessel_at(point_mm, recipe.branches, seed + 307));
  blood = std::max(blood, vessel_at(point_mm, recipe.trunks, seed + 401));
  // Beer-Lambert towards the vein's colour: thin layers tint, thick ones hide.
  const Eigen::Vector3f colour = ground.array().pow(1 - blood) * recipe.vein.array().pow(blood);
  const float wet = 0.5F + 0.5F * fractal_noise(point_mm / 0.45F, seed + 503, 3) / 0.6F;
  return {.colour = colour.cwiseMax(0.0F).cwiseMin(1.0F), .gloss = std::clamp(wet, 0.0F, 1.0F)};
}

Eigen::Vector3f tissue_colour(const Eigen::Vector3f& point_mm, std::uint32_t seed, TissueKind kind) {
  return tissue_sample(point_mm, {.seed = seed, .kind = kind}).colour;
}

float coded_grey(const Eigen::Vector3f& point_mm, const CodedTissue& tissue) {
  const double turns = static_cast<double>(point_mm[tissue.axis]) / tissue.period_mm;
  return static_cast<float>(0.5 + 0.45 * std::sin(2 * std::numbers::pi * turns + tissue.phase_rad));
}

}  // namespace orcart
