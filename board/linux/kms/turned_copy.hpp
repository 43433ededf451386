// Copies a picture onto a panel that is mounted turned, where the card cannot turn it.
#pragma once

#include "board/linux/kms/panel_choice.hpp"
#include "realtime/base/image.hpp"

namespace orcart {

/// Four bytes a pixel. `to` is of `from`'s size, turned; a panel turned clockwise by a quarter shows the
/// picture upright when its rows run down the picture's columns from the left, bottom up.
void copy_turned(const ImageDescriptor& from, const ImageDescriptor& to, Rotation rotation) noexcept;

}  // namespace orcart
