// What a session file holds, in the words of the cart. No patient is named anywhere in it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "realtime/base/image.hpp"
#include "realtime/base/instant.hpp"
#include "realtime/geometry/twist.hpp"
#include "realtime/sync/captured_frame.hpp"
#include "realtime/sync/pose_sample.hpp"

namespace orcart {

/// What a file begins with; stays as it is.
struct SessionMeta {
  std::string application = "orcartd";
  std::string application_version;
  std::string config_hash;  ///< of cart.toml's bytes
  std::string started_utc;  ///< ISO 8601; the wall clock at `started_at`
  Instant started_at{};     ///< every instant in the file is on the same monotonic clock
  /// [sync] of the run: already added to mid-exposure where a capture's pose was looked up. Files from before
  /// it was kept have none, and read as 0.
  Nanos tracker_against_video{};
  /// Its standard deviation, where cart.toml told one.
  std::optional<Nanos> tracker_against_video_deviation;
  double turn_rad = 0;  ///< of the light post, as told before the run. To 1e-9; absent reads as 0
  /// Standard deviation of a light post's turn, by whatever told it. To 1e-9; nothing of a scope that does
  /// not turn, and in files from before it was kept.
  std::optional<double> turn_deviation_rad;
};

/// What pictures were painted by. Texts are the files' own.
struct SessionCalibration {
  std::string scope_toml;
  std::string registration_toml;
  std::string surface_hash;
};

/// One painted picture, beside its frame.
struct CaptureFacts {
  std::uint32_t unit = 0;
  bool streaming = false;
  Instant edge_at{};     ///< the pedal's edge
  Instant matched_at{};  ///< the pose bracket was in hand
  Instant painted_at{};
  Pose<M, C> X_MC;
  double turn_rad = 0;  ///< of the light post since the run's told turn; already in X_MC
  PoseKind pose_kind = PoseKind::none;
  Nanos pose_distance{};  ///< from mid-exposure to the nearest sample
  /// Of the camera by its marker's movement in the reference, about mid-exposure: mm/s, rad/s, in C. Nothing
  /// where the tracker's samples did not tell it, and in files from before it was kept.
  std::optional<Twist> velocity;
};

/// A capture as it is read again, without its picture.
struct StoredCapture {
  std::int64_t id = 0;  ///< counts from 1, in order of painting
  CaptureFacts facts;
  std::uint32_t frame_sequence = 0;
  Instant exposure_start{}, exposure_end{}, dequeued_at{};
  bool undone = false;
};

/// The camera's own bytes, tightly packed, exactly as they were painted.
struct StoredPicture {
  int width_px = 0, height_px = 0;
  PixelFormat format = PixelFormat::none;
  std::vector<std::byte> bytes;

  ImageDescriptor descriptor() { return packed_image(bytes.data(), format, width_px, height_px); }
};

/// How a stage kept its budget over the session.
struct SessionBudget {
  std::string stage;
  std::uint64_t count = 0;
  Nanos p50{}, p99{}, max{};
  std::uint64_t misses = 0;
};

}  // namespace orcart
