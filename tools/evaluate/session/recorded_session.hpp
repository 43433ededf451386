// A session file as the evaluation wants it: what pictures were painted by, and the captures one by one.
#pragma once

#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/session/session_reader.hpp"
#include "tools/evaluate/consistency.hpp"

namespace orcart {

/// One thread; pictures are read when they are asked for, so a long session needs no more memory.
class RecordedSession {
 public:
  /// Refuses what is no session file, or holds no passport or registration that can be read.
  static Result<RecordedSession> open(const std::filesystem::path& file);

  /// The passport at the turn of the light post that the session was made with.
  const ScopeModel& scope() const { return scope_; }
  double turn_rad() const { return turn_rad_; }
  /// The light post was turned during the session as well: each capture has its own turn since scope()'s.
  bool turned_on_the_way() const;
  /// Standard deviation of tracker against video, s, where cart.toml told one.
  std::optional<double> time_deviation_s() const { return time_deviation_s_; }
  /// Of a light post's turn, rad, as the cart reckoned with it; nothing of a scope that does not turn.
  std::optional<double> turn_deviation_rad() const { return turn_deviation_rad_; }
  const RegistrationFile& registration() const { return registration_; }
  const std::string& surface_hash() const { return surface_hash_; }
  /// In the order of painting, those that were undone left out.
  const std::vector<StoredCapture>& captures() const { return captures_; }
  std::size_t undone() const { return undone_; }
  /// Of the picture's exposure, since the session began, s.
  double at_s(const StoredCapture& capture) const { return seconds(capture.exposure_start - started_at_); }
  /// The camera's own bytes.
  Result<StoredPicture> picture(const StoredCapture& capture) { return reader_.picture(capture.id); }
  /// Its luma as grey, through scope(). Refuses a picture that is not of the passport's size.
  Result<TakenPicture> taken(const StoredCapture& capture);

 private:
  explicit RecordedSession(SessionReader reader) : reader_(std::move(reader)) {}
  SessionReader reader_;
  std::string name_;
  ScopeModel scope_;
  RegistrationFile registration_;
  std::string surface_hash_;
  std::vector<StoredCapture> captures_;
  std::size_t undone_ = 0;
  Instant started_at_{};
  std::optional<double> time_deviation_s_, turn_deviation_rad_;
  double turn_rad_ = 0;
};

/// The brightness of each pixel, repeated in red, green and blue. Refuses bytes that do not fit the size.
Result<Picture> grey_of(const StoredPicture& stored);

}  // namespace orcart
