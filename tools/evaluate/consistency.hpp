// How far two pictures of one place lie apart on the surface, without landmarks: by correlating what each
// paints there.
#pragma once

#include <vector>

#include "firmware-host/files/picture_file.hpp"
#include "tools/evaluate/scene.hpp"

namespace orcart {

/// A picture and the pose the cart believes it was taken from.
struct TakenPicture {
  Picture picture;
  Pose<M, C> X_MC;
  const ScopeModel* scope = nullptr;  ///< at the turn of its light post, lent; null: the scene's
};

/// One patch of surface that both pictures paint.
struct PatchShift {
  Eigen::Vector3d place_mm = Eigen::Vector3d::Zero();  ///< M
  Eigen::Vector2d shift_mm = Eigen::Vector2d::Zero();  ///< in the axes of tangents_of(normal)
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double correlation = 0;  ///< at the best shift, -1..1
};

struct PairConsistency {
  std::vector<PatchShift> patches;  ///< those with texture enough, correlation of at least 0.7, 0.1 above all
                                    ///< that is not beside it
  std::size_t looked_at = 0;        ///< patches that both pictures see whole, where the poses are right
  double median_mm = 0, p95_mm = 0;
};

struct ConsistencySettings {
  double patch_mm = 2.5;  ///< edge of a patch
  double step_mm = 0.1;   ///< of its samples and of the search
  double reach_mm = 3;    ///< of the search, either way: what lies farther apart is not found
  int patches = 60;       ///< tried a pair
};

/// Patches lie about points of the surface in the middle of the first picture that the second one sees too.
/// It cannot see a shift that both pictures share: an error of registration, hand-eye or lens that moves both
/// alike stays unseen.
PairConsistency compare(const EvaluationScene& scene, const TakenPicture& first, const TakenPicture& second,
                        const ConsistencySettings& settings, RandomStream& random);

}  // namespace orcart
