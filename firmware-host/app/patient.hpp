// What a procedure needs from files, read, checked against each other and laid out before anything is armed.
#pragma once

#include <string>
#include <vector>

#include "firmware-host/app/cart_config.hpp"
#include "firmware-host/files/scope_file.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "realtime/optics/scope_model.hpp"
#include "render/atlas/atlas_layout.hpp"

namespace orcart {

/// The patient's surface with its atlas, the scope's passport, the registration. Immutable once read.
struct Patient {
  Surface surface;
  ScopeModel scope;  ///< at the turn that was said; where it is followed, at the passport's own
  RegistrationFile registration;
  AtlasLayout layout;
  std::string painting_blocked;    ///< why nothing may be painted; empty where it may
  std::vector<std::string> notes;  ///< sentences for the log: what was mended or noticed
};

/// Refuses a registration that belongs to another surface, and a passport that does not fit the camera's size
/// or the scope, has expired or is beyond its limits. Another medium, and a scope that turns
/// and of which nobody said how far, block painting alone. A scope that is to be
/// followed by what its passport does not hold is refused.
Result<Patient> read_patient(const CartConfig& config);

}  // namespace orcart
