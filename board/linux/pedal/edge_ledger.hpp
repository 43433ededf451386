// Counts a line's edges so that a lost one leaves a gap, whether the kernel numbers them or not.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "board/ports/gpio_lines.hpp"

namespace orcart {

/// An edge as the kernel tells it, polarity applied.
struct RawEdge {
  EdgeKind kind = EdgeKind::pressed;
  Instant at{};
  std::optional<std::uint32_t> number;  ///< the kernel's count of this line's edges, where it tells one
};

/// One thread; no memory. A gap in the kernel's numbers is a gap; and two edges of one polarity mean that the
/// one between them is missing, numbered or not: the kernel numbers interrupts, and reads the level later.
class EdgeLedger {
 public:
  /// The line was found at this level, by opening it (again). Numbers of the kernel begin anew.
  void found_at(EdgeKind level) noexcept {
    if (known_ && level_ != level) lost_ = true;
    known_ = true;
    level_ = level;
    number_.reset();
  }
  /// Something was missed, nobody knows how much: the next edge shows it.
  void lose() noexcept { lost_ = true; }

  PedalEdge accept(const RawEdge& raw) noexcept {
    std::uint32_t step = 1;
    if (raw.number && number_) {
      step = *raw.number - *number_;
      if (step == 0 || step > kMostLost) step = 2;  // numbers that make no sense are a loss as well
    }
    if (known_ && raw.kind == level_) step = std::max(step, 2U);
    sequence_ += step + (lost_ && step == 1 ? 1 : 0);
    lost_ = false;
    known_ = true;
    level_ = raw.kind;
    number_ = raw.number;
    return {.at = raw.at, .kind = raw.kind, .sequence = sequence_};
  }
  EdgeKind level() const noexcept { return level_; }

 private:
  static constexpr std::uint32_t kMostLost = 1U << 31;

  std::uint32_t sequence_ = 0;
  EdgeKind level_ = EdgeKind::released;
  bool known_ = false, lost_ = false;
  std::optional<std::uint32_t> number_;
};

}  // namespace orcart
