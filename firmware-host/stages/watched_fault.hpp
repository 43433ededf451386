// What is wrong with a stage's device, for whoever logs it: written by the stage's thread, read by any.
#pragma once

#include <atomic>

#include "board/ports/port_fault.hpp"

namespace orcart {

class WatchedFault {
 public:
  void set(PortFault fault) noexcept { fault_.store(fault, std::memory_order_relaxed); }  // a word alone
  void clear() noexcept { set(PortFault::nothing_yet); }
  /// nothing_yet: the device works.
  PortFault get() const noexcept { return fault_.load(std::memory_order_relaxed); }  // partner: set()

 private:
  std::atomic<PortFault> fault_{PortFault::nothing_yet};
};

}  // namespace orcart
