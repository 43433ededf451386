// Statements are prepared once; each public write is one transaction.
#include "firmware-host/session/session_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <utility>

#include "firmware-host/session/picture_bytes.hpp"
#include "firmware-host/session/session_schema.hpp"

namespace orcart {
namespace {

/// Creates the file before SQLite does, for its mode; SQLite gives its -wal and -shm files the same one. The
/// folder is synchronised too, else a lost power supply could take the name away.
Result<void> create_private_file(const std::filesystem::path& file) {
  const int fd = open(file.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (fd < 0 && errno == EEXIST)
    return fail(file.string() +
                " exists already; a session is never written over: name another file, or a folder");
  if (fd < 0)
    return fail(file.string() + ": cannot create the session file (" + std::strerror(errno) +
                "); name a file in a folder that exists and may be written to");
  close(fd);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int folder_fd = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_fd < 0) return {};  // may be written to but not read: the name cannot be secured
  fsync(folder_fd);
  close(folder_fd);
  return {};
}

Result<void> write_meta(Database& database, const SessionMeta& meta) {
  auto statement = database.prepare("INSERT INTO meta(key, value) VALUES(?1, ?2)");
  if (!statement) return tl::unexpected(statement.error());
  const std::array<std::pair<std::string_view, std::string_view>, 4> texts{{
      {"application", meta.application},
      {"application_version", meta.application_version},
      {"config_hash", meta.config_hash},
      {"started_utc", meta.started_utc},
  }};
  for (const auto& [key, value] : texts)
    if (const auto done = statement->with(key, value).step(); !done) return tl::unexpected(done.error());
  if (const auto done = statement->with(std::string_view("started_ns"), meta.started_at).step(); !done)
    return tl::unexpected(done.error());
  constexpr Nanos kNotTold{-1};
  const auto nrad = [](double rad) { return std::llround(1e9 * rad); };
  const std::array<std::pair<std::string_view, std::int64_t>, 4> numbers{{
      {"tracker_against_video_ns", meta.tracker_against_video.count()},
      {"tracker_against_video_deviation_ns", meta.tracker_against_video_deviation.value_or(kNotTold).count()},
      {"turn_nrad", nrad(meta.turn_rad)},
      {"turn_deviation_nrad", meta.turn_deviation_rad ? nrad(*meta.turn_deviation_rad) : kNotTold.count()},
  }};
  for (const auto& [key, value] : numbers)
    if (const auto done = statement->with(key, value).step(); !done) return tl::unexpected(done.error());
  return {};
}

Result<void> set_up(Database& database, const SessionMeta& meta) {
  const auto opened = database.run("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; BEGIN IMMEDIATE;");
  if (!opened) return opened;
  const auto made =
      database.run("PRAGMA application_id = " + std::to_string(kSessionApplicationId) +
                   "; PRAGMA user_version = " + std::to_string(kSessionSchemaVersion) + ";" + kSessionTables);
  if (!made) return made;
  if (const auto written = write_meta(database, meta); !written) return written;
  return database.run("COMMIT");
}

Result<void> done(const Result<bool>& stepped) {
  if (!stepped) return tl::unexpected(stepped.error());
  return {};
}

}  // namespace

Result<SessionWriter> SessionWriter::create(const std::filesystem::path& file, const SessionMeta& meta) {
  if (const auto made = create_private_file(file); !made) return tl::unexpected(made.error());
  const auto give_up = [&](const Error& error) {
    std::error_code ignored;
    for (const char* suffix : {"", "-wal", "-shm"}) std::filesystem::remove(file.string() + suffix, ignored);
    return tl::unexpected(error);
  };
  auto database = Database::open(file, Database::Mode::write);
  if (!database) return give_up(database.error());
  if (const auto ready = set_up(*database, meta); !ready) return give_up(ready.error());
  auto statements = prepare(*database);
  if (!statements) return give_up(statements.error());
  return SessionWriter(file, std::move(*database), std::move(*statements));
}

SessionWriter::SessionWriter(std::filesystem::path file, Database database, Statements statements)
    : file_(std::move(file)), database_(std::move(database)), statements_(std::move(statements)) {}

Result<SessionWriter::Statements> SessionWriter::prepare(Database& database) {
  auto capture = database.prepare(
      "INSERT INTO captures VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, "
      "?17, ?18, "
      "?19, ?20, ?21, ?22, ?23, ?24, 0, ?25, ?26, ?27, ?28, ?29, ?30, ?31)");
  if (!capture) return tl::unexpected(capture.error());
  auto picture = database.prepare("INSERT INTO pictures VALUES(?1, ?2, ?3, ?4, ?5, ?6)");
  if (!picture) return tl::unexpected(picture.error());
  auto undone = database.prepare("UPDATE captures SET undone = 1 WHERE unit = ?1");
  if (!undone) return tl::unexpected(undone.error());
  auto budget = database.prepare("INSERT OR REPLACE INTO budgets VALUES(?1, ?2, ?3, ?4, ?5, ?6)");
  if (!budget) return tl::unexpected(budget.error());
  return Statements{.capture = std::move(*capture),
                    .picture = std::move(*picture),
                    .undone = std::move(*undone),
                    .budget = std::move(*budget)};
}

Result<void> SessionWriter::write_calibration(const SessionCalibration& calibration) {
  auto statement = database_.prepare(
      "INSERT INTO calibration(scope_toml, registration_toml, surface_hash) VALUES(?1, ?2, ?3)");
  if (!statement) return tl::unexpected(statement.error());
  const std::string_view scope = calibration.scope_toml, registration = calibration.registration_toml;
  return done(statement->with(scope, registration, std::string_view(calibration.surface_hash)).step());
}

Result<void> SessionWriter::write_budgets(std::span<const SessionBudget> budgets) {
  Result<void> written = database_.run("BEGIN IMMEDIATE");
  if (!written) return written;
  for (const SessionBudget& b : budgets) {
    if (!written) break;
    written = done(
        statements_.budget.with(std::string_view(b.stage), b.count, b.p50, b.p99, b.max, b.misses).step());
  }
  return finish(written);
}

// A unit that was taken back gets no more pictures, so the marks may come after the whole batch.
Result<std::size_t> SessionWriter::write_pending(CaptureSlots& slots) {
  auto note = slots.next();
  if (!note && undone_.empty()) return 0;
  const std::int64_t before = captures_;
  std::uint64_t taken = 0;
  Result<void> written = database_.run("BEGIN IMMEDIATE");
  for (; note; note = slots.next()) {
    if (note->kind == SessionNote::Kind::undone) {
      undone_.push_back(note->unit);
      continue;
    }
    ++taken;
    if (written) written = write_capture(slots[note->slot]);
    slots.give_back(note->slot);
  }
  if (written) written = mark_undone();
  const Result<void> finished = finish(written);
  if (!finished) {
    captures_ = before;
    lost_ += taken;
    return tl::unexpected(finished.error());
  }
  undone_.clear();
  return static_cast<std::size_t>(captures_ - before);
}

Result<void> SessionWriter::mark_undone() {
  for (const std::uint32_t unit : undone_)
    if (const auto marked = done(statements_.undone.with(unit).step()); !marked) return marked;
  return {};
}

Result<void> SessionWriter::write_capture(const CaptureSlot& slot) {
  const CaptureFacts& f = slot.facts;
  const Eigen::Matrix3d& r = f.X_MC.rotation;
  const Eigen::Vector3d& t = f.X_MC.translation_mm;
  const auto v = [&f](int i) { return f.velocity ? std::optional((*f.velocity)[i]) : std::nullopt; };
  const std::int64_t id = captures_ + 1;
  const auto row = statements_.capture
                       .with(id, f.unit, f.streaming ? 1 : 0, slot.frame.sequence, f.edge_at,
                             slot.frame.exposure_start, slot.frame.exposure_end, slot.frame.dequeued_at,
                             f.matched_at, f.painted_at, static_cast<int>(f.pose_kind), f.pose_distance,
                             r(0, 0), r(0, 1), r(0, 2), t(0), r(1, 0), r(1, 1), r(1, 2), t(1), r(2, 0),
                             r(2, 1), r(2, 2), t(2), f.turn_rad, v(0), v(1), v(2), v(3), v(4), v(5))
                       .step();
  if (!row) return tl::unexpected(row.error());
  const ImageDescriptor& image = slot.frame.image;
  const auto picture =
      statements_.picture
          .with(id, image.width_px, image.height_px, static_cast<std::uint32_t>(image.format),
                kPictureEncoding, deflated(slot.picture(), deflate_buffer_))
          .step();
  if (!picture) return tl::unexpected(picture.error());
  captures_ = id;
  return {};
}

void SessionWriter::leave_wal() {
  (void)database_.run("PRAGMA journal_mode = DELETE");
}

Result<void> SessionWriter::finish(const Result<void>& written) {
  Result<void> result = written;
  if (result) result = database_.run("COMMIT");
  if (!result) (void)database_.run("ROLLBACK");  // fails where SQLite has taken everything back by itself
  return result;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

}  // namespace orcart
