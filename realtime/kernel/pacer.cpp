// Moves a fixed-rate loop along its grid.
#include "realtime/kernel/pacer.hpp"

namespace orcart {

std::uint64_t Pacer::turn_over(Instant now) noexcept {
  ++turns_;
  due_ += period_;
  if (now <= due_) return 0;
  ++slips_;
  if (policy_ == OverrunPolicy::run_late) return 0;
  const std::int64_t missed = (now - due_ + period_ - Nanos{1}) / period_;
  due_ += missed * period_;
  skipped_ += static_cast<std::uint64_t>(missed);
  return static_cast<std::uint64_t>(missed);
}

}  // namespace orcart
