// Everything that time brings about happens in wait(): the pulse's end, the look at the level, the search for
// a lost chip.
#include "board/linux/pedal/gpio_pedal.hpp"

#include <algorithm>

namespace orcart {

Result<std::unique_ptr<GpioPedal>> GpioPedal::open(const GpioWish& wish, Clock& clock, LineKeeper& keeper) {
  auto lines = keeper.request(wish);
  if (!lines) return fail(lines.error().sentence);
  std::unique_ptr<GpioPedal> pedal(new GpioPedal(wish, clock, keeper));
  pedal->adopt(std::move(*lines));
  return pedal;
}

GpioPedal::~GpioPedal() {
  if (pulse_end_ && lines_) (void)lines_->set_trigger(TriggerLevel::idle);
}

void GpioPedal::adopt(std::unique_ptr<RequestedLines> lines) noexcept {
  lines_ = std::move(lines);
  if (const auto level = lines_->level()) ledger_.found_at(*level);
  check_at_ = clock_.now() + kCheck;
  disagreements_ = 0;
}

void GpioPedal::lose_chip() noexcept {
  lines_.reset();
  ledger_.lose();
  pulse_end_.reset();
  missed_.reset();
  retry_at_ = clock_.now() + kRetry;
}

void GpioPedal::look_for_chip() noexcept {
  if (auto lines = keeper_.request(wish_)) {
    adopt(std::move(*lines));
  } else {
    retry_at_ = clock_.now() + kRetry;
  }
}

void GpioPedal::end_pulse() noexcept {
  if (!pulse_end_ || clock_.now() < *pulse_end_) return;
  pulse_end_.reset();
  if (lines_ && !lines_->set_trigger(TriggerLevel::idle)) lose_chip();
}

// One look may come between an edge and its reading; two in a row that disagree cannot.
void GpioPedal::check_level() noexcept {
  check_at_ = clock_.now() + kCheck;
  const auto level = lines_->level();
  if (!level) return lose_chip();
  disagreements_ = *level == ledger_.level() ? 0 : disagreements_ + 1;
  if (disagreements_ < 2) return;
  disagreements_ = 0;
  ledger_.lose();
  missed_ = ledger_.accept({.kind = *level, .at = clock_.now(), .number = std::nullopt});
}

void GpioPedal::wait(Instant deadline) noexcept {
  do {  // bound: a round every kCheck or kRetry until the deadline, and one for a pulse's end
    end_pulse();
    Instant until = deadline;
    if (pulse_end_) until = std::min(until, *pulse_end_);
    if (lines_) {
      until = std::min(until, check_at_);
      if (lines_->wait(until))
        return;  // an edge, or a fault to be read, however late this thread comes to it
      if (clock_.now() >= check_at_) check_level();
      if (missed_ || !lines_) return end_pulse();
    } else {
      clock_.sleep_until(std::min(until, retry_at_));
      if (clock_.now() >= retry_at_) look_for_chip();
    }
  } while (clock_.now() < deadline);
  end_pulse();
}

Result<PedalEdge, PortFault> GpioPedal::take_edge() noexcept {
  end_pulse();
  if (missed_) {
    const PedalEdge edge = *missed_;
    missed_.reset();
    return edge;
  }
  if (!lines_) return tl::unexpected(PortFault::disconnected);
  const auto raw = lines_->read();
  if (raw) {
    disagreements_ = 0;
    return ledger_.accept(*raw);
  }
  if (raw.error() == PortFault::disconnected) lose_chip();
  return tl::unexpected(raw.error());
}

Result<void, PortFault> GpioPedal::pulse_trigger(Instant now, Nanos width) noexcept {
  if (!lines_) return tl::unexpected(PortFault::disconnected);
  if (auto raised = lines_->set_trigger(TriggerLevel::raised); !raised) {
    if (raised.error() == PortFault::disconnected) lose_chip();
    return raised;
  }
  pulse_end_ = std::max(pulse_end_.value_or(now), now + width);
  return {};
}

}  // namespace orcart
