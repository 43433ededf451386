// The frames of an enhanced multi-frame file as slices.
#pragma once

#include <gdcmDataSet.h>

#include "tools/volume/dicom_slice.hpp"

namespace orcart {

/// Where GDCM's data sets hold what places a slice: all one in classic DICOM, three in enhanced.
struct PlaneSets {
  const gdcm::DataSet *position = nullptr, *orientation = nullptr, *measures = nullptr;
};

/// Sets place, directions and steps; has_position stays false where place or directions are missing. Refuses
/// spacings that are not positive and directions that are not unit vectors at right angles.
Result<void> place_slice(const PlaneSets& sets, DicomSlice& slice);

/// What may set a classic slice apart from another at its place, beside its variant.
std::vector<Facet> facets_of_slice(const gdcm::DataSet& set);

/// Whether a data set describes its frames one by one.
bool has_frame_groups(const gdcm::DataSet& set);

/// One slice for each of `frames` frames, with the attributes of the file that `of_file` has. What a frame
/// says itself goes before what all share (DICOM PS3.3, C.7.6.16). Refuses another number of descriptions
/// than of frames.
Result<std::vector<DicomSlice>> frames_of(const gdcm::DataSet& set, const DicomSlice& of_file, double frames);

}  // namespace orcart
