// Tells of steps over their hard bound as they happen: each stage by name, and no stage more often than a
// person can read.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "firmware-host/app/topology.hpp"

namespace orcart {

/// One thread, off the real-time path.
class BudgetLog {
 public:
  /// Between two lines of a stage: twice as long each time, so that a stage which misses all day fills no
  /// log.
  static constexpr Nanos kFirstPause = 1s, kLongestPause = 64s;

  /// Sentences about what is new since the last one of each stage; nothing while all are within their bounds.
  std::vector<std::string> news(const std::array<StageLedger, kStageCount>& ledgers, Instant now);

 private:
  std::array<std::uint64_t, kStageCount> told_{};
  std::array<Instant, kStageCount> next_{};
  std::array<Nanos, kStageCount> pause_{};
};

}  // namespace orcart
