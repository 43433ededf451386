// What one DICOM image, a file of its own or a frame of one, says of itself, as far as stacking and reading
// need it. No patient's name is kept.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "realtime/base/result.hpp"
#include "tools/volume/volume.hpp"

namespace orcart {

/// What may set two frames at one place apart, such as {"echo", "4.6 ms"}.
struct Facet {
  std::string name, value;
};

struct DicomSlice {
  std::filesystem::path file;
  int frame = 0;            ///< from 1, of an enhanced file; 0: the file is one slice
  std::size_t patient = 0;  ///< a hash of the patient's identity, to tell two apart
  std::string instance, series, frame_of_reference, modality, description;
  std::string variant;        ///< echo or time: what sets slices at one place apart
  std::string acquisition;    ///< its number; slices of one volume may have many
  std::string part, block;    ///< of a frame: its file (or its concatenation of files), and its stack therein
  std::vector<Facet> facets;  ///< of a frame, the most telling first
  int columns = 0, rows = 0;
  bool has_position = false;
  PlainPoint position_mm{};                                ///< LPS, centre of the first pixel
  PlainPoint along_columns{1, 0, 0}, along_rows{0, 1, 0};  ///< unit: where the column and the row index grow
  double column_step_mm = 0, row_step_mm = 0;
  double thickness_mm = 0;
  double slope = 1, intercept = 0;  ///< intensity = slope * pixel + intercept
};

/// For messages: the file, and which of its frames.
std::string name_of(const DicomSlice& slice);
/// Where a slice lies along the normal of another, mm.
double height_mm(const DicomSlice& slice, const PlainPoint& normal);
/// Heights nearer than this are one place, mm.
inline constexpr double kSamePlaceMm = 1e-3;
PlainPoint normal_of(const DicomSlice& slice);

/// Frames of one kind by what sets those at one place apart: facet by facet, as far as places are taken
/// twice. A facet that differs only from place to place (a delay of each slice) splits nothing. The variant
/// of each says which it is. Slices without facets stay together.
std::vector<std::vector<DicomSlice>> split_by_facets(std::vector<DicomSlice> group);

/// Slices of one lattice in order, and how far apart they are.
struct DicomStack {
  std::vector<DicomSlice> slices;
  VoxelLattice lattice;
  std::vector<std::string> notes;
  std::string fault;  ///< why it is no volume; empty: it is one
};

/// Groups by series, orientation, size, variant and facets, sorts each along its normal and cuts it where
/// slices are missing (a gap of over 1.5 times the usual). A stack has a fault where a slice lies at the
/// place of another and nothing in the headers tells them apart, or where slices lie more than a quarter of a
/// step from an even spacing. A second copy of one image is left out, and so are images without a place,
/// which all stacks tell; two patients, images of which none has a place and frames without one are refused.
/// Stacks in the order of their slice count, the largest first; a lone slice is a stack too.
Result<std::vector<DicomStack>> stack_slices(const std::string& folder, std::vector<DicomSlice> slices);

/// The stack that `wanted` (from 1) names; 0: the only one with more than one slice and no fault, if nothing
/// else is of its series and orientation. Refuses with the list; one with a fault is refused with that.
Result<DicomStack> choose_stack(const std::string& folder, std::vector<DicomStack> stacks, int wanted);

}  // namespace orcart
