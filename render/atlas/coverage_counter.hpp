// How much of the surface carries paint, counted on the GPU tile by tile and only where something changed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/atlas/undo_store.hpp"

namespace orcart {

class CoverageCounter {
 public:
  /// `owner`: the atlas's owner texture; `texels`: how many lie in a triangle.
  static Result<CoverageCounter> create(const KeptAtlas& atlas, GLuint owner, std::uint64_t texels);

  /// These tiles changed.
  void touch(std::span<const std::uint32_t> tiles) noexcept;
  void touch_all() noexcept;
  /// Counts at most kTilesPerCall changed tiles and gives the share covered as far as it is counted, 0..1.
  double update() noexcept;

 private:
  static constexpr std::size_t kTilesPerCall = 512;
  static constexpr int kPartsPerSide = kTileTexels / 8;  ///< of a tile, each counted by one fragment
  CoverageCounter() = default;
  std::uint16_t counted(std::uint32_t tile) const noexcept;
  void count(std::span<const std::uint32_t> tiles) noexcept;

  KeptAtlas atlas_;
  GLuint owner_ = 0;
  int grid_ = 0;  ///< tiles per row
  std::uint64_t texels_ = 1, painted_ = 0;
  gles::Program program_;
  gles::VertexArray vertex_array_;
  gles::Buffer instances_;
  gles::Texture counts_;
  gles::Framebuffer framebuffer_;
  GLint owner_unit_ = -1, atlas_unit_ = -1;
  std::vector<std::uint32_t> changed_;
  std::vector<std::uint8_t> is_changed_;
  std::vector<std::uint16_t> of_tile_;  ///< painted texels of each tile
  std::vector<std::uint8_t> read_;
};

}  // namespace orcart
