// When a fixed-rate loop is next due, in absolute time: pure arithmetic, so that an overrun is tested without
// sleeping.
#pragma once

#include <cstdint>

#include "realtime/base/instant.hpp"
#include "realtime/kernel/thread_spec.hpp"

namespace orcart {

/// The grid first, first + period, first + 2 periods, ... and where on it the loop stands. One thread.
class Pacer {
 public:
  /// `period` is positive.
  Pacer(Nanos period, OverrunPolicy policy, Instant first) noexcept
      : period_(period), policy_(policy), due_(first) {}

  /// When the next turn is due; always on the grid.
  Instant due() const noexcept { return due_; }

  /// The turn that was due is over. Moves due() on and returns the periods skipped. A slip is a turn that was
  /// not over when the next was due; one that ends exactly then is in time.
  std::uint64_t turn_over(Instant now) noexcept;

  std::uint64_t turns() const noexcept { return turns_; }
  std::uint64_t slips() const noexcept { return slips_; }
  std::uint64_t skipped() const noexcept { return skipped_; }  ///< periods without a turn
  Nanos period() const noexcept { return period_; }

 private:
  Nanos period_;
  OverrunPolicy policy_;
  Instant due_;
  std::uint64_t turns_ = 0;
  std::uint64_t slips_ = 0;
  std::uint64_t skipped_ = 0;
};

}  // namespace orcart
