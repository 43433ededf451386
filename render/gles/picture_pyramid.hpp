// A plane of a picture made half as fine again and again, so that what is drawn small is averaged, not
// picked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/gles/picture_planes.hpp"

namespace orcart::gles {

/// Bytes as they lie in memory.
struct PlaneView {
  const std::uint8_t* data = nullptr;
  std::size_t stride_bytes = 0;
  int width = 0, height = 0;  ///< texels
};

/// How often a plane can be halved exactly, at most `most` times.
int exact_halvings(int width, int height, int most) noexcept;

/// Means of 2 x 2 texels of `channels` bytes (1, 2 or 4), rounded: level k + 1 from level k. Takes its memory
/// when made.
class PicturePyramid {
 public:
  enum class Keeps : std::uint8_t { coarser_levels, all_levels };
  PicturePyramid(int width, int height, int channels, int levels, Keeps keeps = Keeps::coarser_levels);

  /// Halves `plane`, which is level 0 and of the size given at creation.
  void build(const PlaneView& plane) noexcept;
  bool keeps_all() const noexcept { return keeps_ == Keeps::all_levels; }
  int levels() const noexcept { return in_memory_.count - 1; }
  /// `number` 1 is half as fine as the plane; tight rows. 0 where all are kept.
  const std::uint8_t* level(int number) const noexcept {
    return bytes_.data() + in_memory_.offset_bytes[static_cast<std::size_t>(number)];
  }
  /// Where all are kept.
  PictureLevels in_memory() const noexcept {
    PictureLevels levels = in_memory_;
    levels.first = bytes_.data();
    return levels;
  }

 private:
  PictureLevels in_memory_;  ///< but for its first byte
  Keeps keeps_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace orcart::gles
