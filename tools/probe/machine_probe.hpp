// What the file system of a Linux machine tells: trackers on USB, the kernel's kind, rights to real time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "tools/probe/findings.hpp"

namespace orcart {

/// What the process may do, asked of the kernel; numbers by hand in tests.
struct ProcessRights {
  std::uint64_t locked_memory_bytes = 0;  ///< RLIMIT_MEMLOCK
  bool fifo = false;                      ///< SCHED_FIFO was asked for at the pedal's priority, and granted
  bool root = false;
};
ProcessRights rights_of_this_process();

/// What orcartd opens, NDI's own USB ids and plain FTDI bridges, below `root`/sys/bus/usb, with serial number
/// and port path.
std::vector<Finding> probe_trackers(const std::filesystem::path& root);
/// PREEMPT_RT or not, isolated processors, frequency governor, rights to lock memory and to SCHED_FIFO.
std::vector<Finding> probe_system(const std::filesystem::path& root, const ProcessRights& rights);

}  // namespace orcart
