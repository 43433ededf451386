// PLUS sequence files (.igs.mha): tracked tools over time, and the places at which a stylus rested.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/geometry/pose.hpp"
#include "tools/registration/points_file.hpp"
#include "tools/registration/poses_file.hpp"
#include "tools/registration/rests.hpp"

namespace orcart {

struct W {};  ///< whatever frame a file names; the name says which

struct SequenceFrame {
  double time_s = 0;
  std::map<std::string, Pose<W, W>>
      transforms;  ///< by name as in the file, e.g. "StylusToTracker"; only those with status OK
};

struct SequenceFile {
  std::vector<SequenceFrame> frames;
  std::size_t transforms_ok = 0, transforms_not_ok = 0;
};

/// Whether a name ends as the formats do that PLUS writes sequences in: .mha, .mhd, .nrrd.
bool is_sequence_name(const std::filesystem::path& file);

/// Reads the header; the pictures behind it are left alone.
Result<SequenceFile> read_sequence(const std::filesystem::path& file);

/// What the two tools are called in the file; StylusTip where its tip was calibrated in PLUS already.
struct StylusNames {
  std::string stylus = "Stylus", reference = "Reference";
};

/// The stylus in the reference in each frame that shows both, named by the frame's number. Refuses a file in
/// which no frame does, with what it holds.
Result<std::vector<NamedPose>> stylus_poses(const SequenceFile& sequence, const StylusNames& names = {});

/// The stylus tip in the reference, averaged over each rest, named "1", "2", ...; `tip_mm` in the stylus's
/// marker. Refuses a file without both tools.
Result<std::vector<NamedPoint>> stylus_rests(const SequenceFile& sequence, const Eigen::Vector3d& tip_mm,
                                             const RestSearch& search = {}, const StylusNames& names = {});

}  // namespace orcart
