// Reads poses row by row; every refusal names the file and its line.
#include "tools/registration/poses_file.hpp"

#include <algorithm>
#include <cmath>

#include "firmware-host/files/text_cursor.hpp"
#include "firmware-host/files/whole_file.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

constexpr std::uintmax_t kLargestFileBytes = 64U << 20U;
constexpr const char* kAccepted =
    "name,m00,...,m23 (a name and 12 numbers, row by row), 16 numbers, or 4 numbers on each of 4 lines are "
    "accepted";

struct Row {
  std::string name;
  std::vector<double> numbers;  ///< not all finite where the tool was not seen
};

/// A name in front of the row's first comma, which may hold blanks and stand in quotes; cut from `line`.
std::string cut_name(std::string_view& line) {
  std::string_view head = line.substr(0, line.find_first_of(",;"));
  if (head.size() == line.size()) return {};
  const std::size_t behind = head.size() + 1;
  head.remove_prefix(std::min(head.find_first_not_of(" \t"), head.size()));
  head.remove_suffix(head.size() - std::min(head.find_last_not_of(" \t") + 1, head.size()));
  if (head.size() >= 2 && head.front() == '"' && head.back() == '"') head = head.substr(1, head.size() - 2);
  if (head.empty() || TextCursor(head).number<double>()) return {};
  line.remove_prefix(behind);
  return std::string(head);
}

/// A row's numbers, and the word before them where there is one. False where a word stands among the numbers.
bool split_row(std::string_view line, Row& row) {
  row.name = cut_name(line);
  const std::string_view whole = line;
  std::string blanks(line);
  std::replace_if(
      blanks.begin(), blanks.end(), [](char c) { return c == ',' || c == ';' || c == '\t'; }, ' ');
  TextCursor cursor(blanks);
  for (std::string_view word = cursor.word(); !word.empty(); word = cursor.word()) {
    if (const auto number = TextCursor::parse_number<double>(word)) {
      row.numbers.push_back(*number);
    } else if (row.name.empty() && row.numbers.empty()) {
      row.name = word;
    } else {
      return false;
    }
  }
  if (row.name.empty() && (row.numbers.size() == 13 || row.numbers.size() == 17)) {
    row.name = std::string(whole.substr(0, whole.find_first_of(",; \t")));
    row.numbers.erase(row.numbers.begin());
  }
  return true;
}

Result<NamedPose> pose_of(const Row& row, const std::string& place, std::vector<std::string>& notes) {
  const std::vector<double>& m = row.numbers;
  if (m.size() == 16 &&
      !(std::abs(m[12]) + std::abs(m[13]) + std::abs(m[14]) < 1e-6 && std::abs(m[15] - 1) < 1e-6))
    return fail(
        place + "the fourth row of the matrix is not 0 0 0 1" +
        (std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) < 1e-6 ? " but its fourth column is" : "") +
        "; a rigid transform, row by row, is accepted");
  Eigen::Matrix3d given;
  given << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
  const NearestRotation nearest = nearest_rotation(given);
  const std::string off = json::format("the pose differs by %.2g from a rotation", nearest.deviation);
  if (nearest.reflected) return fail(place + "the pose holds a reflection; a rotation is accepted");
  if (!(nearest.deviation <= 0.01)) return fail(place + off + "; up to 0.01 is accepted");
  if (nearest.deviation > 1e-4) notes.push_back(place + off + " and was made one");
  return NamedPose{.name = row.name,
                   .X_TS = {.rotation = nearest.rotation, .translation_mm = {m[3], m[7], m[11]}}};
}

/// What was not seen is NaN in many programs' recordings; `unseen` counts such rows. Collects matrices that
/// stand on several lines.
Result<void> read_text(std::string_view text, const std::filesystem::path& file, PosesFile& poses,
                       std::size_t& unseen) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  TextCursor cursor(text);
  Row open;
  while (!cursor.at_end()) {
    const std::string_view line = cursor.line();
    const std::string place = file.string() + ":" + std::to_string(cursor.line_number()) + ": ";
    Row row;
    const bool clean = split_row(line, row);
    if (line.find_first_not_of(" \t") == std::string_view::npos || line.starts_with('#') ||
        line.starts_with('%'))
      continue;
    const bool header = poses.poses.empty() && row.numbers.empty() && open.numbers.empty();
    if (header && (clean || line.find("m00") != std::string_view::npos)) continue;
    if (!clean && header && line.find(',') != std::string_view::npos &&
        line.find_first_of("0123456789") == std::string_view::npos)
      continue;
    if (clean && row.numbers.size() == 4 && row.name.empty()) {
      open.numbers.insert(open.numbers.end(), row.numbers.begin(), row.numbers.end());
      if (open.numbers.size() < 16) continue;
      row = std::move(open);
      open = {};
    }
    if (!clean || (row.numbers.size() != 12 && row.numbers.size() != 16))
      return fail(place + "has " + std::to_string(row.numbers.size()) + " numbers" +
                  (clean ? "" : " before a word") + "; " + kAccepted);
    if (!std::all_of(row.numbers.begin(), row.numbers.end(), [](double x) { return std::isfinite(x); })) {
      ++unseen;
      continue;
    }
    const bool numbered = row.name.empty();
    if (numbered) row.name = std::to_string(poses.poses.size() + unseen + 1);
    auto pose = pose_of(row, place, poses.notes);
    if (!pose) return tl::unexpected(pose.error());
    pose->numbered = numbered;
    poses.poses.push_back(std::move(*pose));
  }
  if (!open.numbers.empty()) return fail(file.string() + ": ends inside a matrix; " + kAccepted);
  return {};
}

Result<void> read_one(const std::filesystem::path& file, PosesFile& poses, std::size_t& unseen) {
  const auto bytes = read_whole_file(file, kLargestFileBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return read_text({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, file, poses, unseen);
}

/// A tracker that is within three millimetres of everything it sees, over more than one pose, was written in
/// metres.
Result<void> check_unit(const PosesFile& poses, const std::filesystem::path& file) {
  double largest = 0;
  for (const NamedPose& p : poses.poses) largest = std::max(largest, p.X_TS.translation_mm.norm());
  if (poses.poses.size() > 1 && largest > 0 && largest < 6)
    return fail(
        file.string() +
        json::format(
            ": no translation is longer than %.3g; that looks like metres, and millimetres are accepted",
            largest));
  return {};
}

}  // namespace

Result<PosesFile> read_poses(const std::filesystem::path& file) {
  PosesFile poses;
  std::vector<std::filesystem::path> files{file};
  if (std::filesystem::is_directory(file)) {
    files.clear();
    for (const auto& entry : std::filesystem::directory_iterator(file))
      if (entry.is_regular_file() && !entry.path().filename().string().starts_with('.'))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
  }
  std::size_t unseen = 0;
  for (const auto& one : files)
    if (auto read = read_one(one, poses, unseen); !read) return tl::unexpected(read.error());
  if (unseen > 0)
    poses.notes.push_back(file.string() + ": " + std::to_string(unseen) +
                          " poses hold NaN (the tool was not seen) and were left out");
  if (poses.poses.empty()) return fail(file.string() + ": holds no pose; " + kAccepted);
  if (auto unit = check_unit(poses, file); !unit) return tl::unexpected(unit.error());
  return poses;
}

}  // namespace orcart
