// One instanced rectangle per letter or shape; the fragment shader works out how much of each pixel it
// covers.
#include "render/hud/hud_canvas.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "render/shaders/shaders.hpp"

namespace orcart {
namespace {

enum Kind { kLetter, kBox, kOutline, kStroke };

}  // namespace

HudCanvas::HudCanvas(Font font, const HudCanvasSettings& settings)
    : font_(std::move(font)), settings_(settings), scale_(static_cast<float>(settings.height_px) / 800.0F) {}

Result<HudCanvas> HudCanvas::create(const HudCanvasSettings& settings) {
  auto font = Font::create(settings.height_px / 800.0);
  if (!font) return tl::unexpected(font.error());
  HudCanvas canvas(std::move(*font), settings);
  if (auto prepared = canvas.prepare(); !prepared) return tl::unexpected(prepared.error());
  return canvas;
}

Result<void> HudCanvas::prepare() {
  auto program = gles::make_program("hud", shaders::hud_vert, shaders::hud_frag);
  if (!program) return tl::unexpected(program.error());
  program_ = std::move(*program);
  quads_.reserve(kCapacity);
  letters_ = gles::make_texture({GL_R8, font_.atlas_width_px(), font_.atlas_height_px(), GL_NEAREST});
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, font_.atlas_width_px(), font_.atlas_height_px(), GL_RED,
                  GL_UNSIGNED_BYTE, font_.coverage().data());
  vertices_ = gles::make_vertex_array();
  glBindVertexArray(vertices_.id());
  buffer_ = gles::make_buffer(GL_ARRAY_BUFFER, kCapacity * sizeof(Quad), nullptr, GL_STREAM_DRAW);
  glBindVertexBuffer(0, buffer_.id(), 0, sizeof(Quad));
  glVertexBindingDivisor(0, 1);
  const auto attribute = [](GLuint index, GLenum type, GLboolean normalised, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribFormat(index, 4, type, normalised, static_cast<GLuint>(offset));
    glVertexAttribBinding(index, 0);
  };
  attribute(0, GL_FLOAT, GL_FALSE, offsetof(Quad, rect));
  attribute(1, GL_FLOAT, GL_FALSE, offsetof(Quad, detail));
  attribute(2, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(Quad, colour));
  attribute(3, GL_FLOAT, GL_FALSE, offsetof(Quad, shape));
  glBindVertexArray(0);
  return {};
}

void HudCanvas::add(const Quad& quad) noexcept {
  if (quads_.size() < kCapacity) quads_.push_back(quad);
}

float HudCanvas::text(HudPoint at, TextStyle style, Colour colour, std::string_view utf8) noexcept {
  char32_t before = 0;
  while (!utf8.empty()) {
    const char32_t c = take_code_point(utf8);
    const Glyph& glyph = font_.glyph(style, c);
    at.x += font_.kerning_px(style, before, c);
    const HudBox rect{std::round(at.x) + glyph.left, std::round(at.y) - glyph.above,
                      static_cast<float>(glyph.width), static_cast<float>(glyph.height)};
    if (glyph.width > 0) {
      add({rect,
           {static_cast<float>(glyph.x), static_cast<float>(glyph.y), 0, 0},
           colour,
           {kLetter, 0, 0, 0}});
    }
    at.x += glyph.advance_px;
    before = c;
  }
  return at.x;
}

void HudCanvas::text_ending(HudPoint at, TextStyle style, Colour colour, std::string_view utf8) noexcept {
  text({at.x - font_.width_px(style, utf8), at.y}, style, colour, utf8);
}

void HudCanvas::text_centred(HudPoint at, TextStyle style, Colour colour, std::string_view utf8) noexcept {
  text({at.x - 0.5F * font_.width_px(style, utf8), at.y}, style, colour, utf8);
}

// Clearing costs a software driver a tenth of drawing.
void HudCanvas::ground(const HudBox& box, Colour colour) noexcept {
  glEnable(GL_SCISSOR_TEST);
  glScissor(static_cast<GLint>(box.x), static_cast<GLint>(box.y), static_cast<GLsizei>(std::ceil(box.width)),
            static_cast<GLsizei>(std::ceil(box.height)));
  glClearColor(static_cast<float>(colour.r) / 255, static_cast<float>(colour.g) / 255,
               static_cast<float>(colour.b) / 255, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
}

// The rectangle drawn is one pixel larger all round than the shape, for its soft edge.
void HudCanvas::box(const HudBox& box, float radius_px, Colour colour) noexcept {
  add({{box.x - 1, box.y - 1, box.width + 2, box.height + 2}, {}, colour, {kBox, radius_px, 0, 0}});
}

void HudCanvas::outline(const HudBox& box, float radius_px, float width_px, Colour colour) noexcept {
  add({{box.x - 1, box.y - 1, box.width + 2, box.height + 2},
       {},
       colour,
       {kOutline, radius_px, width_px, 0}});
}

void HudCanvas::disc(HudPoint centre, float radius_px, Colour colour) noexcept {
  box({centre.x - radius_px, centre.y - radius_px, 2 * radius_px, 2 * radius_px}, radius_px, colour);
}

void HudCanvas::ring(HudPoint centre, float radius_px, float width_px, Colour colour) noexcept {
  outline({centre.x - radius_px, centre.y - radius_px, 2 * radius_px, 2 * radius_px}, radius_px, width_px,
          colour);
}

void HudCanvas::stroke(const Stroke& s, Colour colour) noexcept {
  add({{}, {s.from.x, s.from.y, s.to.x, s.to.y}, colour, {kStroke, 0.5F * s.width_px, s.dash_px, 0}});
}

HudBox HudCanvas::bounds() const noexcept {
  if (quads_.empty()) return {};
  float left = 1e9F, top = 1e9F, right = -1e9F, bottom = -1e9F;
  const auto extend = [&](float x, float y, float around) {
    left = std::min(left, x - around);
    top = std::min(top, y - around);
    right = std::max(right, x + around);
    bottom = std::max(bottom, y + around);
  };
  for (const Quad& quad : quads_) {
    if (quad.shape[0] == static_cast<float>(kStroke)) {
      const float reach = quad.shape[1] + 1;  // as hud.vert draws it, at its corners
      extend(quad.detail[0], quad.detail[1], 1.5F * reach);
      extend(quad.detail[2], quad.detail[3], 1.5F * reach);
    } else {
      extend(quad.rect.x, quad.rect.y, 0);
      extend(quad.rect.x + quad.rect.width, quad.rect.y + quad.rect.height, 0);
    }
  }
  return {left, top, right - left, bottom - top};
}

void HudCanvas::flush() noexcept {
  if (quads_.empty()) return;
  glViewport(0, 0, settings_.width_px, settings_.height_px);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glUseProgram(program_.id());
  glUniform2f(gles::uniform(program_, "u_panel_size"), static_cast<float>(settings_.width_px),
              static_cast<float>(settings_.height_px));
  glUniform1i(gles::uniform(program_, "u_letters"), 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, letters_.id());
  glBindVertexArray(vertices_.id());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
  glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(quads_.size() * sizeof(Quad)), quads_.data());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(quads_.size()));
  glBindVertexArray(0);
  glDisable(GL_BLEND);
  quads_.clear();
}

}  // namespace orcart
