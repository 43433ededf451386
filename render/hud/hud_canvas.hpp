// Flat drawing on the panel: letters, boxes, discs, rings and strokes, gathered and drawn in one call.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "realtime/base/result.hpp"
#include "render/gles/objects.hpp"
#include "render/hud/font.hpp"

namespace orcart {

/// Straight sRGB with coverage, 0..255.
struct Colour {
  std::uint8_t r = 255, g = 255, b = 255, a = 255;
};

/// Panel pixels, origin at the top-left corner of the panel, y down.
struct HudPoint {
  float x = 0, y = 0;
};
struct HudBox {
  float x = 0, y = 0, width = 0, height = 0;
};

struct HudCanvasSettings {
  int width_px = 1280, height_px = 800;
};

/// All calls from the thread whose GL context is current. Nothing is allocated after create(); what does not
/// fit any more is left out.
class HudCanvas {
 public:
  static Result<HudCanvas> create(const HudCanvasSettings& settings);

  /// Writes a line whose base line starts at `at`; returns where the pen stands afterwards.
  float text(HudPoint at, TextStyle style, Colour colour, std::string_view utf8) noexcept;
  /// The same, ending at `at`.
  void text_ending(HudPoint at, TextStyle style, Colour colour, std::string_view utf8) noexcept;
  /// The same, its middle at `at`.
  void text_centred(HudPoint at, TextStyle style, Colour colour, std::string_view utf8) noexcept;
  /// A plain ground, whole pixels, at once: under everything that is gathered.
  void ground(const HudBox& box, Colour colour) noexcept;
  void box(const HudBox& box, float radius_px, Colour colour) noexcept;
  void outline(const HudBox& box, float radius_px, float width_px, Colour colour) noexcept;
  void disc(HudPoint centre, float radius_px, Colour colour) noexcept;
  void ring(HudPoint centre, float radius_px, float width_px, Colour colour) noexcept;
  struct Stroke {
    HudPoint from, to;
    float width_px = 2;
    float dash_px = 0;  ///< 0: unbroken
  };
  void stroke(const Stroke& stroke, Colour colour) noexcept;

  /// Around what has been gathered; of no size where that is nothing.
  HudBox bounds() const noexcept;
  /// Draws what was gathered into the bound framebuffer, in order, and forgets it. Changes viewport,
  /// blending, program and vertex array; leaves blending and depth test off.
  void flush() noexcept;

  const Font& font() const noexcept { return font_; }
  float scale() const noexcept { return scale_; }  ///< 1 on a panel 800 px high
  int width_px() const noexcept { return settings_.width_px; }
  int height_px() const noexcept { return settings_.height_px; }

 private:
  struct Quad {
    HudBox rect;
    float detail[4];
    Colour colour;
    float shape[4];
  };
  static constexpr std::size_t kCapacity = 2048;
  HudCanvas(Font font, const HudCanvasSettings& settings);
  Result<void> prepare();
  void add(const Quad& quad) noexcept;

  Font font_;
  HudCanvasSettings settings_;
  float scale_;
  std::vector<Quad> quads_;
  gles::Program program_;
  gles::Texture letters_;
  gles::Buffer buffer_;
  gles::VertexArray vertices_;
};

}  // namespace orcart
