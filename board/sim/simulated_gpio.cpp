// The simulated pedal line: what the script says, delivered when the clock reaches it.
#include "board/sim/simulated_gpio.hpp"

#include <algorithm>

namespace orcart {
namespace {

constexpr std::size_t kPulsesKept = 65'536;
constexpr Nanos kLiveLook = 1ms;  ///< how often a wait looks at the live pedal, which cannot wake it

EdgeKind opposite(EdgeKind kind) {
  return kind == EdgeKind::pressed ? EdgeKind::released : EdgeKind::pressed;
}

}  // namespace

std::vector<PedalEdge> edges_on_the_line(const GpioScript& script) {
  std::vector<PedalEdge> edges;
  for (const PedalEdge& edge : script.edges) {
    edges.push_back(edge);
    for (int i = 1; i <= 2 * script.bounce.pairs; ++i)
      edges.push_back(
          {.at = edge.at + i * script.bounce.spacing, .kind = i % 2 == 1 ? opposite(edge.kind) : edge.kind});
  }
  std::ranges::stable_sort(edges, {}, &PedalEdge::at);
  std::uint32_t sequence = 0;
  for (PedalEdge& edge : edges) edge.sequence = ++sequence;
  std::erase_if(edges, [&](const PedalEdge& edge) {
    return std::ranges::find(script.lost, edge.sequence) != script.lost.end();
  });
  return edges;
}

SimulatedGpio::SimulatedGpio(Clock& clock, const GpioScript& script, LivePedal* live)
    : clock_(clock), edges_(edges_on_the_line(script)), gone_at_(script.gone_at), live_(live) {
  pulses_.reserve(kPulsesKept);
}

void SimulatedGpio::wait(Instant deadline) noexcept {
  const Instant until = std::min(deadline, next_event());
  if (live_ == nullptr) return clock_.sleep_until(until);
  while (!live_->waiting() && clock_.now() < until)  // at most (until - now) / kLiveLook rounds
    clock_.sleep_until(std::min(until, clock_.now() + kLiveLook));
}

Instant SimulatedGpio::next_event() const noexcept {
  return next_ < edges_.size() ? std::min(edges_[next_].at, gone_at_) : gone_at_;
}

Result<PedalEdge, PortFault> SimulatedGpio::take_edge() noexcept {
  const Instant now = clock_.now();
  if (next_ < edges_.size() && edges_[next_].at <= now && edges_[next_].at < gone_at_) {
    sequence_ = edges_[next_].sequence;
    return edges_[next_++];
  }
  if (now >= gone_at_) return tl::unexpected(PortFault::disconnected);
  PedalEdge edge;
  if (live_ == nullptr || !live_->pop(edge)) return tl::unexpected(PortFault::nothing_yet);
  edge.sequence = ++sequence_;
  for (std::size_t i = next_; i < edges_.size(); ++i) ++edges_[i].sequence;  // they come after it on the line
  return edge;
}

Result<void, PortFault> SimulatedGpio::pulse_trigger(Instant now, Nanos width) noexcept {
  if (now >= gone_at_) return tl::unexpected(PortFault::disconnected);
  if (pulses_.size() < kPulsesKept) pulses_.push_back({.rise = now, .width = width});
  return {};
}

}  // namespace orcart
