// Which of an evaluation's errors are assumed, and which the passport and the registration state.
#pragma once

#include <string>

#include "firmware-host/files/scope_file.hpp"
#include "tools/evaluate/error_model.hpp"

namespace orcart {

/// The model with the covariances that passport and registration carry in place of what is assumed; the
/// standard deviations of those parts then tell their size.
ErrorModel with_stated(const ErrorModel& assumed, const ScopeModel& scope,
                       const RegistrationFile& registration);

/// The time's standard deviation as somebody told it, or the session, in place of the assumed one.
ErrorModel with_time(const ErrorModel& assumed, double deviation_s, ErrorFrom from = ErrorFrom::told);
/// The same of a light post's turn, which with_stated() then leaves as it is.
ErrorModel with_turn(const ErrorModel& assumed, double deviation_rad, ErrorFrom from = ErrorFrom::told);
/// Refuses a turn's deviation that was told of a scope that does not turn.
Result<void> check_turn_told(const ErrorModel& model, const ScopeModel& scope);

/// Refuses a registration that states another surface; one that states none is let pass.
Result<void> check_surface(const RegistrationFile& registration, const std::string& surface_hash);

/// One line: each part's size, and in brackets where it comes from.
std::string sources_text(const ErrorModel& model);
/// {"hand-eye": "passport", "registration": "assumed", ...}
std::string sources_json(const ErrorModel& model);

}  // namespace orcart
