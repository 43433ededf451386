// The simulated panel: a flip happens when somebody looks after its vblank, and is stamped with the vblank.
#include "board/sim/simulated_panel.hpp"

#include <algorithm>
#include <cmath>

namespace orcart {

SimulatedPanel::SimulatedPanel(Clock& clock, const SimulatedPanelSetup& setup,
                               std::span<PanelObserver* const> observers)
    : clock_(clock),
      setup_(setup),
      observers_(observers.begin(), observers.end()),
      pixels_(kBuffers * packed_bytes(PixelFormat::xrgb8888, setup.mode.width_px, setup.mode.height_px)),
      memory_(std::max<std::size_t>(setup.flips_kept, 1)) {}

Result<ImageDescriptor, PortFault> SimulatedPanel::acquire() noexcept {
  const Instant now = clock_.now();
  complete_flip(now);
  if (faulty(PanelFault::disconnected, now)) return tl::unexpected(PortFault::disconnected);
  for (int i = 0; i < kBuffers && drawing_ == kNone; ++i)
    if (i != waiting_ && i != shown_) drawing_ = i;
  return image(drawing_);
}

Result<std::uint64_t, PortFault> SimulatedPanel::present(Instant now) noexcept {
  now = std::max(now, clock_.now());  // a picture that took its time to draw cannot flip in the past
  complete_flip(now);
  if (faulty(PanelFault::disconnected, now)) return tl::unexpected(PortFault::disconnected);
  if (drawing_ == kNone) return tl::unexpected(PortFault::unsupported);
  if (waiting_ != kNone) return tl::unexpected(PortFault::busy);
  waiting_ = drawing_;
  drawing_ = kNone;
  waiting_flip_ = {.serial = ++serial_, .at = flip_of_present(now)};
  return serial_;
}

std::optional<Flip> SimulatedPanel::take_flip(Instant now) noexcept {
  complete_flip(now);
  if (flips_taken_ == flips_done_) return std::nullopt;
  flips_taken_ = std::max(flips_taken_, flips_done_ - std::min<std::uint64_t>(flips_done_, memory_.size()));
  return memory_[flips_taken_++ % memory_.size()];
}

Instant SimulatedPanel::next_vblank(Instant now) const noexcept {
  // From the count, so that no rounding gathers: vblank k = first + round(k * 1e9 / refresh).
  const double period_ns = 1e9 / setup_.mode.refresh_hz;
  const auto vblank = [&](std::int64_t k) {
    return setup_.first_vblank + Nanos{std::llround(static_cast<double>(k) * period_ns)};
  };
  auto k = static_cast<std::int64_t>(
      std::floor(static_cast<double>((now - setup_.first_vblank).count()) / period_ns));
  if (vblank(k) > now) return vblank(k);
  return vblank(k + 1) > now ? vblank(k + 1) : vblank(k + 2);
}

Instant SimulatedPanel::next_event() const noexcept {
  return waiting_ == kNone ? Instant::max() : waiting_flip_.at;
}

std::optional<Flip> SimulatedPanel::shown_at(Instant at) const noexcept {
  const std::uint64_t kept = std::min<std::uint64_t>(flips_done_, memory_.size());
  for (std::uint64_t back = 1; back <= kept; ++back) {
    const Flip& flip = memory_[(flips_done_ - back) % memory_.size()];
    if (flip.at <= at) return flip;
  }
  return std::nullopt;
}

void SimulatedPanel::complete_flip(Instant now) noexcept {
  if (waiting_ == kNone || waiting_flip_.at > now) return;
  const ShownPicture fresh{.flip = waiting_flip_, .image = image(waiting_)};
  ShownPicture before;
  if (shown_ != kNone) before = {.flip = memory_[(flips_done_ - 1) % memory_.size()], .image = image(shown_)};
  for (PanelObserver* observer : observers_) observer->flipped(fresh, shown_ == kNone ? nullptr : &before);
  memory_[flips_done_++ % memory_.size()] = waiting_flip_;
  shown_ = waiting_;
  waiting_ = kNone;
}

Instant SimulatedPanel::flip_of_present(Instant now) const noexcept {
  Instant at = next_vblank(now);
  for (const PanelFaultPeriod& period : setup_.faults)  // in the order of time
    if (period.fault == PanelFault::flip_stuck && period.from <= at && at < period.until)
      at = period.until == Instant::max() ? Instant::max() : next_vblank(period.until - Nanos{1});
  return at;
}

bool SimulatedPanel::faulty(PanelFault fault, Instant at) const noexcept {
  return std::ranges::any_of(setup_.faults, [&](const PanelFaultPeriod& period) {
    return period.fault == fault && period.from <= at && at < period.until;
  });
}

ImageDescriptor SimulatedPanel::image(int buffer) noexcept {
  const std::size_t bytes = pixels_.size() / kBuffers;
  return packed_image(pixels_.data() + static_cast<std::size_t>(buffer) * bytes, PixelFormat::xrgb8888,
                      setup_.mode.width_px, setup_.mode.height_px);
}

}  // namespace orcart
