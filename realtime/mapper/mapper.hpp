// Step 5 up to the painting: the cutout of the surface by the viewing cone, facing, occlusion and the five rays.
#pragma once

#include <cstdint>
#include <memory>

#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "realtime/mapper/cutout_patch.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

struct MapperLimits {
  std::uint32_t max_triangles_per_step = 60'000;  ///< triangles looked at in one step; more are carried
  double max_obliquity_rad = 1.3963;              ///< 80 degrees between ray and normal; steeper gets no paint
};

/// Owns the cluster tree and the ray tree of one surface. Built off the real-time path; map() is real-time.
class Mapper {
 public:
  static Result<Mapper> create(const Surface& surface, SeenFrom seen_from, const ScopeModel& scope,
                               const MapperLimits& limits = {});
  Mapper(Mapper&&) noexcept;
  Mapper& operator=(Mapper&&) noexcept;
  ~Mapper();

  /// Starts a view: forgets what was carried of the one before.
  void begin(const Pose<M, C>& X_MC, TextureMode mode) noexcept;
  /// Fills `patch` with the next part of the view, at most the limits' worth of work. Returns false when the view has
  /// no more parts. Allocates nothing; patch.triangles must have capacity for max_triangles_per_step.
  bool next(CutoutPatch& patch) noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
  explicit Mapper(std::unique_ptr<State> state);
};

}  // namespace orcart
