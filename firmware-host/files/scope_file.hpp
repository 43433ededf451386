// scope.toml, the calibration passport, and registration.toml.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "realtime/base/result.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

/// [covariance] is optional, and so is each of its keys. lens: of fx fy cx cy, as many coefficients as were
/// free, in their order, and for poly4 the distortion centre, in the units of [lens]. hand_eye: 6x6, of a
/// small motion of the camera in its own axes and about its own origin: X_SC exp(twist), x y z in mm, then
/// the rotation vector in rad. Both row by row; what is not symmetric and positive semi-definite is refused.
///
/// All errors at once, each with its line; unknown keys are refused; a lens that is not monotone to the
/// mask's edge is refused. `notes` takes what was mended, e.g. a pose that was nearly a rotation.
Result<ScopeModel> read_scope(const std::filesystem::path& file, std::vector<std::string>* notes = nullptr);
/// The same from text, as a session keeps it; `file` is only for messages.
Result<ScopeModel> read_scope_text(std::string_view text, const std::filesystem::path& file);
/// Atomic; every number is written in the fewest digits that give it back.
Result<void> write_scope(const std::filesystem::path& file, const ScopeModel& scope);

struct RegistrationFile {
  Pose<M, R> X_MR;
  std::string surface_hash;  ///< of the surface it belongs to; a mismatch is refused by the cart
  double fre_mm = 0;         ///< fiducial registration error, RMS
  double predicted_tre_mm = 0;
  /// Of X_MR: a twist in R (mm, rad), 6x6 row by row in the file; nothing where it is not known.
  std::optional<TwistCovariance> covariance;
};
Result<RegistrationFile> read_registration(const std::filesystem::path& file,
                                           std::vector<std::string>* notes = nullptr);
Result<void> write_registration(const std::filesystem::path& file, const RegistrationFile& registration);

}  // namespace orcart
