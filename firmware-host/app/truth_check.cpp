// Phase-shifted waves (three phases, 120 degrees apart) as in structured-light metrology: phase = atan2 of
// two differences, independent of amplitude and offset (Creath 1988, three-step formula).
#include "firmware-host/app/truth_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "board/sim/scope_camera.hpp"
#include "firmware-host/offline/offline_painter.hpp"
#include "realtime/optics/scope_turn.hpp"

namespace orcart {
namespace {

constexpr double kPeriodMm = 20;
constexpr int kPhases = 3;
constexpr std::size_t kErrorBins = 100;

/// The greys of one texel, by axis and phase.
using Greys = std::array<std::array<std::uint8_t, kPhases>, 3>;

double wrapped_mm(double mm) {
  return mm - kPeriodMm * std::round(mm / kPeriodMm);
}

/// Coordinate minus its decoded value, along one axis. Grey = 0.5 + A sin(w x + phase_k), phase_k = 120 k
/// degrees.
double error_along(double coordinate_mm, const std::array<std::uint8_t, kPhases>& grey) {
  const double g0 = grey[0], g1 = grey[1], g2 = grey[2];
  const double sine = 2 * g0 - g1 - g2, cosine = std::numbers::sqrt3 * (g1 - g2);
  const double decoded_mm = std::atan2(sine, cosine) / (2 * std::numbers::pi) * kPeriodMm;
  return wrapped_mm(coordinate_mm - decoded_mm);
}

Eigen::Vector3d point_behind(const TriangleMesh& mesh, const TexelOwner& owner) {
  const auto& corners = mesh.triangles[owner.triangle];
  const Eigen::Vector3d a = mesh.vertices_mm[corners[0]].cast<double>();
  return a + double(owner.b1) * (mesh.vertices_mm[corners[1]].cast<double>() - a) +
         double(owner.b2) * (mesh.vertices_mm[corners[2]].cast<double>() - a);
}

class TruthChecker {
 public:
  TruthChecker(const Patient& patient, const RayScene& rays, OfflinePainter& painter, PixelFormat format)
      : patient_(patient),
        rays_(rays),
        painter_(painter),
        format_(format),
        pixels_(packed_bytes(format, patient.scope.width_px, patient.scope.height_px)),
        greys_(patient.layout.owners.size()),
        painted_(patient.layout.owners.size()) {}

  Result<void> add(const JudgedView& view) {
    std::fill(painted_.begin(), painted_.end(), 0);
    for (int axis = 0; axis < 3; ++axis) {
      for (int phase = 0; phase < kPhases; ++phase) {
        if (auto painted = paint_wave(view, axis, phase); !painted) return painted;
      }
    }
    for (std::size_t i = 0; i < greys_.size(); ++i) {
      if (painted_[i] == 3 * kPhases && patient_.layout.inside[i] != 0) judge(i);
    }
    return {};
  }

  PaintingError result(const std::string& name) {
    PaintingError error{
        .name = name, .texels = errors_mm_.size(), .bins = std::vector<std::uint64_t>(kErrorBins, 0)};
    if (errors_mm_.empty()) return error;
    std::sort(errors_mm_.begin(), errors_mm_.end());
    double sum = 0;
    for (const float e : errors_mm_) {
      sum += e;
      ++error.bins[std::min(kErrorBins - 1, static_cast<std::size_t>(e / kErrorBinMm))];
    }
    error.mean_mm = sum / static_cast<double>(errors_mm_.size());
    error.p95_mm = errors_mm_[errors_mm_.size() * 95 / 100];
    error.max_mm = errors_mm_.back();
    return error;
  }

 private:
  Result<void> paint_wave(const JudgedView& view, int axis, int phase) {
    const SceneLook look{.tissue = CodedTissue{.axis = axis,
                                               .period_mm = kPeriodMm,
                                               .phase_rad = 2 * std::numbers::pi * phase / kPhases}};
    const ScopeModel scope = turned(patient_.scope, view.true_turn_rad);
    const ScopeCamera camera(patient_.surface.mesh, rays_, scope, look);
    const ImageDescriptor image =
        packed_image(pixels_.data(), format_, patient_.scope.width_px, patient_.scope.height_px);
    camera.draw({.poses = {&view.true_pose, 1}}, scratch_, image);
    painter_.painter().clear();
    auto painted = painter_.paint(image, view.believed, view.believed_turn_rad);
    if (!painted) return tl::unexpected(painted.error());
    const AtlasPicture atlas = painter_.painter().read_back();
    for (std::size_t i = 0; i < greys_.size(); ++i) {
      greys_[i][static_cast<std::size_t>(axis)][static_cast<std::size_t>(phase)] = atlas.rgba[4 * i + 1];
      painted_[i] = static_cast<std::uint8_t>(painted_[i] + (atlas.rgba[4 * i + 3] == 255));
    }
    return {};
  }

  void judge(std::size_t texel) {
    const Eigen::Vector3d p = point_behind(patient_.surface.mesh, patient_.layout.owners[texel]);
    Eigen::Vector3d error;
    for (int axis = 0; axis < 3; ++axis)
      error[axis] = error_along(p[axis], greys_[texel][static_cast<std::size_t>(axis)]);
    errors_mm_.push_back(static_cast<float>(error.norm()));
  }

  const Patient& patient_;
  const RayScene& rays_;
  OfflinePainter& painter_;
  PixelFormat format_;
  ScopeCamera::Scratch scratch_;
  std::vector<std::byte> pixels_;
  std::vector<Greys> greys_;
  std::vector<std::uint8_t> painted_;  ///< how many of the nine pictures painted the texel fully
  std::vector<float> errors_mm_;
};

}  // namespace

Result<PaintingError> check_painting(const Patient& patient, const std::vector<JudgedView>& views,
                                     const TruthCheckRequest& request,
                                     const std::function<void(double)>& progress) {
  auto rays = RayScene::create(patient.surface.mesh);
  if (!rays) return tl::unexpected(rays.error());
  auto painter = OfflinePainter::create(
      patient.surface, patient.scope,
      {.seen_from = request.seen_from, .mode = request.mode, .texel_mm = patient.layout.texel_mm});
  if (!painter) return tl::unexpected(painter.error());
  TruthChecker checker(patient, *rays, *painter, request.format);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (auto added = checker.add(views[i]); !added) return tl::unexpected(added.error());
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(views.size()));
  }
  return checker.result(request.name);
}

}  // namespace orcart
