// Bugs put in on purpose, one each kind, to show that its guard catches it and names the place.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/latency/bench_cart.hpp"

namespace orcart {

enum class SeededBug : std::uint8_t {
  alloc,    ///< memory from the heap in the mapper's step
  lock,     ///< a mutex in the tracker's step
  write,    ///< a system call in the camera's step
  fault,    ///< a page never touched before, in the pedal's step
  late,     ///< the mapper's step takes twice its bound
  edge,     ///< the driver loses a pedal edge
  relaxed,  ///< the queue publishes with a relaxed store
};
inline constexpr int kSeededBugs = 7;
std::string_view name_of(SeededBug bug);

struct BugHunt {
  bool caught = false;
  std::string account;  ///< what the guard said, place included; or why it said nothing
};

/// Runs a cart (alloc to late: about six seconds on the wall clock), a pedal under the simulated clock
/// (edge), or the model checker beside this program (relaxed) with the bug in it. Errors are those of a cart
/// that cannot run.
Result<BugHunt> hunt(SeededBug bug, const CartConfig& config);

}  // namespace orcart
