// What the atlas and its records were before each unit of paint: touched tiles only, in a store of fixed
// size.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/atlas/tile_copier.hpp"

namespace orcart {

/// A picture that is being kept, alone in its framebuffer.
struct KeptLayer {
  GLuint texture = 0, framebuffer = 0;
};

/// A square atlas whose size is a multiple of kTileTexels: the colours and the records behind them.
struct KeptAtlas {
  KeptLayer colour, record;
  int size_texels = 0;
};

/// Units come and go like a stack that forgets its bottom: when slots or units run out, the oldest unit can
/// no longer be undone. There are slots for `units` units that each touch the whole atlas, at most
/// kMostSlots. All calls with the GL context current; nothing is allocated after create().
class UndoStore {
 public:
  static constexpr std::uint64_t kMostSlots = 8192;  ///< 96 MiB: 16 units of 512 tiles
  static Result<UndoStore> create(const KeptAtlas& atlas, int units);

  /// Keeps those of the tiles (row-major numbers) that `unit` has not kept yet. What had been undone is
  /// forgotten.
  void keep(std::uint32_t unit, std::span<const std::uint32_t> tiles) noexcept;
  /// Swaps the newest unit's tiles with what the atlas shows; their numbers, empty where there is nothing to
  /// undo.
  std::span<const std::uint32_t> undo() noexcept;
  std::span<const std::uint32_t> redo() noexcept;
  void forget_all() noexcept;

  /// Sets these tiles of before_texture() to what the records are now.
  void show_before(std::span<const std::uint32_t> tiles) noexcept;
  /// RGBA16UI, atlas size: valid within the tiles of the newest show_before().
  GLuint before_texture() const noexcept { return layers_[1].scratch.id(); }

 private:
  struct Unit {
    std::uint32_t id = 0;
    std::uint64_t first_slot = 0,
                  slot_count = 0;  ///< slots are numbered for ever; their place is modulo the store
  };
  /// One kept picture with its store and a scratch of the atlas's size.
  struct Layer {
    KeptLayer kept;
    gles::Texture store, scratch;
    gles::Framebuffer store_framebuffer, scratch_framebuffer;
    std::optional<TileCopier> copier;  ///< once it is made
  };
  UndoStore() = default;
  Result<void> make_layer(TexelKind kind, const KeptLayer& kept, Layer& layer, std::size_t most_moves);
  void swap(Layer& layer) noexcept;
  Unit& unit_at(std::uint64_t number) noexcept { return units_[number % units_.size()]; }
  void begin(std::uint32_t unit) noexcept;
  void make_room(std::size_t slots) noexcept;
  std::span<const std::uint32_t> swap_unit(const Unit& unit) noexcept;
  void mark_kept() noexcept;
  TileMove move_to_store(std::uint32_t tile, std::uint64_t slot) const noexcept;

  KeptAtlas atlas_;
  std::uint32_t tiles_per_row_ = 0, slots_per_row_ = 0;
  int store_size_texels_ = 0;
  std::uint64_t slots_ = 0;
  std::array<Layer, 2> layers_;  ///< colours, records
  std::vector<Unit> units_;
  std::uint64_t oldest_ = 0, end_ = 0,
                newest_ = 0;  ///< units [oldest_, newest_) can be undone, [newest_, end_) redone
  std::vector<std::uint32_t> tile_of_slot_;
  std::vector<std::uint32_t> kept_in_unit_;  ///< per tile: the number of the unit that kept it last, plus one
  std::vector<TileMove> moves_, out_, back_;
  std::vector<std::uint32_t> touched_;
};

}  // namespace orcart
