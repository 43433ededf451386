// Reads a CT or MR volume, whatever it comes as: DICOM, NIfTI, NRRD, MetaImage or MGH.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "firmware-host/files/space.hpp"
#include "realtime/base/result.hpp"
#include "tools/volume/volume.hpp"

namespace orcart {

struct VolumeRequest {
  std::filesystem::path path;           ///< a folder of DICOM, or a file
  std::optional<Space> where_unstated;  ///< of a file that states no patient space
  int stack = 0;                        ///< of a folder with several: from 1; 0 where it has one
};

/// What a file is tells its beginning, not its name. The file's own statement about space wins and is turned
/// into LPS; one that states none is refused until told. Numbers that are none (NaN) become the least.
Result<Volume> read_volume(const VolumeRequest& request,
                           const std::function<void(double done)>& progress = {});

}  // namespace orcart
