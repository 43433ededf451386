// Who copies a camera's picture to where it is painted from.
#pragma once

#include <cstdint>

namespace orcart {

enum class PictureCopy : std::uint8_t {
  cpu,  ///< from where it is mapped
  gpu,  ///< from its dma-buf, where it lies in one and EGL can import it
};

}  // namespace orcart
