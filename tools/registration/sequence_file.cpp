// The header is text, one `Seq_FrameNNNN_NAME = value` a line.
#include "tools/registration/sequence_file.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <optional>

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
  const auto end = line.find('_', kStart.size()), equals = line.find(" = ");
  if (end == std::string_view::npos || equals == std::string_view::npos || equals < end) return std::nullopt;
  std::string_view digits = line.substr(kStart.size(), end - kStart.size());
  const auto number = TextCursor::parse_number<std::size_t>(digits);
  if (!number || *number >= kMostFrames) return std::nullopt;
  return Field{.frame = *number,
               .name = std::string(line.substr(end + 1, equals - end - 1)),
               .value = line.substr(equals + 3)};
}

}  // namespace

Result<SequenceFile> read_sequence(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return fail(file.string() + ": cannot be read; a PLUS sequence (.igs.mha) is accepted");
  constexpr std::string_view kTransform = "Transform", kStatus = "TransformStatus";
  SequenceFile sequence;
  std::map<std::pair<std::size_t, std::string>, std::string> texts;
  std::string line;
  bool known = false;
  while (std::getline(stream, line)) {
    if (line.starts_with("ElementDataFile")) break;
    known = known || line.starts_with("ObjectType") || line.starts_with("NDims");
    if (!known) break;
    const auto field = field_of(line);
    if (!field) continue;
    if (field->frame >= sequence.frames.size()) sequence.frames.resize(field->frame + 1);
    SequenceFrame& frame = sequence.frames[field->frame];
    if (field->name == "Timestamp") {
      frame.time_s = TextCursor(field->value).number<double>().value_or(0);
    } else if (field->name.ends_with(kStatus)) {
      const std::string name = field->name.substr(0, field->name.size() - kStatus.size());
      const bool ok = field->value.starts_with("OK");
      ++(ok ? sequence.transforms_ok : sequence.transforms_not_ok);
      if (!ok) frame.transforms.erase(name);
    } else if (field->name.ends_with(kTransform)) {
      if (const auto pose = pose_of(field->value))
        frame.transforms[field->name.substr(0, field->name.size() - kTransform.size())] = *pose;
    }
  }
  if (!known || sequence.frames.empty())
    return fail(file.string() + ": holds no frames; a PLUS sequence (.igs.mha) is accepted");
  return sequence;
}

Result<std::vector<NamedPoint>> stylus_rests(const SequenceFile& sequence, const Eigen::Vector3d& tip_mm,
                                             const RestSearch& search) {
  std::vector<Eigen::Vector3d> tips;
  for (const SequenceFrame& frame : sequence.frames) {
    const auto reference = frame.transforms.find("ReferenceToTracker"),
               stylus = frame.transforms.find("StylusToTracker");
    if (reference == frame.transforms.end() || stylus == frame.transforms.end()) continue;
    tips.push_back((reference->second.inverse() * stylus->second * Point<W>{tip_mm}).mm);
  }
  if (tips.size() < search.frames)
    return fail("the sequence has too few frames with ReferenceToTracker and StylusToTracker");
  std::vector<NamedPoint> rests;
  for (const Rest& rest : rests_of(tips, search))
    rests.push_back({.name = std::to_string(rests.size() + 1), .mm = rest.mean_mm});
  return rests;
}

}  // namespace orcart
