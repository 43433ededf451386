// Choices that hold for a whole procedure are compiled in; the rest are uniforms.
#include "render/atlas/paint_program.hpp"

#include <array>
#include <cstddef>
#include <string>

#include "render/shaders/shaders.hpp"

namespace orcart {
namespace {

constexpr std::array<const char*, 7> kTextures{"u_points",   "u_depth", "u_owner", "u_triangles",
                                               "u_vertices", "u_mask",  "u_before"};

/// One of PaintUniforms.
struct Number {
  const char* name;
  std::size_t offset_bytes;
  std::size_t bytes;
};
#define ORCART_NUMBER(name)                                           \
  Number {                                                            \
#name, offsetof(PaintUniforms, name), sizeof(PaintUniforms::name) \
  }
constexpr std::array kNumbers{
    ORCART_NUMBER(u_intrinsics),    ORCART_NUMBER(u_coefficients),   ORCART_NUMBER(u_distortion_centre),
    ORCART_NUMBER(u_circle),        ORCART_NUMBER(u_aspect),         ORCART_NUMBER(u_notch),
    ORCART_NUMBER(u_rotation_CM),   ORCART_NUMBER(u_translation_CM), ORCART_NUMBER(u_facing),
    ORCART_NUMBER(u_cos_cone),      ORCART_NUMBER(u_far_mm),         ORCART_NUMBER(u_cos_obliquity),
    ORCART_NUMBER(u_depth_tangent), ORCART_NUMBER(u_depth_near),     ORCART_NUMBER(u_depth_far),
    ORCART_NUMBER(u_depth_size),    ORCART_NUMBER(u_texel_mm),       ORCART_NUMBER(u_light),
    ORCART_NUMBER(u_capture),       ORCART_NUMBER(u_view_error),     ORCART_NUMBER(u_pixel_rad),
    ORCART_NUMBER(u_picture_size)};
#undef ORCART_NUMBER
constexpr std::size_t bytes_of_all() {
  std::size_t sum = 0;
  for (const Number& number : kNumbers) sum += number.bytes;
  return sum;
}
static_assert(bytes_of_all() == sizeof(PaintUniforms), "a number is missing in the list");

std::string choice(const char* name, bool chosen) {
  return std::string("#define ") + name + (chosen ? " true\n" : " false\n");
}

std::string fragment_source(TextureMode mode, const PaintChoices& choices) {
  std::string source = "#define LENS_MODEL " + std::to_string(choices.lens_model) + "\n";
  source += choice("BEST", choices.best);
  source += choice("YIELD", choices.yield);
  source += choice("LIGHT", choices.light);
  for (const char* part :
       {shaders::dialect_glsl, shaders::paint_uniforms_glsl, shaders::picture_textures_glsl,
        shaders::paint_textures_glsl, shaders::lens_glsl, shaders::picture_glsl, shaders::mask_glsl,
        shaders::record_glsl, shaders::light_glsl}) {
    source += part;
  }
  if (mode == TextureMode::paper) return source + shaders::paint_paper_frag;
  return source + shaders::visible_glsl + shaders::paint_texel_glsl + shaders::paint_frag;
}

}  // namespace

Result<PaintProgram> PaintProgram::create(TextureMode mode, const PaintChoices& choices,
                                          int atlas_size_texels) {
  PaintProgram self;
  const char* name = mode == TextureMode::paper ? "paint_paper" : "paint";
  auto made = gles::make_program(name, shaders::paint_vert, fragment_source(mode, choices));
  if (!made) return tl::unexpected(made.error());
  self.program_ = std::move(*made);
  glUseProgram(self.program_.id());
  const auto at = [&](const char* uniform) { return gles::uniform(self.program_, uniform); };
  for (GLint i = 0; i < static_cast<GLint>(kTextures.size()); ++i)
    glUniform1i(at(kTextures[static_cast<std::size_t>(i)]), i);
  glUniform1f(at("u_atlas_size"), static_cast<float>(atlas_size_texels));
  for (const Number& number : kNumbers) self.numbers_.push_back(at(number.name));
  self.tip_ = at("u_tip");
  self.view_ = at("u_view");
  self.up_ = at("u_up");
  self.side_ = at("u_side");
  self.paper_size_ = at("u_paper_size");
  self.half_width_slope_ = at("u_half_width_slope");
  self.picture_ = gles::PictureTexture::uniforms_of(self.program_);
  return self;
}

void PaintProgram::set_numbers(const PaintUniforms& uniforms) const noexcept {
  for (std::size_t i = 0; i < kNumbers.size(); ++i) {
    const auto* from = reinterpret_cast<const float*>(reinterpret_cast<const std::byte*>(&uniforms) +
                                                      kNumbers[i].offset_bytes);
    const std::size_t floats = kNumbers[i].bytes / sizeof(float);
    switch (floats) {
      case 2:
        glUniform2fv(numbers_[i], 1, from);
        break;
      case 3:
        glUniform3fv(numbers_[i], 1, from);
        break;
      case 4:
        glUniform4fv(numbers_[i], 1, from);
        break;
      case 9:
        glUniformMatrix3fv(numbers_[i], 1, GL_FALSE, from);
        break;
      default:
        glUniform1fv(numbers_[i], static_cast<GLsizei>(floats), from);
    }
  }
}

void PaintProgram::use(const PaintView& view, const SurfaceTextures& surface,
                       const gles::PictureTexture& picture) const noexcept {
  glUseProgram(program_.id());
  set_numbers(view.uniforms);
  glUniform3fv(tip_, 1, view.paper.tip_mm.data());
  glUniform3fv(view_, 1, view.paper.view.data());
  glUniform3fv(up_, 1, view.paper.up.data());
  glUniform3fv(side_, 1, view.paper.side.data());
  glUniform2f(paper_size_, view.paper.s_size_mm, view.paper.t_size_mm);
  glUniform1f(half_width_slope_, view.paper.half_width_slope);
  const std::array<GLuint, kTextures.size()> textures{
      surface.points.id(),   view.depth_texture, surface.owner.id(), surface.triangles.id(),
      surface.vertices.id(), view.mask_texture,  view.before_texture};
  for (GLenum i = 0; i < textures.size(); ++i) {
    glActiveTexture(GL_TEXTURE0 + i);
    glBindTexture(GL_TEXTURE_2D, textures[i]);
  }
  picture.bind(picture_, static_cast<int>(textures.size()));
  glActiveTexture(GL_TEXTURE0);
}

}  // namespace orcart
