// A texel is a landmark: its point, its triangle's normal, its pixel in the view that painted it.
#include "tools/evaluate/texels/texel_errors.hpp"

#include <map>
#include <thread>

#include "tools/evaluate/draw.hpp"

namespace orcart {

namespace {

constexpr std::uint16_t kBare = 0;

/// Nothing where the texel is not painted.
std::optional<Landmark> landmark_of(const PaintedTexels& painted, std::size_t texel) {
  const std::uint16_t capture = painted.records.texels[texel].capture;
  if (painted.layout.inside[texel] == 0 || capture == kBare || capture > painted.views.size())
    return std::nullopt;
  const EvaluationScene& scene = painted.scenes[capture - 1U]->scene;
  const Pose<M, C>& X_MC = painted.views[capture - 1U].X_MC;
  const TexelOwner& owner = painted.layout.owners[texel];
  const auto& t = scene.mesh.triangles[owner.triangle];
  const Eigen::Vector3d a = scene.mesh.vertices_mm[t[0]].cast<double>(),
                        ab = scene.mesh.vertices_mm[t[1]].cast<double>() - a,
                        ac = scene.mesh.vertices_mm[t[2]].cast<double>() - a;
  Landmark landmark{.place_mm = a + static_cast<double>(owner.b1) * ab + static_cast<double>(owner.b2) * ac,
                    .normal = ab.cross(ac).normalized()};
  const Eigen::Vector3d from_scope = landmark.place_mm - X_MC.translation_mm;
  if (landmark.normal.dot(from_scope) > 0) landmark.normal = -landmark.normal;
  const auto pixel = project(scene.scope.lens, X_MC.rotation.transpose() * from_scope);
  if (!pixel) return std::nullopt;
  landmark.pixel = *pixel;
  return landmark;
}

void judge(const EvaluationScene& scene, const Capture& capture, const Landmark& landmark,
           const DrawnErrors& errors, const LandmarkErrors& own, const PredictedError& predicted,
           DrawnCoverage& drawn) {
  const auto place = painted_place(scene, capture, landmark, errors, own);
  const auto on_plane = painted_on_plane(scene, capture, landmark, errors, own);
  if (!place || !on_plane) {
    ++drawn.lost;
    return;
  }
  const auto tangents = tangents_of(landmark.normal);
  const Eigen::Vector2d error = tangents.transpose() * (*place - landmark.place_mm),
                        flat = tangents.transpose() * (*on_plane - landmark.place_mm);
  if ((*place - *on_plane).norm() > 1 + flat.norm()) {
    ++drawn.jumped;
    return;
  }
  ++drawn.coverage.points;
  drawn.coverage.covered += predicted.covers(error) ? 1 : 0;
}

ErrorSpread spread_of(const TurnedScene& at, const std::vector<Eigen::Vector3d>& fiducials_M_mm) {
  return spread_of(at.scene, at.model, fiducials_M_mm);  // markers and fiducials alone: of any turn
}

/// One set-up's errors at each turn, from the same random numbers: what has a covariance in C has it in the
/// axes that C has there. Two views of one turn share them; between two turns the hand-eye's are drawn alike,
/// not one.
class SetupErrors {
 public:
  SetupErrors(const RandomStream& start, const std::vector<Eigen::Vector3d>& fiducials_M_mm)
      : start_(start), fiducials_M_mm_(fiducials_M_mm) {}

  const DrawnErrors& at(const TurnedScene& turned) {
    const auto known = drawn_.find(&turned);
    if (known != drawn_.end()) return known->second;
    RandomStream random = start_;
    return drawn_
        .emplace(&turned, drawn_errors(turned.scene, turned.model, kAllComponents, fiducials_M_mm_, random))
        .first->second;
  }

 private:
  RandomStream start_;
  const std::vector<Eigen::Vector3d>& fiducials_M_mm_;
  std::map<const TurnedScene*, DrawnErrors> drawn_;
};

}  // namespace

std::vector<const TurnedScene*> scenes_of(const std::vector<View>& views, TurnedScenes& scenes) {
  std::vector<const TurnedScene*> of_views;
  of_views.reserve(views.size());
  for (const View& view : views) of_views.push_back(&scenes.at(view.turn_rad));
  return of_views;
}

std::vector<float> predicted_rms_mm(const std::vector<Eigen::Vector3d>& fiducials_M_mm,
                                    const PaintedTexels& painted) {
  const ErrorSpread spread = spread_of(*painted.scenes.front(), fiducials_M_mm);
  std::vector<float> rms_mm(painted.layout.owners.size(), -1);
  const auto work = [&](std::size_t first) {
    for (std::size_t i = first; i < rms_mm.size(); i += 2) {
      const auto landmark = landmark_of(painted, i);
      if (!landmark) continue;
      const std::size_t view = painted.records.texels[i].capture - 1U;
      const TurnedScene& at = *painted.scenes[view];
      const Capture capture = capture_of(painted.views[view], at.model);
      if (const auto error = predict(at.scene, at.model, spread, capture, *landmark))
        rms_mm[i] = static_cast<float>(error->rms_mm());
    }
  };
  std::thread other(work, 1);
  work(0);
  other.join();
  return rms_mm;
}

DrawnCoverage drawn_coverage(const std::vector<Eigen::Vector3d>& fiducials_M_mm, const PaintedTexels& painted,
                             int setups, RandomStream& random) {
  constexpr std::size_t kTexelsOfAView = 8;
  const ErrorSpread spread = spread_of(*painted.scenes.front(), fiducials_M_mm);
  std::vector<std::vector<std::size_t>> of_view(painted.views.size());
  for (std::size_t i = 0; i < painted.layout.owners.size(); ++i)
    if (landmark_of(painted, i)) of_view[painted.records.texels[i].capture - 1U].push_back(i);
  DrawnCoverage drawn;
  for (int setup = 0; setup < setups; ++setup) {
    SetupErrors all(random, fiducials_M_mm);
    const TurnedScene& any = *painted.scenes.front();
    (void)drawn_errors(any.scene, any.model, kAllComponents, fiducials_M_mm, random);  // goes on behind them
    for (std::size_t v = 0; v < of_view.size(); ++v) {
      if (of_view[v].empty()) continue;
      const TurnedScene& at = *painted.scenes[v];
      // The tracker is read anew for every capture; all else stays.
      DrawnErrors errors = all.at(at);
      errors.scope = drawn_body(at.scene.scope_markers_mm, at.model.marker_rms_mm, random);
      errors.reference = drawn_body(at.scene.reference_markers_mm, at.model.marker_rms_mm, random);
      const Capture capture = capture_of(painted.views[v], at.model);
      for (std::size_t n = 0; n < kTexelsOfAView; ++n) {
        const std::size_t texel = of_view[v][random.next() % of_view[v].size()];
        const Landmark landmark = *landmark_of(painted, texel);
        const auto predicted = predict(at.scene, at.model, spread, capture, landmark);
        const LandmarkErrors own = drawn_landmark_errors(at.model, kAllComponents, random);
        if (predicted) judge(at.scene, capture, landmark, errors, own, *predicted, drawn);
      }
    }
  }
  return drawn;
}

}  // namespace orcart
