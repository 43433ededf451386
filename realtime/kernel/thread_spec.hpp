// What a thread is to be: its rate, its priority, its processor, and what it does when it is late.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "realtime/base/instant.hpp"

namespace orcart {

enum class OverrunPolicy : std::uint8_t {
  skip_keep_phase,  ///< the periods that passed are skipped; the next turn is on the old grid
  run_late,         ///< every period gets its turn, back to back until the grid is caught up with
};

struct ThreadSpec {
  std::string_view name;  ///< at most 15 characters are shown by the system
  double rate_hz = 0;     ///< 0: no period of its own, woken by its WakeSource only
  int fifo_priority = 0;  ///< SCHED_FIFO 1..99; 0: the ordinary scheduler
  int cpu = -1;           ///< the processor it stays on; -1: any
  std::size_t stack_bytes = 512 * 1024;
  OverrunPolicy overrun = OverrunPolicy::skip_keep_phase;
  Nanos event_timeout = 10ms;  ///< with a WakeSource: steps at least this often, and so stops within it
};

}  // namespace orcart
