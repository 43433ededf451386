// Each capture's own part, patch by patch.
#include "tools/evaluate/pair_prediction.hpp"

#include <cmath>

namespace orcart {

namespace {

std::optional<Landmark> landmark_of(const EvaluationScene& scene, const Pose<M, C>& X_MC,
                                    const PatchShift& patch) {
  const auto pixel =
      project(scene.scope.lens, X_MC.rotation.transpose() * (patch.place_mm - X_MC.translation_mm));
  if (!pixel) return std::nullopt;
  return Landmark{.place_mm = patch.place_mm, .normal = patch.normal, .pixel = *pixel};
}

}  // namespace

double predicted_apart_mm(const std::vector<Eigen::Vector3d>& fiducials_M_mm, const PairConsistency& pair,
                          const JudgedCapture& first, const JudgedCapture& second) {
  if (pair.patches.empty()) return 0;
  const ErrorSpread spread =
      spread_of(first.scene, first.model, fiducials_M_mm);  // of no lens: as the second's
  double sum = 0;
  for (const PatchShift& patch : pair.patches)
    for (const JudgedCapture* one : {&first, &second}) {
      const auto landmark = landmark_of(one->scene, one->capture.X_MC, patch);
      const auto error =
          landmark ? predict(one->scene, one->model, spread, one->capture, *landmark, kApart) : std::nullopt;
      if (error) sum += error->covariance_mm2.trace();
    }
  return std::sqrt(sum / static_cast<double>(pair.patches.size()));
}

}  // namespace orcart
