// Cell by cell, row by row, a vector of texels at a time, chosen for the processor when first run (Highway).
#include "render/atlas/software/texel_job.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "render/shaders/wide_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/atlas/software/texel_job.cpp"
#include <hwy/foreach_target.h>

#include "render/atlas/software/texel_rules.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

__attribute__((flatten)) void paint_cells(const TexelJob& job, std::span<const std::uint32_t> cells) {
  TexelRules rules(job);
  const auto width = static_cast<std::size_t>(job.atlas.width_texels), cells_per_row = width / kCellTexels;
  for (const std::uint32_t cell : cells) {
    const std::size_t corner =
        cell / cells_per_row * kCellTexels * width + cell % cells_per_row * kCellTexels;
    for (std::size_t y = 0; y < kCellTexels; ++y)
      for (std::size_t x = 0; x < kCellTexels; x += hn::Lanes(Reals())) rules.paint(corner + y * width + x);
  }
}

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orcart {

HWY_EXPORT(paint_cells);

void paint_cells(const TexelJob& job, std::span<const std::uint32_t> cells) noexcept {
  HWY_DYNAMIC_DISPATCH(paint_cells)(job, cells);
}

}  // namespace orcart
#endif
