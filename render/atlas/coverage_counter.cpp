// Each changed tile is a few fragments of a small picture, which is read back.
#include "render/atlas/coverage_counter.hpp"

#include <algorithm>

#include "render/shaders/shaders.hpp"

namespace orcart {

Result<CoverageCounter> CoverageCounter::create(const KeptAtlas& atlas, GLuint owner, std::uint64_t texels) {
  CoverageCounter self;
  self.atlas_ = atlas;
  self.owner_ = owner;
  self.grid_ = atlas.size_texels / kTileTexels;
  self.texels_ = std::max<std::uint64_t>(texels, 1);
  auto program = gles::make_program("count_tiles", shaders::count_tiles_vert, shaders::count_tiles_frag);
  if (!program) return tl::unexpected(program.error());
  self.program_ = std::move(*program);
  glUseProgram(self.program_.id());
  glUniform1f(gles::uniform(self.program_, "u_grid_size"), static_cast<float>(self.grid_));
  self.owner_unit_ = gles::uniform(self.program_, "u_owner");
  self.atlas_unit_ = gles::uniform(self.program_, "u_atlas");
  self.counts_ = gles::make_texture({GL_RGBA8, self.grid_ * kPartsPerSide, self.grid_ * kPartsPerSide});
  auto framebuffer = gles::make_framebuffer(self.counts_.id());
  if (!framebuffer) return tl::unexpected(framebuffer.error());
  self.framebuffer_ = std::move(*framebuffer);
  self.vertex_array_ = gles::make_vertex_array();
  glBindVertexArray(self.vertex_array_.id());
  self.instances_ =
      gles::make_buffer(GL_ARRAY_BUFFER, kTilesPerCall * 4 * sizeof(std::uint16_t), nullptr, GL_STREAM_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_UNSIGNED_SHORT, GL_FALSE, 4 * sizeof(std::uint16_t), nullptr);
  glVertexAttribDivisor(0, 1);
  glBindVertexArray(0);
  const std::size_t tiles = static_cast<std::size_t>(self.grid_) * static_cast<std::size_t>(self.grid_);
  self.changed_.reserve(tiles);
  self.is_changed_.assign(tiles, 0);
  self.of_tile_.assign(tiles, 0);
  self.read_.resize(tiles * kPartsPerSide * kPartsPerSide * 4);
  return self;
}

void CoverageCounter::touch(std::span<const std::uint32_t> tiles) noexcept {
  for (const std::uint32_t tile : tiles) {
    if (is_changed_[tile] != 0) continue;
    is_changed_[tile] = 1;
    changed_.push_back(tile);
  }
}

void CoverageCounter::touch_all() noexcept {
  for (std::uint32_t tile = 0; tile < is_changed_.size(); ++tile) touch({&tile, 1});
}

double CoverageCounter::update() noexcept {
  if (!changed_.empty()) {
    const std::size_t some = std::min(changed_.size(), kTilesPerCall);
    const std::span<const std::uint32_t> tiles(changed_.data() + changed_.size() - some, some);
    count(tiles);
    for (const std::uint32_t tile : tiles) is_changed_[tile] = 0;
    changed_.resize(changed_.size() - some);
  }
  return static_cast<double>(painted_) / static_cast<double>(texels_);
}

/// The sum of a tile's parts in what was read.
std::uint16_t CoverageCounter::counted(std::uint32_t tile) const noexcept {
  const auto grid = static_cast<std::size_t>(grid_);
  unsigned sum = 0;
  for (std::size_t y = 0; y < kPartsPerSide; ++y) {
    const std::size_t row = tile / grid * kPartsPerSide + y, column = tile % grid * kPartsPerSide;
    for (std::size_t x = 0; x < kPartsPerSide; ++x)
      sum += read_[4 * (row * grid * kPartsPerSide + column + x)];
  }
  return static_cast<std::uint16_t>(sum);
}

void CoverageCounter::count(std::span<const std::uint32_t> tiles) noexcept {
  std::array<std::uint16_t, kTilesPerCall * 4> places{};
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    places[4 * i] = static_cast<std::uint16_t>(tiles[i] % static_cast<std::uint32_t>(grid_));
    places[4 * i + 1] = static_cast<std::uint16_t>(tiles[i] / static_cast<std::uint32_t>(grid_));
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  const int side = grid_ * kPartsPerSide;
  glViewport(0, 0, side, side);
  glDisable(GL_BLEND);
  glUseProgram(program_.id());
  glUniform1i(owner_unit_, 0);
  glUniform1i(atlas_unit_, 1);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, owner_);
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, atlas_.colour.texture);
  glBindVertexArray(vertex_array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, instances_.id());
  glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(tiles.size() * 4 * sizeof(std::uint16_t)),
                  places.data());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(tiles.size()));
  glBindVertexArray(0);
  glReadPixels(0, 0, side, side, GL_RGBA, GL_UNSIGNED_BYTE, read_.data());
  for (const std::uint32_t tile : tiles) {
    const std::uint16_t now = counted(tile);
    painted_ += now;
    painted_ -= of_tile_[tile];
    of_tile_[tile] = now;
  }
}

}  // namespace orcart
