// Readers hand over places; a rest that drifts is none.
#include "tools/evaluate/recorded/still_tools.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "firmware-host/tracker/ndi/dialogue_figures.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/poses_file.hpp"
#include "tools/registration/rests.hpp"
#include "tools/registration/sequence_file.hpp"

namespace orcart {
namespace {

constexpr double kFewestJumps = 0.4;  ///< of successive_ratio()
constexpr std::size_t kBlock = 10;    ///< readings that count as one for the mean's confidence

std::vector<ToolTrack> listed(const std::filesystem::path& file,
                              const std::map<std::string, std::vector<Eigen::Vector3d>>& by_tool) {
  std::vector<ToolTrack> tracks;
  tracks.reserve(by_tool.size());
  for (const auto& [tool, places_mm] : by_tool)
    tracks.push_back({.file = file.filename().string(), .tool = tool, .places_mm = places_mm});
  return tracks;
}

std::vector<ToolTrack> of_sequence(const std::filesystem::path& file, const SequenceFile& sequence) {
  constexpr std::string_view kEnd = "ToTracker";
  std::map<std::string, std::vector<Eigen::Vector3d>> by_tool;
  for (const SequenceFrame& frame : sequence.frames)
    for (const auto& [name, X] : frame.transforms)
      if (name.ends_with(kEnd))
        by_tool[name.substr(0, name.size() - kEnd.size())].push_back(X.translation_mm);
  return listed(file, by_tool);
}

std::vector<ToolTrack> of_dialogue(const std::filesystem::path& file, const ndi::DialogueFigures& figures) {
  std::map<std::string, std::vector<Eigen::Vector3d>> by_tool;
  std::map<std::uint8_t, std::uint32_t> newest;
  for (const ndi::HandleReading& reading : figures.placed) {
    const auto before = newest.find(reading.handle);
    if (reading.frame != 0 && before != newest.end() && before->second == reading.frame) continue;
    newest[reading.handle] = reading.frame;
    by_tool[json::format("handle %02X", reading.handle)].push_back(
        Eigen::Map<const Eigen::Vector3f>(reading.translation_mm.data()).cast<double>());
  }
  return listed(file, by_tool);
}

std::vector<ToolTrack> of_poses(const std::filesystem::path& file, const PosesFile& poses) {
  ToolTrack track{.file = file.filename().string(), .tool = "the tool", .places_mm = {}};
  for (const NamedPose& pose : poses.poses) track.places_mm.push_back(pose.X_TS.translation_mm);
  return {track};
}

/// Adds what a rest says to the whole.
StillStretch taken(const ToolTrack& track, const Rest& rest, GroupedValues& error) {
  StillStretch stretch{.file = track.file, .tool = track.tool, .readings = rest.count};
  const std::size_t blocks = rest.count / kBlock;
  std::vector<std::vector<double>> groups(blocks);
  const auto count = static_cast<double>(rest.count);
  for (std::size_t i = 0; i < rest.count; ++i) {
    const double off = (track.places_mm[rest.first + i] - rest.mean_mm).norm();
    groups[i * blocks / rest.count].push_back(off);
    stretch.mean_mm += off / count;
    stretch.rms_mm += off * off / count;
    stretch.max_mm = std::max(stretch.max_mm, off);
  }
  stretch.rms_mm = std::sqrt(stretch.rms_mm);
  for (const auto& group : groups) error.add(group);
  return stretch;
}

}  // namespace

Result<std::vector<ToolTrack>> tool_tracks(const std::filesystem::path& file) {
  if (is_sequence_name(file)) {
    const auto sequence = read_sequence(file);
    if (!sequence) return tl::unexpected(sequence.error());
    return of_sequence(file, *sequence);
  }
  if (const auto dialogue = ndi::read_dialogue(file))
    return of_dialogue(file, ndi::count_dialogue(*dialogue));
  const auto poses = read_poses(file);
  if (!poses)
    return fail(poses.error().message +
                "; a PLUS sequence (.mha) and a recorded NDI dialogue are accepted as well");
  return of_poses(file, *poses);
}

StillTools still_tools(const std::vector<ToolTrack>& tracks) {
  StillTools still;
  GroupedValues error;
  for (const ToolTrack& track : tracks)
    for (const Rest& rest : rests_of(track.places_mm, {.frames = 20, .within_mm = 1})) {
      const double ratio = successive_ratio(track.places_mm, rest);
      if (ratio >= kFewestJumps) still.stretches.push_back(taken(track, rest, error));
      if (ratio > 0 && ratio < kFewestJumps) ++still.moving;
    }
  still.error = error.statistics();
  return still;
}

}  // namespace orcart
