// Writes the session file: one SQLite database in WAL mode whose every commit is on disk before it returns.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware-host/session/capture_slots.hpp"
#include "firmware-host/session/session_records.hpp"
#include "firmware-host/session/sqlite.hpp"

namespace orcart {

/// One thread that is not a real-time one. Whatever fails is returned as one sentence and leaves the file as
/// it was before the call; the next call may succeed (a disk that was full may have room again). Nothing here
/// may stop the live view.
class SessionWriter {
 public:
  /// Makes a new file that only its owner may read (mode 0600); one that exists is refused, never written
  /// over.
  static Result<SessionWriter> create(const std::filesystem::path& file, const SessionMeta& meta);

  Result<void> write_calibration(const SessionCalibration& calibration);
  /// Replaces what was said of the same stages before.
  Result<void> write_budgets(std::span<const SessionBudget> budgets);
  /// Takes everything that waits, in one transaction, durable on return; gives every slot back whatever
  /// happens. Returns how many captures were written. After an error none of them was, and lost() counts
  /// them; what was taken back is kept in mind and written by the next call that succeeds.
  Result<std::size_t> write_pending(CaptureSlots& slots);
  /// Captures that write_pending() took and could not write.
  std::uint64_t lost() const { return lost_; }

  /// Last: leaves WAL mode, so that the file may be read where nothing may be written. Where somebody has it
  /// open meanwhile it stays as it is, and whole.
  void leave_wal();

  const std::filesystem::path& file() const { return file_; }

 private:
  struct Statements {
    Statement capture, picture, undone, budget;
  };
  SessionWriter(std::filesystem::path file, Database database, Statements statements);
  static Result<Statements> prepare(Database& database);
  Result<void> write_capture(const CaptureSlot& slot);
  Result<void> mark_undone();
  /// Commits where `written` holds, else takes everything back.
  Result<void> finish(const Result<void>& written);

  std::filesystem::path file_;
  Database database_;
  Statements statements_;  // after database_: they go first
  std::vector<std::byte> deflate_buffer_;
  std::vector<std::uint32_t> undone_;  ///< units taken back, of which the file does not know yet
  std::int64_t captures_ = 0;
  std::uint64_t lost_ = 0;
};

/// The wall clock as ISO 8601, to the second: "2026-05-04T09:30:00Z".
std::string utc_now();

}  // namespace orcart
