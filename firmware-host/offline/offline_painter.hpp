// The cart's mapper and painter driven from files: pictures with known poses onto a surface. Not real-time.
#pragma once

#include <memory>
#include <string>

#include "realtime/mapper/mapper.hpp"
#include "render/atlas/painter.hpp"
#include "render/egl/context.hpp"

namespace orcart {

struct OfflinePaintOptions {
  SeenFrom seen_from = SeenFrom::outside;
  TextureMode mode = TextureMode::perspective;
  double texel_mm = 0.2;
  PaintPolicy policy = PaintPolicy::newest;
  Highlights highlights = Highlights::keep;
  LightModel light = LightModel::as_seen;
};

/// What one view gave.
struct ViewPainted {
  std::uint32_t triangles = 0;  ///< that may be painted
  std::uint32_t texels = 0;     ///< that were gone through
};

/// Owns a GL context, which stays current on the creating thread; all calls from that thread.
class OfflinePainter {
 public:
  static Result<OfflinePainter> create(const Surface& surface, const ScopeModel& scope,
                                       const OfflinePaintOptions& options);

  /// Paints one picture of the scope's size, by the options' policy. A view in paper mode whose centre ray
  /// misses is refused. `turn_rad`: of the light post since the scope's passport, as in X_MC.
  Result<ViewPainted> paint(const ImageDescriptor& image, const Pose<M, C>& X_MC, double turn_rad = 0);

  const AtlasLayout& layout() const { return *layout_; }
  Painter& painter() { return *painter_; }
  const GlContext& context() const { return *context_; }

 private:
  OfflinePainter() = default;
  ScopeModel scope_;
  OfflinePaintOptions options_;
  std::unique_ptr<GlContext> context_;
  std::unique_ptr<AtlasLayout> layout_;
  std::unique_ptr<Mapper> mapper_;
  std::unique_ptr<Painter> painter_;
  CutoutPatch patch_;
  std::uint32_t next_unit_ = 1;
};

}  // namespace orcart
