// A ring of tile slots; undo and redo are the same swap.
#include "render/atlas/undo_store.hpp"

#include <algorithm>
#include <cmath>

namespace orcart {

Result<void> UndoStore::make_layer(TexelKind kind, const KeptLayer& kept, Layer& layer,
                                   std::size_t most_moves) {
  const GLenum format = kind == TexelKind::record ? GL_RGBA16UI : GL_RGBA8;
  layer.kept = kept;
  layer.store = gles::make_texture({format, store_size_texels_, store_size_texels_});
  layer.scratch = gles::make_texture({format, atlas_.size_texels, atlas_.size_texels});
  auto store = gles::make_framebuffer(layer.store.id());
  if (!store) return tl::unexpected(store.error());
  auto scratch = gles::make_framebuffer(layer.scratch.id());
  if (!scratch) return tl::unexpected(scratch.error());
  layer.store_framebuffer = std::move(*store);
  layer.scratch_framebuffer = std::move(*scratch);
  auto copier = TileCopier::create(kind, most_moves);
  if (!copier) return tl::unexpected(copier.error());
  layer.copier = std::move(*copier);
  return {};
}

Result<UndoStore> UndoStore::create(const KeptAtlas& atlas, int units) {
  UndoStore self;
  self.atlas_ = atlas;
  self.tiles_per_row_ = static_cast<std::uint32_t>(atlas.size_texels / kTileTexels);
  const std::uint64_t tiles = static_cast<std::uint64_t>(self.tiles_per_row_) * self.tiles_per_row_;
  const std::uint64_t wished = std::min(kMostSlots, tiles * static_cast<std::uint64_t>(units));
  self.slots_per_row_ = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(wished))));
  self.slots_ = static_cast<std::uint64_t>(self.slots_per_row_) * self.slots_per_row_;
  self.store_size_texels_ = static_cast<int>(self.slots_per_row_) * kTileTexels;
  const std::size_t most = std::max<std::size_t>(tiles, self.slots_);
  if (auto made = self.make_layer(TexelKind::colour, atlas.colour, self.layers_[0], most); !made)
    return tl::unexpected(made.error());
  if (auto made = self.make_layer(TexelKind::record, atlas.record, self.layers_[1], most); !made)
    return tl::unexpected(made.error());
  self.units_.resize(static_cast<std::size_t>(units));
  self.tile_of_slot_.resize(self.slots_);
  self.kept_in_unit_.assign(tiles, 0);
  for (auto* moves : {&self.moves_, &self.out_, &self.back_}) moves->reserve(most);
  self.touched_.reserve(most);
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
  for (Layer& layer : layers_)
    layer.copier->copy(layer.kept.texture, {layer.store_framebuffer.id(), store_size_texels_}, moves_);
}

void UndoStore::show_before(std::span<const std::uint32_t> tiles) noexcept {
  moves_.clear();
  for (const std::uint32_t tile : tiles) {
    const TileMove move = move_to_store(tile, 0);
    moves_.push_back({move.from_x, move.from_y, move.from_x, move.from_y});
  }
  Layer& records = layers_[1];
  records.copier->copy(records.kept.texture, {records.scratch_framebuffer.id(), atlas_.size_texels}, moves_);
}

std::span<const std::uint32_t> UndoStore::undo() noexcept {
  if (newest_ == oldest_) return {};
  return swap_unit(unit_at(--newest_));
}

std::span<const std::uint32_t> UndoStore::redo() noexcept {
  if (newest_ == end_) return {};
  return swap_unit(unit_at(newest_++));
}

std::span<const std::uint32_t> UndoStore::swap_unit(const Unit& unit) noexcept {
  touched_.clear();
  moves_.clear();
  out_.clear();
  back_.clear();
  for (std::uint64_t i = 0; i < unit.slot_count; ++i) {
    const std::uint32_t tile = tile_of_slot_[(unit.first_slot + i) % slots_];
    const TileMove move = move_to_store(tile, unit.first_slot + i);
    touched_.push_back(tile);
    moves_.push_back({move.from_x, move.from_y, move.from_x, move.from_y});
    out_.push_back({move.to_x, move.to_y, move.from_x, move.from_y});
    back_.push_back(move);
  }
  for (Layer& layer : layers_) swap(layer);
  mark_kept();
  return touched_;
}

// Atlas to scratch, store to atlas, scratch to store.
void UndoStore::swap(Layer& layer) noexcept {
  layer.copier->copy(layer.kept.texture, {layer.scratch_framebuffer.id(), atlas_.size_texels}, moves_);
  layer.copier->copy(layer.store.id(), {layer.kept.framebuffer, atlas_.size_texels}, out_);
  layer.copier->copy(layer.scratch.id(), {layer.store_framebuffer.id(), store_size_texels_}, back_);
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
