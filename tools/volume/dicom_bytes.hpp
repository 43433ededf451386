// DICOM as bytes: where its data set begins, and whether all of it is there.
#pragma once

#include <string_view>

namespace orcart {

/// Whether a file begins as DICOM does: "DICM" after 128 bytes, or at once with elements of group 8 in order.
bool begins_as_dicom(std::string_view bytes);

struct DicomExtent {
  bool whole =
      false;  ///< every element lies within the file, those in sequences and the pieces of pixels too
  bool has_pixels = false;
};

/// GDCM aborts on some files that are cut short and fills others up. Both are true of a file that is deflated
/// or big endian, which is not looked at.
DicomExtent extent_of_dicom(std::string_view bytes);

}  // namespace orcart
