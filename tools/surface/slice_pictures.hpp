// Three slices of a volume with a surface's outline on them: what a person checks a segmentation by.
#pragma once

#include <array>

#include "firmware-host/files/picture_file.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "tools/volume/volume.hpp"

namespace orcart {

struct SlicePicture {
  Picture picture;
  char across = 'z';    ///< the LPS axis the slice is nearest to perpendicular to
  int index = 0;        ///< of the slice along the volume's own axis
  double place_mm = 0;  ///< of its centre along `across`
};

/// One slice across each axis of the volume through the voxel nearest to `through_mm` (LPS), square pixels,
/// grey between the 1st and the 99th percentile of the slice, the outline yellow. Axial slices lie as
/// radiologists look at them: the patient's right at the left, front on top; the others have z upwards.
std::array<SlicePicture, 3> draw_slices(const Volume& volume, const TriangleMesh& mesh,
                                        const PlainPoint& through_mm);

}  // namespace orcart
