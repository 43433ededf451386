// What one DICOM image says of itself, as far as stacking needs it. No patient's name is kept.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "realtime/base/result.hpp"
#include "tools/volume/volume.hpp"

namespace orcart {

struct DicomSlice {
  std::filesystem::path file;
  std::size_t patient = 0;  ///< a hash of the patient's identity, to tell two apart
  std::string instance, series, frame_of_reference, modality, description;
  std::string variant;      ///< echo or time: what sets slices at one place apart
  std::string acquisition;  ///< its number; slices of one volume may have many
  int columns = 0, rows = 0;
  bool has_position = false;
  PlainPoint position_mm{};                                ///< LPS, centre of the first pixel
  PlainPoint along_columns{1, 0, 0}, along_rows{0, 1, 0};  ///< unit: where the column and the row index grow
  double column_step_mm = 0, row_step_mm = 0;
  double thickness_mm = 0;
};

/// Slices of one lattice in order, and how far apart they are.
struct DicomStack {
  std::vector<DicomSlice> slices;
  VoxelLattice lattice;
  std::vector<std::string> notes;
};

/// Groups by series, orientation, size and variant, sorts each along its normal and cuts it where slices are
/// missing (a gap of over 1.5 times the usual). A slice at the place of another is refused where nothing in
/// the headers tells them apart, but a second copy of one image is left out; so are two patients. Stacks in
/// the order of their slice count, the largest first; a lone slice is a stack too.
Result<std::vector<DicomStack>> stack_slices(const std::string& folder, std::vector<DicomSlice> slices);

/// The stack that `wanted` (from 1) names; 0: the only one with more than one slice. Refuses with the list.
Result<DicomStack> choose_stack(const std::string& folder, std::vector<DicomStack> stacks, int wanted);

}  // namespace orcart
