// Whether a session's captures fit together, pair by pair and over time, without landmarks.
#pragma once

#include <optional>

#include "tools/evaluate/evaluate_command.hpp"
#include "tools/evaluate/session/capture_velocities.hpp"
#include "tools/evaluate/session/recorded_session.hpp"

namespace orcart {

struct SessionCommand {
  std::filesystem::path session, surface, scope_rom, reference_rom;
  SeenFrom seen_from = SeenFrom::inside;
  ErrorModel model;
  int earlier = 3;  ///< each capture is compared with so many before it
  std::uint64_t seed = 1;
  std::filesystem::path page;  ///< a folder for the page; empty: none
};

/// Two captures that see one place, and when.
struct SessionPair {
  PairReport pair;
  double first_s = 0, second_s = 0;  ///< their exposures, since the session began
};

/// Between two captures that follow each other: what the pairs say that reach across. A reference that
/// slipped there puts all of them apart.
struct SessionGap {
  std::string after, before;
  double from_s = 0, to_s = 0;
  std::size_t pairs = 0, alarms = 0;
};

struct SessionReport {
  ErrorModel model;  ///< with what the session's passport and registration state
  std::string session, surface;
  std::size_t captures = 0, undone = 0;
  std::vector<SessionPair> pairs;   ///< with patches to compare
  std::size_t without_overlap = 0;  ///< pairs that see nothing together
  /// Pairs that see one place, of which no patch matches: a shift beyond the search's reach, other light, or
  /// nothing to hold on to.
  std::size_t unmatched = 0;
  std::vector<SessionGap> gaps;  ///< in time
  VelocitySources velocities;    ///< of the captures, which the time's error is multiplied by
  std::vector<std::string> notes;
  double seconds = 0;

  std::size_t alarms() const;
  /// The gap that most pairs put apart: at least two, and all that reach across it; nothing where there is
  /// none.
  std::optional<SessionGap> break_in_time() const;
};

/// Passport and registration are the session's own. Refuses another surface than the session's, and fewer
/// than two captures.
Result<SessionReport> evaluate_session(const SessionCommand& command, const EvaluateProgress& progress);

std::string text_of(const SessionReport& report);
std::string json_of(const SessionReport& report);
/// DIR/consistency.html and DIR/consistency.json.
Result<void> write_page(const std::filesystem::path& dir, const SessionReport& report);

}  // namespace orcart
