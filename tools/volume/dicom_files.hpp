// DICOM through GDCM: headers of a folder's or a file's images, and the pixels of a stack.
#pragma once

#include <functional>

#include "tools/volume/dicom_slice.hpp"

namespace orcart {

/// Whether a file begins as DICOM does.
bool is_dicom(const std::filesystem::path& file);

struct DicomFolder {
  std::vector<DicomSlice> slices;
  std::vector<std::string> notes;
};

/// Every DICOM image in a folder and the folders in it, or in one file: a slice for each classic file, for
/// each frame of an enhanced one. Other files are left out and counted in a note. A file that begins as
/// DICOM and cannot be read is refused by name.
Result<DicomFolder> read_dicom_headers(const std::filesystem::path& path);

/// The voxels of a stack, rescaled (Hounsfield in CT). Compressed pixels are unpacked where GDCM can. A file
/// is read once, and held until its last frame is out.
Result<Volume> read_stack(const DicomStack& stack, const std::function<void(double done)>& progress);

}  // namespace orcart
