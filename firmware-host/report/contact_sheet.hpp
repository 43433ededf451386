// Several pictures on one sheet, made smaller by an area filter.
#pragma once

#include <vector>

#include "firmware-host/files/picture_file.hpp"

namespace orcart {

struct SheetLayout {
  int columns = 3;
  int thumb_width_px = 640;
  int gap_px = 8;
};

/// Rows of thumbnails in the order given; each keeps its aspect, a row is as high as its highest. Empty in,
/// empty out.
Picture contact_sheet(const std::vector<Picture>& pictures, const SheetLayout& layout);

}  // namespace orcart
