// One reader a format; the coordinate system is settled in one place.
#include "tools/registration/points_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>
#include <utility>

#include "firmware-host/files/text_cursor.hpp"
#include "firmware-host/files/whole_file.hpp"
#include "tools/registration/json_reader.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

constexpr std::uintmax_t kLargestFileBytes = 16U << 20U;
constexpr const char* kAccepted = "name,x,y,z or three numbers are accepted";

struct Stated {
  std::vector<NamedPoint> points;
  std::optional<Space> space;
  std::vector<std::string> unplaced;  ///< names of points that the file holds without a place
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// A row as its fields. `part` separates, unless it stands in quotes; a blank stands for a run of blanks and
/// tabs.
std::vector<std::string> split(std::string_view line, char part) {
  std::vector<std::string> fields{""};
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    const bool blank = c == ' ' || c == '\t';
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      fields.back() += line[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (quoted || !(c == part || (part == ' ' && blank)))
      fields.back() += c;
    else if (part != ' ' || !fields.back().empty())
      fields.emplace_back();
  }
  for (std::string& field : fields) {
    field.erase(0, field.find_first_not_of(" \t\r"));
    field.erase(field.find_last_not_of(" \t\r") + 1);
  }
  if (part == ' ' && fields.back().empty()) fields.pop_back();
  return fields;
}

/// Semicolons separate where there are any (a spreadsheet whose decimal mark is the comma), else commas, else
/// blanks.
std::vector<std::string> fields_of(std::string_view line) {
  if (line.find(';') == std::string_view::npos)
    return split(line, line.find(',') != std::string_view::npos ? ',' : ' ');
  std::vector<std::string> fields = split(line, ';');
  for (std::string& field : fields) {
    std::string pointed = field;
    std::replace(pointed.begin(), pointed.end(), ',', '.');
    if (TextCursor::parse_number<double>(pointed)) field = pointed;
  }
  return fields;
}

/// The three numbers that start at a field.
std::optional<Eigen::Vector3d> place_at(const std::vector<std::string>& fields, std::size_t first) {
  Eigen::Vector3d place;
  if (fields.size() < first + 3) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = TextCursor::parse_number<double>(fields[first + i]);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    place[static_cast<Eigen::Index>(i)] = *number;
  }
  return place;
}

std::optional<Space> space_of(std::string_view word) {
  if (word == "LPS" || word == "1") return Space::lps;
  if (word == "RAS" || word == "0") return Space::ras;
  return std::nullopt;
}

/// A header `# CoordinateSystem = LPS`, and the place of the label among `# columns = `.
struct FcsvHeader {
  std::optional<Space> space;
  std::size_t x = 1, label = 0, columns = 0;
};

void read_header(std::string_view line, FcsvHeader& header) {
  const auto equals = line.find('=');
  if (equals == std::string_view::npos) return;
  const std::string key = lower(std::string(line.substr(0, equals)));
  const auto value = fields_of(line.substr(equals + 1));
  if (key.find("coordinatesystem") != std::string::npos && !value.empty())
    header.space = space_of(value.back());
  if (key.find("columns") == std::string::npos) return;
  header.columns = value.size();
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (value[i] == "x") header.x = i;
    if (value[i] == "label") header.label = i;
  }
}

/// Slicer 5 writes two columns more than it names; the first of them is 2 where the point was placed. A point
/// that was skipped or never placed has numbers too, and they mean nothing.
bool is_unplaced(const std::vector<std::string>& fields, const FcsvHeader& header) {
  return header.columns > 0 && fields.size() == header.columns + 2 && fields[header.columns] != "2";
}

Result<Stated> read_rows(std::string_view text, const std::filesystem::path& file, bool fcsv) {
  Stated stated;
  FcsvHeader header;
  TextCursor cursor(text);
  bool headed = false;
  while (!cursor.at_end()) {
    const std::string_view line = cursor.line();
    if (line.find_first_not_of(" \t,;") == std::string_view::npos) continue;
    if (line.starts_with('#')) {
      read_header(line, header);
      continue;
    }
    const auto fields = fields_of(line);
    const std::string place = file.string() + ":" + std::to_string(cursor.line_number()) + ": ";
    const bool named = fields.size() != 3;
    const auto at = place_at(fields, fcsv ? header.x : named ? 1 : 0);
    if (!at && !std::exchange(headed, true) && stated.points.empty() && fields.size() >= 3 &&
        !TextCursor::parse_number<double>(fields.back()))
      continue;  // names of columns
    if (!at || (!fcsv && fields.size() > 4))
      return fail(place + "\"" + std::string(line.substr(0, 60)) + "\" is no point; " +
                  (fcsv ? "a row of Slicer's .fcsv is accepted" : kAccepted));
    std::string name = fcsv && header.label < fields.size() ? fields[header.label] : named ? fields[0] : "";
    const bool numbered = name.empty();
    if (numbered) name = std::to_string(stated.points.size() + stated.unplaced.size() + 1);
    if (fcsv && is_unplaced(fields, header))
      stated.unplaced.push_back(name);
    else
      stated.points.push_back({.name = name, .mm = *at, .numbered = numbered});
  }
  stated.space = header.space;
  return stated;
}

/// Millimetres in one of a markup's units, which may be a DICOM code: [code, scheme, meaning].
std::optional<double> millimetres_of(const JsonValue& units) {
  const std::string& word = units.items.empty() ? units.text : units.items.front().text;
  if (word == "mm") return 1;
  if (word == "um") return 0.001;
  if (word == "cm") return 10;
  if (word == "m") return 1000;
  return std::nullopt;
}

/// A list's control points behind those already read.
Result<void> take_markup(const JsonValue& markup, const std::string& name, Stated& stated) {
  const JsonValue* points = markup.member("controlPoints");
  if (points == nullptr || points->items.empty()) return {};
  std::optional<Space> space;
  if (const JsonValue* system = markup.member("coordinateSystem")) space = space_of(system->text);
  const bool first = stated.points.empty() && stated.unplaced.empty();
  if (!first && space != stated.space)
    return fail(name + ": holds several markups in different coordinate systems; one list is accepted");
  stated.space = space;
  double mm = 1;
  if (const JsonValue* units = markup.member("coordinateUnits")) {
    const auto known = millimetres_of(*units);
    if (!known)
      return fail(name + ": coordinateUnits is \"" + units->text + "\"; mm, um, cm and m are accepted");
    mm = *known;
  }
  for (const JsonValue& point : points->items) {
    const std::size_t number = stated.points.size() + stated.unplaced.size() + 1;
    const JsonValue *place = point.member("position"), *label = point.member("label"),
                    *status = point.member("positionStatus");
    const bool numbered = label == nullptr || label->text.empty();
    const std::string called = numbered ? std::to_string(number) : label->text;
    if (status != nullptr && status->text != "defined") {
      stated.unplaced.push_back(called);
      continue;
    }
    if (place == nullptr || place->items.size() != 3)
      return fail(name + ": control point " + std::to_string(number) + " has no position of three numbers");
    const Eigen::Vector3d at(place->items[0].number, place->items[1].number, place->items[2].number);
    if (!at.allFinite())
      return fail(name + ": control point " + std::to_string(number) + " is at no finite place");
    stated.points.push_back({.name = called, .mm = mm * at, .numbered = numbered});
  }
  return {};
}

Result<Stated> read_markups(std::string_view text, const std::filesystem::path& file) {
  const auto json = read_json(text);
  const JsonValue* markups = json ? json->member("markups") : nullptr;
  if (markups == nullptr || markups->items.empty())
    return fail(file.string() + ": holds no \"markups\"; a markup file of 3D Slicer (.mrk.json) is accepted");
  Stated stated;
  for (const JsonValue& markup : markups->items)
    if (auto taken = take_markup(markup, file.string(), stated); !taken) return tl::unexpected(taken.error());
  return stated;
}

enum class Kind { rows, fcsv, markups };

Kind kind_of(const std::filesystem::path& file) {
  const std::string name = lower(file.filename().string());
  if (name.ends_with(".json")) return Kind::markups;
  return name.ends_with(".fcsv") ? Kind::fcsv : Kind::rows;
}

/// The file's own numbers, each name once.
Result<Stated> read_stated(const std::filesystem::path& file, std::vector<std::string>* notes) {
  const auto bytes = read_whole_file(file, kLargestFileBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const Kind kind = kind_of(file);
  auto stated = kind == Kind::markups ? read_markups(text, file) : read_rows(text, file, kind == Kind::fcsv);
  if (!stated) return stated;
  std::string unplaced;
  for (const std::string& name : stated->unplaced)
    unplaced += (unplaced.empty() ? "\"" : ", \"") + name + "\"";
  if (stated->points.empty())
    return fail(file.string() + ": holds no point" +
                (unplaced.empty() ? std::string("; ") + kAccepted : " that was placed, only " + unplaced));
  if (!unplaced.empty() && notes != nullptr)
    notes->push_back(file.string() + ": without a place and left out: " + unplaced);
  std::set<std::string> names;
  for (const NamedPoint& point : stated->points)
    if (!names.insert(point.name).second)
      return fail(file.string() + ": two points are named \"" + point.name +
                  "\"; each name once is accepted");
  return stated;
}

void turn_about_vertical(std::vector<NamedPoint>& points) {
  for (NamedPoint& point : points) point.mm.head<2>() *= -1;
}

}  // namespace

Result<std::vector<NamedPoint>> read_points(const std::filesystem::path& file, std::optional<Space> told,
                                            std::vector<std::string>* notes) {
  auto stated = read_stated(file, notes);
  if (!stated) return tl::unexpected(stated.error());
  if (stated->space && told && *stated->space != *told)
    return fail(file.string() + ": states " + (*stated->space == Space::lps ? "LPS" : "RAS") +
                ", not what was told; leave the option out");
  if (kind_of(file) != Kind::rows && !stated->space && !told)
    return fail(file.string() +
                ": does not state its coordinate system; tell it with --space LPS or --space RAS");
  if (stated->space.value_or(told.value_or(Space::lps)) == Space::ras) turn_about_vertical(stated->points);
  return stated->points;
}

Result<std::vector<NamedPoint>> read_measured_points(const std::filesystem::path& file,
                                                     std::vector<std::string>* notes) {
  auto stated = read_stated(file, notes);
  if (!stated) return tl::unexpected(stated.error());
  if (kind_of(file) == Kind::rows) return stated->points;
  if (stated->space == Space::lps) turn_about_vertical(stated->points);
  if (notes != nullptr)
    notes->push_back(file.string() +
                     ": a list of 3D Slicer; what Slicer shows as R, A, S is taken for x, y, z in the "
                     "patient's reference");
  return stated->points;
}

Result<void> write_points(const std::filesystem::path& file, const std::vector<NamedPoint>& points) {
  const std::string name = file.filename().string();
  std::string out;
  const auto row = [](const NamedPoint& p) {
    return p.name + "," + json::number(p.mm.x()) + "," + json::number(p.mm.y()) + "," +
           json::number(p.mm.z());
  };
  if (name.ends_with(".mrk.json")) {
    std::vector<std::string> items;
    items.reserve(points.size());
    for (const NamedPoint& p : points)
      items.push_back("{\"label\": " + json::text(p.name) +
                      ", \"position\": " + json::numbers(std::array{p.mm.x(), p.mm.y(), p.mm.z()}) + "}");
    out =
        "{\"markups\": [{\"type\": \"Fiducial\", \"coordinateSystem\": \"LPS\", \"coordinateUnits\": \"mm\", "
        "\"controlPoints\": " +
        json::list(items) + "}]}\n";
  } else if (name.ends_with(".fcsv")) {
    out = "# Markups fiducial file version = 4.11\n# CoordinateSystem = LPS\n# columns = label,x,y,z\n";
    for (const NamedPoint& p : points) out += row(p) + "\n";
  } else {
    out = "name,x,y,z\n";
    for (const NamedPoint& p : points) out += row(p) + "\n";
  }
  return write_whole_file(file, out);
}

}  // namespace orcart
