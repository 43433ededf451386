// Step 5 up to the painting: the cutout of the surface by the viewing cone, facing, occlusion and the five
// rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "realtime/mapper/cutout_patch.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

/// The work of one next(). Counted work bounds it: the same view gives the same parts on any machine.
struct MapperLimits {
  std::uint32_t max_triangles_per_step = 60'000;  ///< looked at; more are carried. At least a cluster's 48
  std::uint32_t max_rays_per_step = 5'000;        ///< traced for occlusion. At least a cluster's 192
  double max_obliquity_rad = 1.3963;  ///< 80 degrees between ray and normal; steeper gets no paint
  bool test_occlusion = true;         ///< false: what is hidden is left to the painter's depth
};

/// What both lists of a CutoutPatch must hold: Mapper::next() never puts more into one part.
std::size_t patch_capacity(const MapperLimits& limits);

/// Owns the cluster tree and the ray tree of one surface. Built off the real-time path; begin() and next()
/// are real-time and belong to one thread.
class Mapper {
 public:
  /// Refuses a surface without triangles or with broken ones, and a cone that is not between 0 and 85
  /// degrees.
  static Result<Mapper> create(const Surface& surface, SeenFrom seen_from, const ScopeModel& scope,
                               const MapperLimits& limits = {});
  Mapper(Mapper&&) noexcept;
  Mapper& operator=(Mapper&&) noexcept;
  ~Mapper();

  /// Starts a view and traces its five rays; forgets what was carried of the one before.
  void begin(const Pose<M, C>& X_MC, TextureMode mode) noexcept;
  /// Fills `patch` with the next part of the view, at most the limits' worth of work, and returns true;
  /// returns false, `patch` untouched, when the part before was the last. Each view has at least one part,
  /// which may be empty. A view in paper mode whose centre ray missed has one empty part, with paper.valid
  /// false. Allocates nothing.
  bool next(CutoutPatch& patch) noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
  explicit Mapper(std::unique_ptr<State> state);
};

}  // namespace orcart
