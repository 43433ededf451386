// Files that do not belong together are refused here, before a thread runs.
#include "firmware-host/app/patient.hpp"

#include "firmware-host/files/surface_file.hpp"
#include "realtime/optics/scope_turn.hpp"

namespace orcart {
namespace {

/// What a passport must hold for its scope to be followed.
Result<void> check_followed(const CartConfig& config, const ScopeModel& scope) {
  const bool by_marker = config.turn == TurnSource::marker, by_notch = config.turn == TurnSource::notch;
  const std::string place = config.scope.string() + ": the passport ";
  const std::string wanted = std::string("[scope] turn = \"") +
                             (by_marker  ? "marker"
                              : by_notch ? "notch"
                                         : "encoder") +
                             "\" needs";
  if (!scope.turning)
    return fail(place + "has no [turning], which " + wanted + "; run orcart calibrate turn");
  if (by_marker && !scope.turning->R_SL)
    return fail(place + "has no [turning] R_SL, the second marker's place at turn 0, which " + wanted +
                "; run orcart calibrate turn with --second-poses");
  if (by_notch && !scope.notch_rad)
    return fail(place + "has no [mask] notch_rad, which " + wanted +
                "; run orcart calibrate turn on pictures that show the notch");
  return {};
}

/// Puts the passport at the turn that was said. A scope that turns and of which nobody said how far is shown,
/// not painted with. One that is followed stays as it was calibrated.
Result<void> turn_scope(const CartConfig& config, Patient& patient) {
  constexpr const char* kSayIt = "PAINTING BLOCKED: say [scope] turn_deg or --turn";
  if (config.turn != TurnSource::told) {
    const bool unsaid = config.turn == TurnSource::encoder && !config.encoder.counts_at_zero &&
                        !config.turn_rad && !patient.scope.notch_rad;
    if (unsaid && patient.painting_blocked.empty()) patient.painting_blocked = kSayIt;
    return check_followed(config, patient.scope);
  }
  if (!patient.scope.turning) {
    if (!config.turn_rad && !config.turn_deviation_rad) return {};
    const std::string key = config.turn_rad ? "turn_deg" : "turn_deviation_deg";
    return fail(config.scope.string() + ": the passport has no [turning], so [scope] " + key +
                " means nothing; run orcart calibrate turn, or remove " + key);
  }
  if (!config.turn_rad && patient.painting_blocked.empty()) patient.painting_blocked = kSayIt;
  patient.scope = turned(patient.scope, config.turn_rad.value_or(0));
  return {};
}

void append(std::vector<std::string>& notes, const std::vector<std::string>& more) {
  notes.insert(notes.end(), more.begin(), more.end());
}

}  // namespace

Result<Patient> read_patient(const CartConfig& config) {
  Patient patient;
  SurfaceNotes notes;
  auto surface = read_surface(config.surface, &notes);
  if (!surface) return tl::unexpected(surface.error());
  patient.surface = std::move(*surface);
  patient.notes = std::move(notes.sentences);
  if (!patient.surface.closed && config.seen_from == SeenFrom::inside) {
    return fail(config.surface.string() +
                " is open, so it has no inside; seen_from = \"inside\" wants a closed surface");
  }

  std::vector<std::string> mended;
  auto scope = read_scope(config.scope, &mended);
  if (!scope) return tl::unexpected(scope.error());
  append(patient.notes, mended);
  patient.scope = std::move(*scope);
  if (patient.scope.width_px != config.camera.width_px ||
      patient.scope.height_px != config.camera.height_px) {
    return fail(config.scope.string() + " was calibrated at " + std::to_string(patient.scope.width_px) + "x" +
                std::to_string(patient.scope.height_px) + " pixels, [camera] asks for " +
                std::to_string(config.camera.width_px) + "x" + std::to_string(config.camera.height_px) +
                "; use the mode that was calibrated or calibrate this one");
  }

  if (auto fits = check_passport(patient.scope, config.passport, iso_today(), config.scope); !fits)
    return tl::unexpected(fits.error());
  // A procedure in which nothing is real has no medium to be asked for.
  if (config.any_device() || config.passport.medium)
    patient.painting_blocked = medium_objection(patient.scope.medium, config.passport.medium);
  if (auto at = turn_scope(config, patient); !at) return tl::unexpected(at.error());
  if (!patient.painting_blocked.empty()) patient.notes.push_back(patient.painting_blocked);

  auto registration = read_registration(config.registration, &mended);
  if (!registration) return tl::unexpected(registration.error());
  append(patient.notes, mended);
  patient.registration = std::move(*registration);
  if (patient.registration.surface_hash != patient.surface.identity.hash) {
    return fail(config.registration.string() + " belongs to the surface " +
                patient.registration.surface_hash + ", but " + config.surface.string() + " is " +
                patient.surface.identity.hash +
                "; register again on this surface, or load the one that was registered");
  }

  auto layout = build_atlas(patient.surface.mesh, {.texel_mm = config.texel_mm});
  if (!layout) return tl::unexpected(layout.error());
  patient.layout = std::move(*layout);
  if (patient.layout.texel_mm > config.texel_mm * 1.001) {
    patient.notes.push_back("The surface is large: a texel is " + std::to_string(patient.layout.texel_mm) +
                            " mm instead of " + std::to_string(config.texel_mm) + " mm.");
  }
  return patient;
}

}  // namespace orcart
