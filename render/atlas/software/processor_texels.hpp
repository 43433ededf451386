// The paint step without a GPU: depth and texels by the processor's vector units, on a copy of the atlas in
// memory. Changed tiles go up to the driver's atlas when something there is about to read them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/atlas/software/depth_raster.hpp"
#include "render/atlas/software/texel_job.hpp"
#include "render/atlas/undo_store.hpp"

namespace orcart {

/// The thread whose GL context is current. Allocates nothing once made.
class ProcessorTexels {
 public:
  ProcessorTexels(const ProcessorTexels&) = delete;
  ProcessorTexels& operator=(const ProcessorTexels&) = delete;
  /// The mesh must outlive it. `points`: x y z and normal of each texel, as SurfaceTextures::points.
  ProcessorTexels(const TriangleMesh& mesh, const KeptAtlas& atlas, const DepthPinhole& pinhole,
                  const PaintChoices& choices, std::span<const float> points);

  /// Adds a part to what the scope sees.
  void see(const CutoutPatch& part, const Pose<C, M>& X_CM) noexcept { depth_.draw(part, X_CM); }
  /// Paints these cells, which lie in these tiles, in memory.
  void paint(std::span<const std::uint32_t> cells, std::span<const std::uint32_t> tiles,
             const PaintUniforms& uniforms, const gles::PicturePlanes& picture) noexcept;
  /// Brings the driver's atlas up to date.
  void send() noexcept;
  /// The driver's atlas, up to date before, was changed there by others: it is read back before these tiles
  /// are painted or shown again.
  void forget(std::span<const std::uint32_t> tiles) noexcept;
  void clear() noexcept;
  /// In memory, with what others changed.
  const TexelMemory& up_to_date() noexcept;

 private:
  void read_again(std::uint32_t tile) noexcept;
  std::size_t corner_of(std::uint32_t tile) const noexcept;

  KeptAtlas atlas_;
  DepthRaster depth_;
  TexelJob job_;
  std::vector<float> x_mm_, y_mm_, z_mm_, normal_;
  std::vector<std::uint32_t> colours_;
  std::vector<TexelRecord> records_;
  enum class Newer : std::uint8_t { neither, in_memory, in_driver };
  std::vector<Newer> newer_;           ///< by tile
  std::vector<std::uint32_t> unsent_;  ///< tiles that are newer in memory
  bool some_forgotten_ = false;        ///< there are tiles that are newer in the driver
};

}  // namespace orcart
