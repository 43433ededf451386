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
constexpr std::size_t kFields = 13;
constexpr const char* kAccepted =
    "image,m00,m01,...,m23 (a name and 12 numbers, and turn_rad where the scope turned) is accepted";

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

/// The pose of a line, made a rotation; `notes` takes what was mended.
Result<Pose<M, C>> pose_of(const std::vector<std::string>& fields, const std::string& place,
                           std::vector<std::string>& notes) {
  constexpr double kLargestDeviation = 0.01, kWorthTelling = 1e-6;
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> given;
  for (std::size_t i = 0; i + 1 < kFields; ++i) {
    const auto number = TextCursor::parse_number<double>(fields[i + 1]);
    if (!number || !std::isfinite(*number))
      return fail(place + "m" + std::to_string(i / 4) + std::to_string(i % 4) + " is \"" + fields[i + 1] +
                  "\"; a finite number is accepted");
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

Result<View> view_of(std::string_view line, const std::string& place, const std::filesystem::path& folder,
                     std::vector<std::string>& notes) {
  const auto fields = split_fields(line);
  if (!fields) return fail(place + "a quote is not closed, or text follows it; " + kAccepted);
  if (fields->size() != kFields && fields->size() != kFields + 1)
    return fail(place + "has " + std::to_string(fields->size()) + " fields; " + kAccepted);
  if (fields->front().empty()) return fail(place + "names no image; " + kAccepted);
  const auto X_MC = pose_of(*fields, place, notes);
  if (!X_MC) return tl::unexpected(X_MC.error());
  View view{.image = folder / fields->front(), .X_MC = *X_MC};
  if (fields->size() == kFields) return view;
  const auto turn = TextCursor::parse_number<double>(fields->back());
  if (!turn || !std::isfinite(*turn))
    return fail(place + "turn_rad is \"" + fields->back() + "\"; a finite number is accepted");
  view.turn_rad = *turn;
  return view;
}

bool is_header(std::string_view line) {
  const auto fields = split_fields(line);
  return fields && fields->front() == "image";
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
  for (bool first = true; !cursor.at_end();) {
    const std::string_view line = cursor.line();
    if (trimmed(line).empty()) continue;
    if (std::exchange(first, false) && is_header(line)) continue;
    const std::string place = file.string() + ":" + std::to_string(cursor.line_number()) + ": ";
    auto view = view_of(line, place, file.parent_path(), read.notes);
    if (!view) return tl::unexpected(view.error());
    read.views.push_back(std::move(*view));
  }
  if (read.views.empty()) return fail(file.string() + " holds no views; at least one line " + kAccepted);
  return read;
}

}  // namespace orcart
