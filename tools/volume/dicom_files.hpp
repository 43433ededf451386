// DICOM through GDCM: headers of a folder's images, and the pixels of a stack.
#pragma once

#include <functional>

#include "tools/volume/dicom_slice.hpp"

namespace orcart {

/// Whether a file begins as DICOM does ("DICM" after 128 bytes).
bool is_dicom(const std::filesystem::path& file);

struct DicomFolder {
  std::vector<DicomSlice> slices;
  std::vector<std::string> notes;
};

/// Every DICOM image in a folder and the folders in it; other files are left out and counted in a note. A
/// file that begins as DICOM and cannot be read is refused by name.
Result<DicomFolder> read_dicom_folder(const std::filesystem::path& folder);

/// The voxels of a stack, rescaled (Hounsfield in CT). Compressed pixels are unpacked where GDCM can.
Result<Volume> read_stack(const DicomStack& stack, const std::function<void(double done)>& progress);

}  // namespace orcart
