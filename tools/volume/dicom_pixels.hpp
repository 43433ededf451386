// The pixels of one DICOM file, slice by slice.
#pragma once

#include <memory>

#include "tools/volume/dicom_slice.hpp"

namespace orcart {

/// A file's pixels as they are packed, in memory once; each frame is unpacked when it is asked for.
class DicomPixels {
 public:
  static Result<DicomPixels> read(const std::filesystem::path& file);

  DicomPixels(DicomPixels&&) noexcept;
  DicomPixels& operator=(DicomPixels&&) noexcept;
  ~DicomPixels();

  /// The slice's columns * rows intensities. Refuses frames that are not there and pixels cut short.
  Result<void> take(const DicomSlice& slice, float* values) const;

 private:
  struct Parts;
  explicit DicomPixels(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace orcart
