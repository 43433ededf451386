// Choices that hold for a whole procedure are compiled in; the rest are uniforms.
#include "render/atlas/paint_program.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "render/atlas/texel_record.hpp"
#include "render/shaders/shaders.hpp"

namespace orcart {
namespace {

constexpr std::array<const char*, 7> kTextures{"u_points",   "u_depth", "u_owner", "u_triangles",
                                               "u_vertices", "u_mask",  "u_before"};

int number_of(LensModel model) {
  switch (model) {
    case LensModel::brown:
      return 0;
    case LensModel::poly4:
      return 1;
    case LensModel::fisheye:
      break;
  }
  return 2;
}

std::string choice(const char* name, bool chosen) {
  return std::string("#define ") + name + (chosen ? " 1\n" : " 0\n");
}

std::string fragment_source(const ScopeModel& scope, const PainterSettings& settings, TextureMode mode) {
  std::string source = "#define LENS_MODEL " + std::to_string(number_of(scope.lens.model)) + "\n";
  source += choice("BEST", settings.policy == PaintPolicy::best);
  source += choice("YIELD", settings.highlights == Highlights::yield);
  source += choice("LIGHT", settings.light != LightModel::as_seen);
  source += shaders::lens_glsl;
  source += shaders::picture_glsl;
  source += shaders::mask_glsl;
  source += shaders::record_glsl;
  source += shaders::light_glsl;
  source += mode == TextureMode::paper ? shaders::paint_paper_frag : shaders::paint_frag;
  return source;
}

}  // namespace

Result<PaintProgram> PaintProgram::create(const ScopeModel& scope, const PainterSettings& settings,
                                          const PaintConstants& constants) {
  PaintProgram self;
  const char* name = constants.mode == TextureMode::paper ? "paint_paper" : "paint";
  auto made = gles::make_program(name, shaders::paint_vert, fragment_source(scope, settings, constants.mode));
  if (!made) return tl::unexpected(made.error());
  self.program_ = std::move(*made);
  glUseProgram(self.program_.id());
  self.set_constants(scope, settings, constants);
  const auto at = [&](const char* uniform) { return gles::uniform(self.program_, uniform); };
  for (GLint i = 0; i < static_cast<GLint>(kTextures.size()); ++i)
    glUniform1i(at(kTextures[static_cast<std::size_t>(i)]), i);
  self.rotation_ = at("u_rotation_CM");
  self.translation_ = at("u_translation_CM");
  self.tip_ = at("u_tip");
  self.view_ = at("u_view");
  self.up_ = at("u_up");
  self.side_ = at("u_side");
  self.paper_size_ = at("u_paper_size");
  self.half_width_slope_ = at("u_half_width_slope");
  self.capture_ = at("u_capture");
  self.view_error_ = at("u_view_error");
  self.light_ = at("u_light");
  self.intrinsics_ = at("u_intrinsics");
  self.coefficients_ = at("u_coefficients");
  self.distortion_centre_ = at("u_distortion_centre");
  self.circle_ = at("u_circle");
  self.notch_ = at("u_notch");
  self.picture_ = gles::PictureTexture::uniforms_of(self.program_);
  return self;
}

void PaintProgram::set_constants(const ScopeModel& scope, const PainterSettings& settings,
                                 const PaintConstants& constants) {
  const auto set = [&](const char* name, auto... values) {
    const GLint at = gles::uniform(program_, name);
    if constexpr (sizeof...(values) == 1) glUniform1f(at, static_cast<float>(values)...);
    if constexpr (sizeof...(values) == 2) glUniform2f(at, static_cast<float>(values)...);
    if constexpr (sizeof...(values) == 4) glUniform4f(at, static_cast<float>(values)...);
  };
  const Lens& lens = scope.lens;
  set("u_aspect", lens.fx_px / lens.fy_px);
  set("u_pixel_rad", 1.0 / lens.fx_px);
  set("u_atlas_size", constants.atlas_size_texels);
  set("u_texel_mm", constants.texel_mm);
  set("u_facing", settings.seen_from == SeenFrom::outside ? 1 : -1);
  set("u_cos_cone", std::cos(std::min(scope.cone_half_angle_rad, lens.max_angle_rad)));
  set("u_far_mm", scope.far_mm);
  set("u_cos_obliquity", std::cos(settings.max_obliquity_rad));
  set("u_depth_tangent", constants.pinhole.tangent);
  set("u_depth_near", constants.pinhole.near_mm);
  set("u_depth_far", constants.pinhole.far_mm);
  fall_off_ = {static_cast<float>(scope.fall_off.reference_mm),
               static_cast<float>(scope.fall_off.vignetting_cos_power)};
}

void PaintProgram::set_optics(const TurnedOptics& optics) const noexcept {
  const auto narrow = [](double value) { return static_cast<float>(value); };
  const Lens& lens = optics.lens;
  glUniform4f(intrinsics_, narrow(lens.fx_px), narrow(lens.fy_px), narrow(lens.cx_px), narrow(lens.cy_px));
  std::array<float, 5> coefficients{};
  std::transform(lens.coefficients.begin(), lens.coefficients.end(), coefficients.begin(), narrow);
  glUniform1fv(coefficients_, 5, coefficients.data());
  glUniform2f(distortion_centre_, narrow(lens.distortion_centre_px.x()),
              narrow(lens.distortion_centre_px.y()));
  const CircularMask& mask = optics.mask;
  glUniform4f(circle_, narrow(mask.cx_px), narrow(mask.cy_px), narrow(mask.radius_px),
              narrow(std::max(mask.soft_edge_px, 1e-3)));
  const bool notched = optics.notch_rad.has_value();
  glUniform2f(notch_, notched ? narrow(std::cos(*optics.notch_rad)) : 0,
              notched ? narrow(std::sin(*optics.notch_rad)) : 0);
}

void PaintProgram::use(const PaintView& view, const SurfaceTextures& surface,
                       const gles::PictureTexture& picture) const noexcept {
  glUseProgram(program_.id());
  set_optics(view.optics);
  set_pose_uniforms(rotation_, translation_, view.X_CM);
  glUniform3fv(tip_, 1, view.paper.tip_mm.data());
  glUniform3fv(view_, 1, view.paper.view.data());
  glUniform3fv(up_, 1, view.paper.up.data());
  glUniform3fv(side_, 1, view.paper.side.data());
  glUniform2f(paper_size_, view.paper.s_size_mm, view.paper.t_size_mm);
  glUniform1f(half_width_slope_, view.paper.half_width_slope);
  glUniform1ui(capture_, capture_number(view.unit));
  glUniform3f(view_error_, view.error.position_mm, view.error.angle_rad, view.error.pixels);
  glUniform3f(light_, fall_off_.x(), fall_off_.y(), view.mean_light);
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
