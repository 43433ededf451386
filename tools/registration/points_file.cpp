// One reader a format; the coordinate system is settled in one place.
#include "tools/registration/points_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

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
};

std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields;
  const char part = line.find(',') != std::string_view::npos ? ',' : ' ';
  std::string field;
  for (const char c : std::string(line) + part) {
    if (c != part && c != '\t' && c != '\r') {
      field += c;
    } else if (part == ',' || !field.empty()) {
      const auto first = field.find_first_not_of(' ');
      fields.push_back(
          first == std::string::npos ? "" : field.substr(first, field.find_last_not_of(' ') - first + 1));
      field.clear();
    }
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
  std::size_t x = 1, label = 0;
};

void read_header(std::string_view line, FcsvHeader& header) {
  const auto equals = line.find('=');
  if (equals == std::string_view::npos) return;
  const auto value = fields_of(line.substr(equals + 1));
  if (line.find("CoordinateSystem") != std::string_view::npos && !value.empty())
    header.space = space_of(value.back());
  if (line.find("columns") == std::string_view::npos) return;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (value[i] == "x") header.x = i;
    if (value[i] == "label") header.label = i;
  }
}

Result<Stated> read_rows(std::string_view text, const std::filesystem::path& file, bool fcsv) {
  Stated stated;
  FcsvHeader header;
  TextCursor cursor(text);
  while (!cursor.at_end()) {
    const std::string_view line = cursor.line();
    if (line.find_first_not_of(" \t,") == std::string_view::npos) continue;
    if (line.starts_with('#')) {
      read_header(line, header);
      continue;
    }
    const auto fields = fields_of(line);
    const std::string place = file.string() + ":" + std::to_string(cursor.line_number()) + ": ";
    const bool named = fields.size() != 3;
    const auto at = place_at(fields, fcsv ? header.x : named ? 1 : 0);
    if (!at && stated.points.empty() && fields.size() >= 3 &&
        !TextCursor::parse_number<double>(fields.back()))
      continue;  // names of columns
    if (!at || (!fcsv && fields.size() > 4))
      return fail(place + "\"" + std::string(line.substr(0, 60)) + "\" is no point; " +
                  (fcsv ? "a row of Slicer's .fcsv is accepted" : kAccepted));
    std::string name = fcsv && header.label < fields.size() ? fields[header.label] : named ? fields[0] : "";
    if (name.empty()) name = std::to_string(stated.points.size() + 1);
    stated.points.push_back({.name = name, .mm = *at});
  }
  stated.space = header.space;
  return stated;
}

Result<Stated> read_markups(std::string_view text, const std::filesystem::path& file) {
  const auto json = read_json(text);
  const JsonValue* markups = json ? json->member("markups") : nullptr;
  if (markups == nullptr || markups->items.empty())
    return fail(file.string() + ": holds no \"markups\"; a markup file of 3D Slicer (.mrk.json) is accepted");
  Stated stated;
  const JsonValue& markup = markups->items.front();
  if (const JsonValue* system = markup.member("coordinateSystem")) stated.space = space_of(system->text);
  if (const JsonValue* units = markup.member("coordinateUnits"); units != nullptr && units->text != "mm")
    return fail(file.string() + ": coordinateUnits is \"" + units->text + "\"; mm is accepted");
  const JsonValue* points = markup.member("controlPoints");
  if (points == nullptr) return stated;
  for (const JsonValue& point : points->items) {
    const JsonValue* place = point.member("position");
    if (place == nullptr || place->items.size() != 3)
      return fail(file.string() + ": control point " + std::to_string(stated.points.size() + 1) +
                  " has no position of three numbers");
    const JsonValue* label = point.member("label");
    stated.points.push_back({.name = label != nullptr && !label->text.empty()
                                         ? label->text
                                         : std::to_string(stated.points.size() + 1),
                             .mm = {place->items[0].number, place->items[1].number, place->items[2].number}});
  }
  return stated;
}

}  // namespace

Result<std::vector<NamedPoint>> read_points(const std::filesystem::path& file, std::optional<Space> told) {
  const auto bytes = read_whole_file(file, kLargestFileBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  const std::string name = file.filename().string();
  const bool markups = name.ends_with(".json"), fcsv = name.ends_with(".fcsv");
  auto stated = markups ? read_markups(text, file) : read_rows(text, file, fcsv);
  if (!stated) return tl::unexpected(stated.error());
  if (stated->points.empty()) return fail(file.string() + ": holds no point; " + kAccepted);
  if (stated->space && told && *stated->space != *told)
    return fail(file.string() + ": states " + (*stated->space == Space::lps ? "LPS" : "RAS") +
                ", not what was told; leave the option out");
  if ((markups || fcsv) && !stated->space && !told)
    return fail(file.string() +
                ": does not state its coordinate system; tell it with --space LPS or --space RAS");
  const Space space = stated->space.value_or(told.value_or(Space::lps));
  std::set<std::string> names;
  for (NamedPoint& point : stated->points) {
    if (!names.insert(point.name).second)
      return fail(file.string() + ": two points are named \"" + point.name +
                  "\"; each name once is accepted");
    if (space == Space::ras) point.mm.head<2>() *= -1;
  }
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
