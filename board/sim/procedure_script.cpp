// The script's hash.
#include "board/sim/procedure_script.hpp"

#include "board/sim/fingerprint.hpp"

namespace orcart {

std::uint64_t fingerprint(const ProcedureScript& script) {
  Fingerprint print;
  print.add(script.seed).add(script.seen_from);
  for (int i = 0; i < 3; ++i) print.add(script.entry_direction[i]);
  for (const double number : {script.duration_s, script.entry_distance_mm, script.press_every_s,
                              script.rest_s, script.undo_at, script.stream_at, script.hide_at, script.bump_at,
                              script.room_mm, script.widest_pivot_rad, script.sway_rad, script.tremor_mm})
    print.add(number);
  if (script.turn_rad != 0) print.add(script.turn_rad).add(script.turn_every_s);
  return print.value();
}

}  // namespace orcart
