// Three framebuffers of the same two textures: what copies or reads back wants one alone.
#include "render/atlas/atlas_textures.hpp"

#include <algorithm>
#include <array>

namespace orcart {
namespace {

/// From premultiplied by alpha.
void make_straight(std::vector<std::uint8_t>& rgba) {
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    const unsigned alpha = rgba[i + 3];
    if (alpha == 0 || alpha == 255) continue;
    for (std::size_t c = i; c < i + 3; ++c)
      rgba[c] = static_cast<std::uint8_t>(std::min(255u, (rgba[c] * 255u + alpha / 2) / alpha));
  }
}

}  // namespace

Result<AtlasTextures> AtlasTextures::create(int size_texels) {
  AtlasTextures self;
  self.size_texels_ = size_texels;
  self.colours_ = gles::make_texture({GL_RGBA8, size_texels, size_texels, GL_LINEAR});
  self.records_ = gles::make_texture({GL_RGBA16UI, size_texels, size_texels});
  auto of_colours = gles::make_framebuffer(self.colours_.id());
  if (!of_colours) return tl::unexpected(of_colours.error());
  self.of_colours_ = std::move(*of_colours);
  auto of_records = gles::make_framebuffer(self.records_.id());
  if (!of_records) return tl::unexpected(of_records.error());
  self.of_records_ = std::move(*of_records);
  auto both = gles::make_framebuffer(self.colours_.id());
  if (!both) return tl::unexpected(both.error());
  self.both_ = std::move(*both);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, self.records_.id(), 0);
  constexpr std::array<GLenum, 2> kTargets{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(kTargets.size(), kTargets.data());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    return fail("the driver cannot draw colours and records side by side");
  self.wipe();
  return self;
}

KeptAtlas AtlasTextures::kept() const noexcept {
  return {.colour = {colours_.id(), of_colours_.id()},
          .record = {records_.id(), of_records_.id()},
          .size_texels = size_texels_};
}

void AtlasTextures::wipe() noexcept {
  constexpr std::array<GLfloat, 4> kBare{};
  constexpr std::array<GLuint, 4> kNothing{};
  glBindFramebuffer(GL_FRAMEBUFFER, both_.id());
  glClearBufferfv(GL_COLOR, 0, kBare.data());
  glClearBufferuiv(GL_COLOR, 1, kNothing.data());
}

AtlasPicture AtlasTextures::read_colours() const {
  AtlasPicture picture{.width_texels = size_texels_, .height_texels = size_texels_, .rgba = {}};
  picture.rgba.resize(4 * static_cast<std::size_t>(size_texels_) * static_cast<std::size_t>(size_texels_));
  glBindFramebuffer(GL_FRAMEBUFFER, of_colours_.id());
  glReadPixels(0, 0, size_texels_, size_texels_, GL_RGBA, GL_UNSIGNED_BYTE, picture.rgba.data());
  make_straight(picture.rgba);
  return picture;
}

AtlasRecords AtlasTextures::read_records() const {
  AtlasRecords records{.width_texels = size_texels_, .height_texels = size_texels_, .texels = {}};
  records.texels.resize(static_cast<std::size_t>(size_texels_) * static_cast<std::size_t>(size_texels_));
  glBindFramebuffer(GL_FRAMEBUFFER, of_records_.id());
  glReadPixels(0, 0, size_texels_, size_texels_, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, records.texels.data());
  return records;
}

}  // namespace orcart
