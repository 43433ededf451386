// The tables of a session file, and the numbers that say which form they have.
#pragma once

#include <cstdint>

namespace orcart {

inline constexpr std::int64_t kSessionApplicationId = 0x6F726374;  ///< "orct", in the file's own header
inline constexpr std::int64_t kSessionSchemaVersion =
    3;  ///< PRAGMA user_version; 1 had no turn_rad, 2 no velocity; older files also have a table that nothing
        ///< wrote

/// Times are nanoseconds on the monotonic clock; m00..m23 the rows of X_MC as in views.csv, millimetres;
/// v0..v5 a twist of C a second (mm/s, rad/s), NULL where it is not known.
inline constexpr const char* kSessionTables = R"sql(
CREATE TABLE meta(key TEXT PRIMARY KEY, value) WITHOUT ROWID;
CREATE TABLE calibration(id INTEGER PRIMARY KEY, scope_toml TEXT, registration_toml TEXT, surface_hash TEXT);
CREATE TABLE captures(
  id INTEGER PRIMARY KEY, unit INTEGER, streaming INTEGER, frame_sequence INTEGER, edge_ns INTEGER,
  exposure_start_ns INTEGER, exposure_end_ns INTEGER, dequeued_ns INTEGER, matched_ns INTEGER, painted_ns INTEGER,
  pose_kind INTEGER, pose_distance_ns INTEGER,
  m00 REAL, m01 REAL, m02 REAL, m03 REAL, m10 REAL, m11 REAL, m12 REAL, m13 REAL,
  m20 REAL, m21 REAL, m22 REAL, m23 REAL, undone INTEGER DEFAULT 0, turn_rad REAL DEFAULT 0,
  v0 REAL, v1 REAL, v2 REAL, v3 REAL, v4 REAL, v5 REAL);
CREATE INDEX captures_by_unit ON captures(unit);
CREATE TABLE pictures(
  capture INTEGER PRIMARY KEY REFERENCES captures(id), width_px INTEGER, height_px INTEGER, fourcc INTEGER,
  encoding TEXT, bytes BLOB);
CREATE TABLE budgets(
  stage TEXT PRIMARY KEY, count INTEGER, p50_ns INTEGER, p99_ns INTEGER, max_ns INTEGER, misses INTEGER);
)sql";

}  // namespace orcart
