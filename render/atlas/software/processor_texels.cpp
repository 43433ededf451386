// Memory in, memory out; GL is given tiles that changed.
#include "render/atlas/software/processor_texels.hpp"

#include <algorithm>

namespace orcart {

ProcessorTexels::ProcessorTexels(const TriangleMesh& mesh, const KeptAtlas& atlas,
                                 const DepthPinhole& pinhole, const PaintChoices& choices,
                                 std::span<const float> points)
    : atlas_(atlas), depth_(mesh, pinhole) {
  const std::size_t texels = points.size() / 4;
  for (auto* numbers : {&x_mm_, &y_mm_, &z_mm_, &normal_}) numbers->resize(texels);
  for (std::size_t i = 0; i < texels; ++i) {
    x_mm_[i] = points[4 * i];
    y_mm_[i] = points[4 * i + 1];
    z_mm_[i] = points[4 * i + 2];
    normal_[i] = points[4 * i + 3];
  }
  colours_.assign(texels, 0);
  records_.assign(texels, {});
  newer_.assign(texels / (kTileTexels * kTileTexels), Newer::neither);
  unsent_.reserve(newer_.size());
  job_.choices = choices;
  job_.depths = depth_.seen();
  job_.atlas = {.width_texels = atlas.size_texels,
                .x_mm = x_mm_.data(),
                .y_mm = y_mm_.data(),
                .z_mm = z_mm_.data(),
                .normal = normal_.data(),
                .colours = colours_.data(),
                .records = records_.data()};
}

void ProcessorTexels::paint(std::span<const std::uint32_t> cells, std::span<const std::uint32_t> tiles,
                            const PaintUniforms& uniforms, const gles::PicturePlanes& picture) noexcept {
  for (const std::uint32_t tile : tiles) {
    if (newer_[tile] == Newer::in_driver) read_again(tile);
    if (newer_[tile] == Newer::neither) unsent_.push_back(tile);
    newer_[tile] = Newer::in_memory;
  }
  job_.uniforms = uniforms;
  job_.picture = picture;
  paint_cells(job_, cells);
}

void ProcessorTexels::forget(std::span<const std::uint32_t> tiles) noexcept {
  for (const std::uint32_t tile : tiles) newer_[tile] = Newer::in_driver;
  some_forgotten_ = some_forgotten_ || !tiles.empty();
}

const TexelMemory& ProcessorTexels::up_to_date() noexcept {
  for (std::uint32_t tile = 0; some_forgotten_ && tile < newer_.size(); ++tile)
    if (newer_[tile] == Newer::in_driver) read_again(tile);
  some_forgotten_ = false;
  return job_.atlas;
}

void ProcessorTexels::clear() noexcept {
  std::fill(colours_.begin(), colours_.end(), 0u);
  std::fill(records_.begin(), records_.end(), TexelRecord{});
  std::fill(newer_.begin(), newer_.end(), Newer::neither);
  unsent_.clear();
}

std::size_t ProcessorTexels::corner_of(std::uint32_t tile) const noexcept {
  const auto width = static_cast<std::size_t>(atlas_.size_texels), tiles_per_row = width / kTileTexels;
  return tile / tiles_per_row * kTileTexels * width + tile % tiles_per_row * kTileTexels;
}

void ProcessorTexels::read_again(std::uint32_t tile) noexcept {
  const int tiles_per_row = atlas_.size_texels / kTileTexels;
  const int x = static_cast<int>(tile) % tiles_per_row * kTileTexels,
            y = static_cast<int>(tile) / tiles_per_row * kTileTexels;
  const std::size_t corner = corner_of(tile);
  glPixelStorei(GL_PACK_ROW_LENGTH, atlas_.size_texels);
  glBindFramebuffer(GL_FRAMEBUFFER, atlas_.colour.framebuffer);
  glReadPixels(x, y, kTileTexels, kTileTexels, GL_RGBA, GL_UNSIGNED_BYTE, &colours_[corner]);
  glBindFramebuffer(GL_FRAMEBUFFER, atlas_.record.framebuffer);
  glReadPixels(x, y, kTileTexels, kTileTexels, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, &records_[corner]);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  newer_[tile] = Newer::neither;
}

void ProcessorTexels::send() noexcept {
  if (unsent_.empty()) return;
  const int tiles_per_row = atlas_.size_texels / kTileTexels;
  glPixelStorei(GL_UNPACK_ROW_LENGTH, atlas_.size_texels);
  for (const bool records : {false, true}) {
    glBindTexture(GL_TEXTURE_2D, records ? atlas_.record.texture : atlas_.colour.texture);
    for (const std::uint32_t tile : unsent_) {
      const int x = static_cast<int>(tile) % tiles_per_row * kTileTexels,
                y = static_cast<int>(tile) / tiles_per_row * kTileTexels;
      const std::size_t corner = corner_of(tile);
      if (records) {
        glTexSubImage2D(GL_TEXTURE_2D, 0, x, y, kTileTexels, kTileTexels, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT,
                        &records_[corner]);
      } else {
        glTexSubImage2D(GL_TEXTURE_2D, 0, x, y, kTileTexels, kTileTexels, GL_RGBA, GL_UNSIGNED_BYTE,
                        &colours_[corner]);
      }
    }
  }
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  for (const std::uint32_t tile : unsent_) newer_[tile] = Newer::neither;
  unsent_.clear();
}

}  // namespace orcart
