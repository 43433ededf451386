// A few thousand pixels of a picture, spread evenly: enough to tell a repeated picture, a black one or a
// blown-out one.
#pragma once

#include <cstdint>

#include "realtime/base/image.hpp"

namespace orcart {

struct PictureSamples {
  bool known = false;          ///< false where the pixels are not in this process's memory
  std::uint32_t checksum = 0;  ///< FNV-1a over the sampled luma: equal pictures, equal checksums
  float mean_luma = 0;         ///< 0..255; of RGB pictures the green channel stands for luma
  float dark_share = 0;        ///< of the samples, luma below 24
  float bright_share = 0;      ///< of the samples, luma above 250
};

/// Looks at a grid of at most 64x48 pixels. Allocates nothing.
PictureSamples sample_picture(const ImageDescriptor& image) noexcept;

}  // namespace orcart
