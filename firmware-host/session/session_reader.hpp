// Reads a session file again: for replay, for calibrating time and for painting from the recording.
#pragma once

#include <filesystem>
#include <vector>

#include "firmware-host/session/session_records.hpp"
#include "firmware-host/session/sqlite.hpp"

namespace orcart {

/// One thread. A file whose writer died is complete up to its last commit.
class SessionReader {
 public:
  /// Refuses what is no session file, or one of a later form than this program knows.
  static Result<SessionReader> open(const std::filesystem::path& file);

  Result<SessionMeta> meta();
  /// The newest.
  Result<SessionCalibration> calibration();
  Result<std::vector<StoredCapture>> captures();
  /// Refuses a picture whose checksum is wrong, by the capture's number.
  Result<StoredPicture> picture(std::int64_t capture_id);
  Result<std::vector<SessionBudget>> budgets();
  /// Goes through the whole file; the error names what is damaged.
  Result<void> check();

 private:
  SessionReader(std::filesystem::path file, Database database);

  std::filesystem::path file_;
  Database database_;
};

}  // namespace orcart
