// Which squares of the atlas a view touches, in the order in which they are painted.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/atlas/atlas_layout.hpp"
#include "render/atlas/software/texel_job.hpp"
#include "render/atlas/tile_copier.hpp"

namespace orcart {

static_assert(kTileTexels % kCellTexels == 0);

/// Cells of kCellTexels and tiles of kTileTexels squared, by row-major numbers. Allocates nothing once made.
class TouchedCells {
 public:
  /// The layout must outlive it.
  explicit TouchedCells(const AtlasLayout& layout);

  /// Of a new view.
  void begin() noexcept;
  /// The cells that hold a triangle's own texels and its gutter.
  void add(std::uint32_t triangle) noexcept;
  /// The next cells with at most that many texels; empty when all were given out.
  std::span<const std::uint32_t> next(std::uint32_t most_texels) noexcept;
  bool more() const noexcept { return given_ < cells_.size(); }
  /// The tiles of the newest next().
  std::span<const std::uint32_t> tiles() const noexcept { return tiles_; }

  std::uint32_t cells_per_row() const noexcept { return cells_per_row_; }
  std::size_t most_cells() const noexcept { return seen_cell_.size(); }

 private:
  void add_tile(std::uint32_t cell) noexcept;

  const AtlasLayout* layout_;
  std::uint32_t cells_per_row_;
  std::vector<std::uint32_t> seen_cell_,
      seen_tile_;  ///< the number of the view, or step, that touched it last
  std::uint32_t number_ = 0;
  std::vector<std::uint32_t> cells_, tiles_;
  std::size_t given_ = 0;
};

}  // namespace orcart
