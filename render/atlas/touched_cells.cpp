// A triangle's cells are those under the box about it, within its chart.
#include "render/atlas/touched_cells.hpp"

#include <algorithm>

namespace orcart {

TouchedCells::TouchedCells(const AtlasLayout& layout)
    : layout_(&layout), cells_per_row_(static_cast<std::uint32_t>(layout.width_texels / kCellTexels)) {
  const auto rows = static_cast<std::size_t>(layout.height_texels / kCellTexels);
  constexpr std::size_t kPerTile = kTileTexels / kCellTexels;
  seen_cell_.assign(cells_per_row_ * rows, 0);
  seen_tile_.assign(seen_cell_.size() / (kPerTile * kPerTile), 0);
  cells_.reserve(seen_cell_.size());
  tiles_.reserve(seen_tile_.size());
}

void TouchedCells::begin() noexcept {
  ++number_;
  cells_.clear();
  given_ = 0;
}

void TouchedCells::add(std::uint32_t triangle) noexcept {
  constexpr float kGutter = 3;
  const auto& corners = layout_->corners_texels[triangle];
  const ChartRect& rect = layout_->charts[layout_->chart_of_triangle[triangle]];
  const auto cell = [&](float texel, int first, int extent) {
    return static_cast<std::uint32_t>(std::clamp(static_cast<int>(texel), first, first + extent - 1)) /
           kCellTexels;
  };
  const Eigen::Vector2f low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]).array() - kGutter;
  const Eigen::Vector2f high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]).array() + kGutter;
  const std::uint32_t x0 = cell(low.x(), rect.x, rect.width), x1 = cell(high.x(), rect.x, rect.width);
  const std::uint32_t y0 = cell(low.y(), rect.y, rect.height), y1 = cell(high.y(), rect.y, rect.height);
  for (std::uint32_t y = y0; y <= y1; ++y) {  // bound: a chart's extent
    for (std::uint32_t x = x0; x <= x1; ++x) {
      const std::uint32_t number = y * cells_per_row_ + x;
      if (seen_cell_[number] == number_) continue;
      seen_cell_[number] = number_;
      cells_.push_back(number);
    }
  }
}

std::span<const std::uint32_t> TouchedCells::next(std::uint32_t most_texels) noexcept {
  constexpr std::uint32_t kTexelsOfCell = kCellTexels * kCellTexels;
  ++number_;  // tiles are told apart from those of the step before
  tiles_.clear();
  const std::size_t first = given_;
  given_ += std::min<std::size_t>(cells_.size() - first, most_texels / kTexelsOfCell);
  const std::span<const std::uint32_t> given(cells_.data() + first, given_ - first);
  for (const std::uint32_t cell : given) add_tile(cell);
  return given;
}

void TouchedCells::add_tile(std::uint32_t cell) noexcept {
  constexpr std::uint32_t kCellsPerTile = kTileTexels / kCellTexels;
  const std::uint32_t tile = cell / cells_per_row_ / kCellsPerTile * (cells_per_row_ / kCellsPerTile) +
                             cell % cells_per_row_ / kCellsPerTile;
  if (seen_tile_[tile] == number_) return;
  seen_tile_[tile] = number_;
  tiles_.push_back(tile);
}

}  // namespace orcart
