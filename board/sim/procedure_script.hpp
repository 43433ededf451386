// What happens in a simulated procedure: how long, from where the scope comes, when the pedal is pressed,
// what goes wrong.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// The same script, surface and scope give the same procedure. Instants are shares of the duration; below 0:
/// never.
struct ProcedureScript {
  std::uint64_t seed = 1;
  double duration_s = 30;
  SeenFrom seen_from = SeenFrom::inside;
  /// From the surface's centre to where the scope comes from (burr hole, craniotomy), M; any length. This one
  /// is about Frazier's point: posterior, along the right lateral ventricle's long axis.
  Eigen::Vector3d entry_direction{-0.28, 0.82, 0.50};
  /// Inside: from the surface's outermost point along the direction to the burr hole.
  double entry_distance_mm = 45;
  double press_every_s = 1.75;  ///< the scope moves to a new place, rests, and the pedal is pressed
  double rest_s = 0.5;          ///< how long it rests there
  double undo_at = 0.45;        ///< a double press: takes back the capture before
  double stream_at = 0.62;      ///< the pedal is held for 1.3 s while the scope moves on
  double hide_at = 0.80;        ///< the tracker does not see the scope for 1.1 s while it moves on
  double bump_at = -1;          ///< the reference (with its patient, in the tracker's eyes) is moved by 12 mm
  double room_mm = 2.0;         ///< least distance from C to the wall: half a 2.7 mm shaft and a little
  double widest_pivot_rad = 0.28;  ///< inside: how far the shaft may lean about the burr hole
  double sway_rad = 0.35;          ///< slow rotation about the shaft, to each side
  double turn_rad = 0;             ///< an angled scope's light post is turned to and fro, so far to each side
  double turn_every_s = 8;         ///< once to and fro, evenly, from no turn on
  double hide_second_at = -1;      ///< the tracker does not see the second marker for 1.1 s
  double slip_second_at = -1;      ///< the second marker slips about the shaft, and stays so
  double slip_second_rad = 0;      ///< by so much, as if the light post had turned
  double tremor_mm = 0.03;         ///< of the hand, about 9 Hz; its slow drift is five times as large
};

/// A hash of everything above that can be seen in the pictures: two scripts with the same one look the same.
std::uint64_t fingerprint(const ProcedureScript& script);

}  // namespace orcart
