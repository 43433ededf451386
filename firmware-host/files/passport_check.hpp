// Whether a calibration passport may be used: its dates, its residuals, its scope and its medium.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "realtime/base/result.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

/// What a cart wants of a passport.
struct PassportWish {
  std::optional<Medium> medium;  ///< what the scope will be used in; unset: nobody has said
  std::string serial;            ///< of the scope in hand; empty: not compared
  double most_residual_px = 1.0;
  double most_residual_mm = 2.0;
};

/// Refuses a passport that has expired on `today` (ISO date) or, where it can expire, is dated after it;
/// whose residuals are beyond the limits, that has no hand-eye yet, or that belongs to another scope. `file`
/// is for the sentence.
Result<void> check_passport(const ScopeModel& scope, const PassportWish& wish, std::string_view today,
                            const std::filesystem::path& file);

/// Why painting is blocked though all else may run: the medium is not the passport's, or nobody has said
/// which it is. Empty where it fits. At most 54 letters: so many fit the panel.
std::string medium_objection(Medium calibrated_in, std::optional<Medium> used_in);

std::string_view word_for(Medium medium);

/// Today in UTC as an ISO date.
std::string iso_today();

}  // namespace orcart
