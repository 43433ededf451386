// A plane of a picture made half as fine again and again, so that what is drawn small is averaged, not
// picked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

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
  PicturePyramid(int width, int height, int channels, int levels);

  /// Halves `plane`, which is level 0 and of the size given at creation.
  void build(const PlaneView& plane) noexcept;
  int levels() const noexcept { return static_cast<int>(levels_.size()); }
  /// `number` 1 is half as fine as the plane; tight rows.
  const std::uint8_t* level(int number) const noexcept {
    return levels_[static_cast<std::size_t>(number - 1)].data();
  }

 private:
  int width_, height_, channels_;
  std::vector<std::vector<std::uint8_t>> levels_;
};

}  // namespace orcart::gles
