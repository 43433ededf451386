// The header is text, one `Seq_FrameNNNN_NAME = value` a line (`:=` in NRRD).
#include "tools/registration/sequence_file.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <set>

#include "firmware-host/files/text_cursor.hpp"

namespace orcart {
namespace {

constexpr std::size_t kMostFrames = 1'000'000;

std::optional<Pose<W, W>> pose_of(std::string_view text) {
  TextCursor cursor(text);
  std::array<double, 16> m{};
  for (double& value : m) {
    const auto number = cursor.number<double>();
    if (!number || !std::isfinite(*number)) return std::nullopt;
    value = *number;
  }
  Eigen::Matrix3d given;
  given << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
  const NearestRotation nearest = nearest_rotation(given);
  if (nearest.reflected || nearest.deviation > 0.01) return std::nullopt;
  return Pose<W, W>{.rotation = nearest.rotation, .translation_mm = {m[3], m[7], m[11]}};
}

struct Field {
  std::size_t frame = 0;
  std::string name;
  std::string_view value;
};

std::optional<Field> field_of(std::string_view line) {
  constexpr std::string_view kStart = "Seq_Frame";
  if (!line.starts_with(kStart)) return std::nullopt;
  const auto end = line.find('_', kStart.size()), nrrd = line.find(":="), equals = line.find('=');
  if (end == std::string_view::npos || equals == std::string_view::npos || equals < end) return std::nullopt;
  std::string_view digits = line.substr(kStart.size(), end - kStart.size());
  const auto number = TextCursor::parse_number<std::size_t>(digits);
  if (!number || *number >= kMostFrames) return std::nullopt;
  std::string_view name = line.substr(end + 1, (nrrd < equals ? nrrd : equals) - end - 1);
  while (name.ends_with(' ')) name.remove_suffix(1);
  std::string_view value = line.substr(equals + 1);
  while (value.starts_with(' ')) value.remove_prefix(1);
  return Field{.frame = *number, .name = std::string(name), .value = value};
}

/// Takes one field; what was not seen goes to `lost`, since a status may stand before its transform.
void take_field(const Field& field, SequenceFrame& frame, SequenceFile& sequence,
                std::set<std::string>& lost) {
  constexpr std::string_view kTransform = "Transform", kStatus = "TransformStatus";
  const auto name_before = [&](std::string_view end) {
    return field.name.substr(0, field.name.size() - end.size());
  };
  if (field.name == "Timestamp") {
    frame.time_s = TextCursor(field.value).number<double>().value_or(0);
  } else if (field.name.ends_with(kStatus)) {
    const bool ok = field.value.starts_with("OK");
    ++(ok ? sequence.transforms_ok : sequence.transforms_not_ok);
    if (!ok) lost.insert(name_before(kStatus));
  } else if (field.name.ends_with(kTransform)) {
    if (const auto pose = pose_of(field.value)) frame.transforms[name_before(kTransform)] = *pose;
  }
}

/// Every transform's name that some frame has, for a message.
std::string names_in(const SequenceFile& sequence) {
  std::set<std::string> names;
  for (const SequenceFrame& frame : sequence.frames)
    for (const auto& [name, X] : frame.transforms) names.insert(name);
  std::string listed;
  for (const std::string& name : names) listed += (listed.empty() ? "" : ", ") + name;
  return listed.empty() ? "none" : listed;
}

/// The stylus in the reference in one frame: as it is there, or by way of the tracker.
std::optional<Pose<W, W>> stylus_pose(const SequenceFrame& frame, const StylusNames& names) {
  const auto find = [&](const std::string& name) { return frame.transforms.find(name); };
  const auto end = frame.transforms.end();
  const auto direct = find(names.stylus + "To" + names.reference);
  if (direct != end) return direct->second;
  const auto reference = find(names.reference + "ToTracker"), stylus = find(names.stylus + "ToTracker");
  if (reference == end || stylus == end) return std::nullopt;
  return reference->second.inverse() * stylus->second;
}

}  // namespace

bool is_sequence_name(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".mha" || ending == ".mhd" || ending == ".nrrd";
}

Result<SequenceFile> read_sequence(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return fail(file.string() + ": cannot be read; a PLUS sequence (.igs.mha) is accepted");
  SequenceFile sequence;
  std::vector<std::set<std::string>> lost;
  std::string line;
  bool known = false;
  while (std::getline(stream, line)) {
    if (line.ends_with('\r')) line.pop_back();
    if (line.starts_with("ElementDataFile") || line.empty()) break;
    known =
        known || line.starts_with("ObjectType") || line.starts_with("NDims") || line.starts_with("NRRD000");
    if (!known) break;
    const auto field = field_of(line);
    if (!field) continue;
    if (field->frame >= sequence.frames.size()) {
      sequence.frames.resize(field->frame + 1);
      lost.resize(field->frame + 1);
    }
    take_field(*field, sequence.frames[field->frame], sequence, lost[field->frame]);
  }
  for (std::size_t i = 0; i < lost.size(); ++i)
    for (const std::string& name : lost[i]) sequence.frames[i].transforms.erase(name);
  if (!known || sequence.frames.empty())
    return fail(file.string() + ": holds no frames; a PLUS sequence (.igs.mha) is accepted");
  return sequence;
}

Result<std::vector<NamedPose>> stylus_poses(const SequenceFile& sequence, const StylusNames& names) {
  std::vector<NamedPose> poses;
  for (std::size_t i = 0; i < sequence.frames.size(); ++i)
    if (const auto X = stylus_pose(sequence.frames[i], names))
      poses.push_back({.name = std::to_string(i),
                       .X_TS = {.rotation = X->rotation, .translation_mm = X->translation_mm}});
  const std::string across = names.reference == "Tracker"
                                 ? ""
                                 : ", or " + names.stylus + "ToTracker and " + names.reference + "ToTracker,";
  if (poses.empty())
    return fail("no frame of the recording holds " + names.stylus + "To" + names.reference + across +
                " with status OK; it holds " + names_in(sequence) +
                ", which --stylus and --reference may name");
  return poses;
}

Result<std::vector<NamedPoint>> stylus_rests(const SequenceFile& sequence, const Eigen::Vector3d& tip_mm,
                                             const RestSearch& search, const StylusNames& names) {
  const auto poses = stylus_poses(sequence, names);
  if (!poses) return tl::unexpected(poses.error());
  std::vector<Eigen::Vector3d> tips;
  tips.reserve(poses->size());
  for (const NamedPose& pose : *poses) tips.push_back((pose.X_TS * Point<S>{tip_mm}).mm);
  if (tips.size() < search.frames)
    return fail("only " + std::to_string(tips.size()) + " frames of the recording show " + names.stylus +
                " and " + names.reference + "; a rest takes " + std::to_string(search.frames));
  std::vector<NamedPoint> rests;
  for (const Rest& rest : rests_of(tips, search))
    rests.push_back({.name = std::to_string(rests.size() + 1), .mm = rest.mean_mm, .numbered = true});
  return rests;
}

}  // namespace orcart
