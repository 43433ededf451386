// Points of the scope are projected one by one; it is a handful of strokes.
#include "render/views/scope_outline.hpp"

#include <cmath>
#include <numbers>
#include <optional>

namespace orcart {
namespace {

constexpr Colour kMeasured{120, 220, 255, 230}, kPredicted{255, 200, 90, 230};
constexpr double kConeMm = 9;       // how far the cone is drawn
constexpr double kShaftMm = 70;     // how much of the shaft
constexpr double kRadiusMm = 1.35;  // of a 2.7 mm scope
constexpr int kSegments = 24;

class Outliner {
 public:
  Outliner(HudCanvas& canvas, const HudBox& view, const Eye& eye, const ScopeOutline& outline)
      : canvas_(canvas),
        view_(view),
        outline_(outline),
        matrices_(matrices_of(eye, double(view.width) / view.height)) {}

  std::optional<HudPoint> place(const Eigen::Vector3d& p_C) const {
    const Eigen::Vector3d p = (outline_.X_MC * Point<C>{p_C}).mm;
    const glm::vec4 clip = matrices_.projection * (matrices_.view * glm::vec4(p.x(), p.y(), p.z(), 1));
    if (clip.w <= 0.01f) return std::nullopt;
    return HudPoint{view_.x + (clip.x / clip.w * 0.5f + 0.5f) * view_.width,
                    view_.y + (clip.y / clip.w * 0.5f + 0.5f) * view_.height};
  }
  void line(const Eigen::Vector3d& from_C, const Eigen::Vector3d& to_C, float width_px) {
    const auto from = place(from_C), to = place(to_C);
    if (!from || !to || !inside(*from) || !inside(*to)) return;
    canvas_.stroke(
        {.from = *from, .to = *to, .width_px = width_px, .dash_px = outline_.predicted ? 6.0f : 0.0f},
        outline_.predicted ? kPredicted : kMeasured);
  }
  /// A line that may leave the view: as much of it as is inside, in short pieces.
  void long_line(const Eigen::Vector3d& from_C, const Eigen::Vector3d& to_C, float width_px) {
    constexpr int kPieces = 12;
    for (int i = 0; i < kPieces; ++i) {
      line(from_C + (to_C - from_C) * (double(i) / kPieces),
           from_C + (to_C - from_C) * (double(i + 1) / kPieces), width_px);
    }
  }

 private:
  bool inside(const HudPoint& p) const {
    return p.x >= view_.x && p.y >= view_.y && p.x <= view_.x + view_.width && p.y <= view_.y + view_.height;
  }
  HudCanvas& canvas_;
  HudBox view_;
  const ScopeOutline& outline_;
  EyeMatrices matrices_;
};

void draw_shaft(Outliner& outliner, const Eigen::Vector3d& tip, const Eigen::Vector3d& along) {
  const Eigen::Vector3d across =
      std::abs(along.y()) < 0.8 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d beside = kRadiusMm * along.cross(across).normalized();
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d edge = tip + side * beside;
    outliner.long_line(edge, edge - kShaftMm * along, 2);
  }
}

}  // namespace

void draw_scope(HudCanvas& canvas, const HudBox& view, const Eye& eye, const ScopeOutline& outline) noexcept {
  Outliner outliner(canvas, view, eye, outline);
  const Eigen::Vector3d tip = outline.X_CE.translation_mm;
  const double reach = std::tan(std::min(outline.cone_half_angle_rad, 1.3)) * kConeMm;
  for (int i = 0; i < kSegments; ++i) {
    const double a = 2 * std::numbers::pi * i / kSegments, b = 2 * std::numbers::pi * (i + 1) / kSegments;
    const Eigen::Vector3d from(reach * std::cos(a), reach * std::sin(a), kConeMm),
        to(reach * std::cos(b), reach * std::sin(b), kConeMm);
    outliner.line(from, to, 1.5f);
    if (i % 6 == 0) outliner.line(tip, from, 1.2f);
  }
  if (outline.shaft) draw_shaft(outliner, tip, *outline.shaft);
  outliner.line(tip - Eigen::Vector3d(kRadiusMm, 0, 0), tip + Eigen::Vector3d(kRadiusMm, 0, 0), 2);
  outliner.line(tip - Eigen::Vector3d(0, kRadiusMm, 0), tip + Eigen::Vector3d(0, kRadiusMm, 0), 2);
}

}  // namespace orcart
