// A ring of tile slots; undo and redo are the same swap.
#include "render/atlas/undo_store.hpp"

#include <algorithm>

namespace orcart {

Result<UndoStore> UndoStore::create(const KeptAtlas& atlas, int units) {
  constexpr int kStoreTexels = 2048;
  UndoStore self;
  self.atlas_ = atlas;
  self.tiles_per_row_ = static_cast<std::uint32_t>(atlas.size_texels / kTileTexels);
  self.slots_per_row_ = kStoreTexels / kTileTexels;
  self.slots_ = static_cast<std::uint64_t>(self.slots_per_row_) * self.slots_per_row_;
  self.store_ = gles::make_texture({GL_RGBA8, kStoreTexels, kStoreTexels});
  self.scratch_ = gles::make_texture({GL_RGBA8, atlas.size_texels, atlas.size_texels});
  auto store = gles::make_framebuffer(self.store_.id());
  if (!store) return tl::unexpected(store.error());
  auto scratch = gles::make_framebuffer(self.scratch_.id());
  if (!scratch) return tl::unexpected(scratch.error());
  self.store_framebuffer_ = std::move(*store);
  self.scratch_framebuffer_ = std::move(*scratch);
  const std::size_t tiles = static_cast<std::size_t>(self.tiles_per_row_) * self.tiles_per_row_;
  auto copier = TileCopier::create(std::max<std::size_t>(tiles, self.slots_));
  if (!copier) return tl::unexpected(copier.error());
  self.copier_.push_back(std::move(*copier));
  self.units_.resize(static_cast<std::size_t>(units));
  self.tile_of_slot_.resize(self.slots_);
  self.kept_in_unit_.assign(tiles, 0);
  self.moves_.reserve(std::max<std::size_t>(tiles, self.slots_));
  self.back_.reserve(self.moves_.capacity());
  self.touched_.reserve(self.moves_.capacity());
  return self;
}

TileMove UndoStore::move_to_store(std::uint32_t tile, std::uint64_t slot) const noexcept {
  const auto place = static_cast<std::uint32_t>(slot % slots_);
  return {.from_x = static_cast<std::uint16_t>(tile % tiles_per_row_ * kTileTexels),
          .from_y = static_cast<std::uint16_t>(tile / tiles_per_row_ * kTileTexels),
          .to_x = static_cast<std::uint16_t>(place % slots_per_row_ * kTileTexels),
          .to_y = static_cast<std::uint16_t>(place / slots_per_row_ * kTileTexels)};
}

void UndoStore::begin(std::uint32_t unit) noexcept {
  end_ = newest_;  // what had been undone cannot be redone any more
  const std::uint64_t first =
      newest_ > oldest_ ? unit_at(newest_ - 1).first_slot + unit_at(newest_ - 1).slot_count : 0;
  if (newest_ - oldest_ == units_.size()) ++oldest_;
  unit_at(newest_) = {.id = unit, .first_slot = first, .slot_count = 0};
  end_ = ++newest_;
}

/// Forgets the oldest units until the newest one may have that many more slots.
void UndoStore::make_room(std::size_t slots) noexcept {
  const Unit& newest = unit_at(newest_ - 1);
  const std::uint64_t end = newest.first_slot + newest.slot_count + slots;
  while (oldest_ + 1 < newest_ && end - unit_at(oldest_).first_slot > slots_) ++oldest_;
}

void UndoStore::keep(std::uint32_t unit, std::span<const std::uint32_t> tiles) noexcept {
  if (newest_ == oldest_ || unit_at(newest_ - 1).id != unit || end_ != newest_) begin(unit);
  moves_.clear();
  make_room(tiles.size());
  Unit& newest = unit_at(newest_ - 1);
  for (const std::uint32_t tile : tiles) {
    if (kept_in_unit_[tile] == static_cast<std::uint32_t>(newest_)) continue;
    if (newest.slot_count == slots_) break;  // a unit larger than the store: the rest of it cannot be undone
    kept_in_unit_[tile] = static_cast<std::uint32_t>(newest_);
    const std::uint64_t slot = newest.first_slot + newest.slot_count++;
    tile_of_slot_[slot % slots_] = tile;
    moves_.push_back(move_to_store(tile, slot));
  }
  copier_[0].copy(atlas_.texture, {store_framebuffer_.id(), static_cast<int>(slots_per_row_) * kTileTexels},
                  moves_);
}

std::span<const std::uint32_t> UndoStore::undo() noexcept {
  if (newest_ == oldest_) return {};
  return swap(unit_at(--newest_));
}

std::span<const std::uint32_t> UndoStore::redo() noexcept {
  if (newest_ == end_) return {};
  return swap(unit_at(newest_++));
}

// Atlas to scratch, store to atlas, scratch to store.
std::span<const std::uint32_t> UndoStore::swap(const Unit& unit) noexcept {
  touched_.clear();
  moves_.clear();
  back_.clear();
  for (std::uint64_t i = 0; i < unit.slot_count; ++i) {
    const std::uint32_t tile = tile_of_slot_[(unit.first_slot + i) % slots_];
    const TileMove move = move_to_store(tile, unit.first_slot + i);
    touched_.push_back(tile);
    moves_.push_back({move.from_x, move.from_y, move.from_x, move.from_y});
    back_.push_back({move.to_x, move.to_y, move.from_x, move.from_y});
  }
  copier_[0].copy(atlas_.texture, {scratch_framebuffer_.id(), atlas_.size_texels}, moves_);
  copier_[0].copy(store_.id(), {atlas_.framebuffer, atlas_.size_texels}, back_);
  for (TileMove& move : back_) move = {move.to_x, move.to_y, move.from_x, move.from_y};
  copier_[0].copy(scratch_.id(), {store_framebuffer_.id(), static_cast<int>(slots_per_row_) * kTileTexels},
                  back_);
  mark_kept();
  return touched_;
}

/// After a step back or forth: the unit that is now the newest has kept its tiles already, should it go on.
void UndoStore::mark_kept() noexcept {
  std::fill(kept_in_unit_.begin(), kept_in_unit_.end(), 0u);
  if (newest_ == oldest_) return;
  const Unit& newest = unit_at(newest_ - 1);
  for (std::uint64_t i = 0; i < newest.slot_count; ++i) {
    kept_in_unit_[tile_of_slot_[(newest.first_slot + i) % slots_]] = static_cast<std::uint32_t>(newest_);
  }
}

void UndoStore::forget_all() noexcept {
  oldest_ = newest_ = end_ = 0;
  std::fill(kept_in_unit_.begin(), kept_in_unit_.end(), 0u);
}

}  // namespace orcart
