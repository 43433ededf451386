// The whole panel picture: painted surface, scope outline, live inset, status, SIMULATED mark.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "realtime/base/image.hpp"
#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "realtime/optics/scope_model.hpp"
#include "render/atlas/atlas_layout.hpp"
#include "render/atlas/colouring.hpp"
#include "render/atlas/painter.hpp"
#include "render/hud/status.hpp"
#include "render/views/eye.hpp"

namespace orcart {

struct ScreenSettings {
  int width_px = 1280, height_px = 800;
  SeenFrom seen_from =
      SeenFrom::outside;  ///< inside: the wall nearest to the eye is a glass shell, so that one looks in
  ColourBy colour_by = ColourBy::picture;
  std::size_t most_triangles = 50'000;  ///< see SurfaceViewSettings
  PaintBy draw_by = PaintBy::gpu;       ///< surface and inset; processor: only with a painter that paints so
};

/// What changes from picture to picture.
struct ScreenState {
  Eye eye;
  std::optional<Pose<M, C>> X_MC;  ///< the scope, where it is known now; its outline is drawn only then
  bool scope_predicted = false;
  double turn_rad = 0;    ///< of the light post since the passport's turn
  bool show_live = true;  ///< false: the inset is blank and says NO LIVE VIDEO
  std::uint64_t paint_version =
      0;  ///< changes when the atlas changes: the surface is redrawn only then or for a new eye
  Status status;
};

/// All calls from the thread whose GL context is current. After create() our own code allocates nothing.
class Screen {
 public:
  static Result<Screen> create(const Surface& surface, const AtlasLayout& layout, const ScopeModel& scope,
                               const ScreenSettings& settings);
  Screen(Screen&&) noexcept;
  Screen& operator=(Screen&&) noexcept;
  ~Screen();

  /// Draws into `target`, of the settings' size: CPU memory, xrgb8888 or rgba8888, by reading back; or an
  /// xrgb8888 dma-buf that EGL can import, without a copy and waited for. False where it is none of these, or
  /// where the processor should draw what it has not painted.
  bool draw(const ScreenState& state, const Painter& painter, const ImageDescriptor& target) noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
  explicit Screen(std::unique_ptr<State> state);
};

/// The painted surface alone, for figures: no inset, no text. Allocates.
Result<AtlasPicture> picture_of_surface(const Surface& surface, const AtlasLayout& layout,
                                        const Painter& painter, const Eye& eye,
                                        const ScreenSettings& settings);

}  // namespace orcart
