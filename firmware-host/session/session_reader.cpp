// Rows back into the cart's words.
#include "firmware-host/session/session_reader.hpp"

#include <utility>

#include "firmware-host/session/picture_bytes.hpp"
#include "firmware-host/session/session_schema.hpp"

namespace orcart {
namespace {

constexpr std::int64_t kLargestSide_px = 16384;

/// Every row of a query, each read by `row_of`.
template <class Row, class RowOf>
Result<std::vector<Row>> all_rows(Database& database, std::string_view sql, RowOf row_of) {
  auto statement = database.prepare(sql);
  if (!statement) return tl::unexpected(statement.error());
  std::vector<Row> rows;
  for (;;) {
    const auto more = statement->step();
    if (!more) return tl::unexpected(more.error());
    if (!*more) return rows;
    rows.push_back(row_of(*statement));
  }
}

/// Nothing beside it waits to be taken into the file. In a folder that may not be written to SQLite opens no
/// file in WAL mode, though such a one is whole.
bool is_alone(const std::filesystem::path& file) {
  std::error_code ignored;
  return !std::filesystem::exists(file.string() + "-wal", ignored) &&
         !std::filesystem::exists(file.string() + "-journal", ignored);
}

StoredCapture capture_of(const Statement& row) {
  StoredCapture capture{.id = row.integer(0)};
  capture.facts = {.unit = static_cast<std::uint32_t>(row.integer(1)),
                   .streaming = row.integer(2) != 0,
                   .edge_at = row.instant(4),
                   .matched_at = row.instant(8),
                   .painted_at = row.instant(9),
                   .X_MC = {},
                   .pose_kind = static_cast<PoseKind>(row.integer(10)),
                   .pose_distance = Nanos{row.integer(11)}};
  capture.frame_sequence = static_cast<std::uint32_t>(row.integer(3));
  capture.exposure_start = row.instant(5);
  capture.exposure_end = row.instant(6);
  capture.dequeued_at = row.instant(7);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) capture.facts.X_MC.rotation(i, j) = row.number(12 + 4 * i + j);
    capture.facts.X_MC.translation_mm(i) = row.number(12 + 4 * i + 3);
  }
  capture.undone = row.integer(24) != 0;
  capture.facts.turn_rad = row.number(25);  // 0 where the file's form has none
  if (row.number_or_null(26)) {
    capture.facts.velocity.emplace();
    for (int i = 0; i < 6; ++i) (*capture.facts.velocity)[i] = row.number(26 + i);
  }
  return capture;
}

}  // namespace

SessionReader::SessionReader(std::filesystem::path file, Database database)
    : file_(std::move(file)), database_(std::move(database)) {}

Result<SessionReader> SessionReader::open(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    return fail(file.string() + " is no file; a session written by orcartd (*.orcart) is accepted");
  auto database = Database::open(file, Database::Mode::read);
  if (!database) return tl::unexpected(database.error());
  auto id = database->integer("PRAGMA application_id");
  if (!id && is_alone(file)) {
    if (auto again = Database::open(file, Database::Mode::read_only); again) {
      database = std::move(again);
      id = database->integer("PRAGMA application_id");
    }
  }
  if (!id) return fail(id.error().message + "; a session written by orcartd (*.orcart) is accepted");
  if (*id != kSessionApplicationId)
    return fail(file.string() + " is no session file; one written by orcartd (*.orcart) is accepted");
  const auto version = database->integer("PRAGMA user_version");
  if (!version) return tl::unexpected(version.error());
  if (*version < 1 || *version > kSessionSchemaVersion)
    return fail(file.string() + " has form " + std::to_string(*version) + "; forms 1 to " +
                std::to_string(kSessionSchemaVersion) + " are accepted");
  return SessionReader(file, std::move(*database));
}

Result<SessionMeta> SessionReader::meta() {
  SessionMeta meta;
  const std::pair<const char*, std::string*> texts[] = {{"application", &meta.application},
                                                        {"application_version", &meta.application_version},
                                                        {"config_hash", &meta.config_hash},
                                                        {"started_utc", &meta.started_utc}};
  for (const auto& [key, value] : texts) {
    auto text = database_.text("SELECT value FROM meta WHERE key = '" + std::string(key) + "'");
    if (!text) return tl::unexpected(text.error());
    *value = std::move(*text);
  }
  const auto started = database_.integer("SELECT value FROM meta WHERE key = 'started_ns'");
  if (!started) return tl::unexpected(started.error());
  meta.started_at = instant_from_nanos(*started);
  const auto shift =
      database_.integer("SELECT value FROM meta WHERE key = 'tracker_against_video_ns'");  // 0 where absent
  if (!shift) return tl::unexpected(shift.error());
  meta.tracker_against_video = Nanos{*shift};
  const auto deviation = database_.integer(
      "SELECT COALESCE((SELECT value FROM meta WHERE key = 'tracker_against_video_deviation_ns'), -1)");
  if (!deviation) return tl::unexpected(deviation.error());
  if (*deviation >= 0) meta.tracker_against_video_deviation = Nanos{*deviation};
  const auto turn = database_.integer("SELECT value FROM meta WHERE key = 'turn_nrad'");
  if (!turn) return tl::unexpected(turn.error());
  meta.turn_rad = 1e-9 * static_cast<double>(*turn);
  const auto turn_deviation =
      database_.integer("SELECT COALESCE((SELECT value FROM meta WHERE key = 'turn_deviation_nrad'), -1)");
  if (!turn_deviation) return tl::unexpected(turn_deviation.error());
  if (*turn_deviation >= 0) meta.turn_deviation_rad = 1e-9 * static_cast<double>(*turn_deviation);
  return meta;
}

Result<SessionCalibration> SessionReader::calibration() {
  auto rows = all_rows<SessionCalibration>(
      database_,
      "SELECT scope_toml, registration_toml, surface_hash FROM calibration ORDER BY id DESC LIMIT 1",
      [](const Statement& row) {
        return SessionCalibration{
            .scope_toml = row.text(0), .registration_toml = row.text(1), .surface_hash = row.text(2)};
      });
  if (!rows) return tl::unexpected(rows.error());
  if (rows->empty()) return fail(file_.string() + " holds no calibration");
  return std::move(rows->front());
}

Result<std::vector<StoredCapture>> SessionReader::captures() {
  return all_rows<StoredCapture>(database_, "SELECT * FROM captures ORDER BY id", capture_of);
}

Result<StoredPicture> SessionReader::picture(std::int64_t capture_id) {
  auto statement = database_.prepare(
      "SELECT width_px, height_px, fourcc, encoding, bytes FROM pictures WHERE capture = ?1");
  if (!statement) return tl::unexpected(statement.error());
  const auto row = statement->with(capture_id).step();
  const std::string whose = file_.string() + ", capture " + std::to_string(capture_id) + ": ";
  if (!row) return tl::unexpected(row.error());
  if (!*row) return fail(whose + "there is no such capture");
  const std::int64_t width = statement->integer(0), height = statement->integer(1);
  if (width < 1 || height < 1 || width > kLargestSide_px || height > kLargestSide_px)
    return fail(whose + "a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                " is not believed");
  if (statement->text(3) != kPictureEncoding)
    return fail(whose + "encoding '" + statement->text(3) + "' is not known; " +
                std::string(kPictureEncoding) + " is accepted");
  StoredPicture picture{.width_px = static_cast<int>(width),
                        .height_px = static_cast<int>(height),
                        .format = static_cast<PixelFormat>(statement->integer(2)),
                        .bytes = {}};
  auto bytes =
      inflated(statement->bytes(4), packed_bytes(picture.format, picture.width_px, picture.height_px));
  if (!bytes) return fail(whose + bytes.error().message);
  picture.bytes = std::move(*bytes);
  return picture;
}

Result<std::vector<SessionBudget>> SessionReader::budgets() {
  return all_rows<SessionBudget>(
      database_, "SELECT stage, count, p50_ns, p99_ns, max_ns, misses FROM budgets ORDER BY rowid",
      [](const Statement& row) {
        return SessionBudget{.stage = row.text(0),
                             .count = static_cast<std::uint64_t>(row.integer(1)),
                             .p50 = Nanos{row.integer(2)},
                             .p99 = Nanos{row.integer(3)},
                             .max = Nanos{row.integer(4)},
                             .misses = static_cast<std::uint64_t>(row.integer(5))};
      });
}

Result<void> SessionReader::check() {
  const auto verdict = database_.text("PRAGMA integrity_check");
  if (!verdict) return tl::unexpected(verdict.error());
  if (*verdict != "ok") return fail(file_.string() + " is damaged: " + *verdict);
  return {};
}

}  // namespace orcart
