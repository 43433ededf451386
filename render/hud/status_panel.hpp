// What the panel says: state words with colour and word, numbers, the one notice, and the mark that nothing
// here is real.
#pragma once

#include "render/hud/hud_canvas.hpp"
#include "render/hud/status.hpp"

namespace orcart {

/// Where things stand on the panel, for any size from 640x400 up. Pixels, y down.
struct PanelLayout {
  HudBox view;            ///< the surface
  HudBox column;          ///< at the right: live picture, states, numbers
  HudPoint inset_centre;  ///< of the round live picture
  float inset_radius_px = 0;
  HudBox bar;  ///< at the bottom: marks
};
PanelLayout panel_layout(int width_px, int height_px) noexcept;

/// What fills the round inset.
enum class InsetContent : std::uint8_t { picture, blank };

/// Column and bar, whole, at once; the live picture goes over them. A blank inset says NO LIVE VIDEO.
void draw_column_and_bar(HudCanvas& canvas, const PanelLayout& layout, const Status& status,
                         InsetContent inset) noexcept;
/// What is said over the view.
void draw_banners(HudCanvas& canvas, const PanelLayout& layout, const Status& status) noexcept;

}  // namespace orcart
