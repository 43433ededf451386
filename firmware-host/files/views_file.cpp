// Reads views.csv line by line; every refusal names its line.
#include "firmware-host/files/views_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "firmware-host/files/text_cursor.hpp"
#include "firmware-host/files/whole_file.hpp"

namespace orcart {
namespace {

constexpr std::uintmax_t kLargestFileBytes = 64U << 20U;
constexpr std::size_t kFields = 13, kVelocity = 6;
constexpr std::array<const char*, kVelocity> kVelocityNames{"vx_mm_s",  "vy_mm_s",  "vz_mm_s",
                                                            "wx_rad_s", "wy_rad_s", "wz_rad_s"};
constexpr const char* kAccepted =
    "image,m00,m01,...,m23 (a name and 12 numbers), then turn_rad where the scope turned, then "
    "vx_mm_s,vy_mm_s,vz_mm_s,wx_rad_s,wy_rad_s,wz_rad_s where its velocity is known, is accepted";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Takes a quoted field off the front of `rest`, which starts with the quote; "" inside is one quote.
std::optional<std::string> take_quoted(std::string_view& rest) {
  std::string field;
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (rest[i] != '"') {
      field += rest[i];
    } else if (i + 1 < rest.size() && rest[i + 1] == '"') {
      field += rest[i++];
    } else {
      rest = trimmed(rest.substr(i + 1));
      return field;
    }
  }
  return std::nullopt;
}

/// Splits at commas outside of quotes; nothing where a quote is not closed or closes inside a field.
std::optional<std::vector<std::string>> split_fields(std::string_view line) {
  std::vector<std::string> fields;
  for (std::string_view rest = trimmed(line);; rest = trimmed(rest.substr(1))) {
    if (rest.starts_with('"')) {
      auto field = take_quoted(rest);
      if (!field || !(rest.empty() || rest.starts_with(','))) return std::nullopt;
      fields.push_back(std::move(*field));
    } else {
      const std::size_t end = rest.find(',');
      fields.emplace_back(trimmed(rest.substr(0, end)));
      rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end);
    }
    if (rest.empty()) return fields;
  }
}

/// A finite number; `name` is its column's.
Result<double> number_of(const std::string& field, const std::string& place, const std::string& name) {
  const auto number = TextCursor::parse_number<double>(field);
  if (number && std::isfinite(*number)) return *number;
  return fail(place + name + " is \"" + field + "\"; a finite number is accepted");
}

/// The pose of a line, made a rotation; `notes` takes what was mended.
Result<Pose<M, C>> pose_of(const std::vector<std::string>& fields, const std::string& place,
                           std::vector<std::string>& notes) {
  constexpr double kLargestDeviation = 0.01, kWorthTelling = 1e-6;
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> given;
  for (std::size_t i = 0; i + 1 < kFields; ++i) {
    const auto number = number_of(fields[i + 1], place, "m" + std::to_string(i / 4) + std::to_string(i % 4));
    if (!number) return tl::unexpected(number.error());
    given.data()[i] = *number;
  }
  const NearestRotation nearest = nearest_rotation(given.leftCols<3>());
  std::array<char, 96> off{};
  std::snprintf(off.data(), off.size(), "the pose differs by %.2g from a rotation", nearest.deviation);
  if (nearest.reflected) return fail(place + "the pose holds a reflection; a rotation is accepted");
  if (!(nearest.deviation <= kLargestDeviation)) return fail(place + off.data() + "; up to 0.01 is accepted");
  if (nearest.deviation > kWorthTelling) notes.push_back(place + off.data() + " and was made one");
  return Pose<M, C>{.rotation = nearest.rotation, .translation_mm = given.col(3)};
}

/// The six fields from `first` on; nothing where all are empty.
Result<std::optional<Twist>> velocity_of(const std::vector<std::string>& fields, std::size_t first,
                                         const std::string& place) {
  if (std::all_of(fields.begin() + static_cast<std::ptrdiff_t>(first), fields.end(),
                  [](const std::string& field) { return field.empty(); }))
    return std::nullopt;
  Twist velocity;
  for (std::size_t i = 0; i < kVelocity; ++i) {
    const auto number = number_of(fields[first + i], place, kVelocityNames[i]);
    if (!number) return tl::unexpected(number.error());
    velocity[static_cast<Eigen::Index>(i)] = *number;
  }
  return velocity;
}

/// Of a line.
struct Place {
  std::string words;        ///< what a refusal begins with
  std::size_t columns = 0;  ///< as the header names them; 0: any form is accepted
};

Result<View> view_of(std::string_view line, const Place& at, const std::filesystem::path& folder,
                     std::vector<std::string>& notes) {
  const std::string& place = at.words;
  const auto fields = split_fields(line);
  if (!fields) return fail(place + "a quote is not closed, or text follows it; " + kAccepted);
  const std::size_t count = fields->size();
  const bool moving = count >= kFields + kVelocity,
             turned = (count - (moving ? kVelocity : 0)) == kFields + 1;
  if (count != kFields + (turned ? 1 : 0) + (moving ? kVelocity : 0))
    return fail(place + "has " + std::to_string(count) + " fields; " + kAccepted);
  if (at.columns != 0 && count != at.columns)
    return fail(place + "has " + std::to_string(count) + " fields; as many as the header's, " +
                std::to_string(at.columns) + ", are accepted");
  if (fields->front().empty()) return fail(place + "names no image; " + kAccepted);
  const auto X_MC = pose_of(*fields, place, notes);
  if (!X_MC) return tl::unexpected(X_MC.error());
  View view{.image = folder / fields->front(), .X_MC = *X_MC};
  if (turned) {
    const auto turn = number_of(fields->at(kFields), place, "turn_rad");
    if (!turn) return tl::unexpected(turn.error());
    view.turn_rad = *turn;
  }
  if (!moving) return view;
  const auto velocity = velocity_of(*fields, count - kVelocity, place);
  if (!velocity) return tl::unexpected(velocity.error());
  view.velocity = *velocity;
  return view;
}

bool is_header(std::string_view line) {
  const auto fields = split_fields(line);
  return fields && fields->front() == "image";
}

/// How many fields a line has where the header names a velocity, else 0. Six numbers in another order or unit
/// would pass for one, so its names are looked at.
Result<std::size_t> columns_of(std::string_view header, const std::string& place) {
  const auto names = split_fields(header);
  if (!names || names->size() < kFields + kVelocity) return std::size_t{0};
  for (std::size_t i = 0; i < kVelocity; ++i)
    if (const std::string& name = names->at(names->size() - kVelocity + i); name != kVelocityNames[i])
      return fail(place + "the column " + kVelocityNames[i] + " is named \"" + name + "\"; " + kAccepted);
  return names->size();
}

}  // namespace

Result<void> check_turns(const std::vector<View>& views, const ScopeModel& scope,
                         const std::filesystem::path& file) {
  const auto turned = std::ranges::find_if(views, [](const View& view) { return view.turn_rad != 0; });
  if (scope.turning || turned == views.end()) return {};
  return fail(file.string() + ": the scope's light post was turned in " + turned->image.filename().string() +
              ", but the passport has no [turning]; the passport of a scope that turns is accepted");
}

Result<ViewsFile> read_views(const std::filesystem::path& file) {
  const auto bytes = read_whole_file(file, kLargestFileBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  TextCursor cursor(text);
  ViewsFile read;
  std::size_t columns = 0;
  for (bool first = true; !cursor.at_end();) {
    const std::string_view line = cursor.line();
    if (trimmed(line).empty()) continue;
    const std::string place = file.string() + ":" + std::to_string(cursor.line_number()) + ": ";
    if (std::exchange(first, false) && is_header(line)) {
      const auto named = columns_of(line, place);
      if (!named) return tl::unexpected(named.error());
      columns = *named;
      continue;
    }
    auto view = view_of(line, {place, columns}, file.parent_path(), read.notes);
    if (!view) return tl::unexpected(view.error());
    read.views.push_back(std::move(*view));
  }
  if (read.views.empty()) return fail(file.string() + " holds no views; at least one line " + kAccepted);
  return read;
}

}  // namespace orcart
