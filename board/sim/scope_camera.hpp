// Draws what the simulated scope sees: rays through the calibrated lens onto the surface, lit from the tip.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "board/sim/tissue.hpp"
#include "realtime/base/image.hpp"
#include "realtime/geometry/pose.hpp"
#include "realtime/geometry/ray_scene.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

enum class Effect : std::uint8_t { off, on };

/// What of a real picture is drawn. Coded tissue is drawn without any of it.
struct SceneLook {
  Tissue tissue = LivingTissue{};
  Effect lighting = Effect::on;  ///< off: the reflectance itself, even light, no vignetting, gain 1
  Effect specular = Effect::on;  ///< wet highlights where the surface faces the light
  Effect noise = Effect::on;     ///< shot and read noise of the sensor
  Effect blur = Effect::on;      ///< motion during the exposure
  float texel_mm = 0.065F;       ///< how finely living tissue is sampled on the surface; finer takes longer
};

/// One pixel that can see something.
struct ScopePixel {
  std::uint32_t index = 0;  ///< row * width + column
  Eigen::Vector3f direction = Eigen::Vector3f::UnitZ();
  float weight = 1;  ///< 0 at the rim's outside, and in the notch
  float vignetting = 1;
};

/// Built before the run; draw() may run on any number of threads, each with a Scratch of its own. The
/// surface's mesh and ray scene are borrowed.
class ScopeCamera {
 public:
  ScopeCamera(const TriangleMesh& mesh, const RayScene& rays, const ScopeModel& scope, const SceneLook& look);
  ~ScopeCamera();
  ScopeCamera(ScopeCamera&&) noexcept;

  /// One thread's working memory for one camera.
  struct Scratch {
    std::vector<Eigen::Vector3f> directions, light;
    std::vector<RayHit> hits;
    double turn_rad = 0;  ///< that `pixels` are for
    std::vector<ScopePixel> pixels;
  };

  struct Exposure {
    std::uint64_t frame = 0;            ///< seeds the noise
    std::span<const Pose<M, C>> poses;  ///< spread evenly over the exposure; one where there is no blur
    float gain = 1;
    double turn_rad =
        0;  ///< of the light post since the scope's passport; lens, circle and notch go round with it
  };

  /// Draws into `image` (scope's size; yuyv or nv12, CPU planes).
  void draw(const Exposure& exposure, Scratch& scratch, const ImageDescriptor& image) const;
  /// The gain at which a picture from this pose is well exposed, from a coarse look; 1 without lighting.
  float fitting_gain(const Pose<M, C>& X_MC, Scratch& scratch) const;

  const SceneLook& look() const noexcept;
  const ScopeModel& scope() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace orcart
