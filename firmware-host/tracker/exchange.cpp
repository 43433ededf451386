// Sends a command and collects the reply.
#include "firmware-host/tracker/exchange.hpp"

namespace orcart {

void Exchange::listen(Instant now, Nanos patience) noexcept {
  size_ = 0;
  frame_ = {};
  asked_at_ = now;
  deadline_ = now + patience;
  busy_ = true;
}

bool Exchange::begin(const ndi::Command& command, Instant now, Nanos patience) noexcept {
  link_.discard_input();
  kind_ = command.reply_kind();
  listen(now, patience);
  busy_ = link_.write(command.bytes()).has_value();
  return busy_;
}

void Exchange::await_text(Instant now, Nanos patience) noexcept {
  kind_ = ndi::ReplyKind::ascii;
  listen(now, patience);
}

bool Exchange::fill() noexcept {
  while (size_ < buffer_.size()) {
    const auto count = link_.read(std::span{buffer_}.subspan(size_));
    if (!count) return count.error() == PortFault::nothing_yet;
    if (*count == 0) break;
    size_ += *count;
  }
  return true;
}

ExchangeEvent Exchange::end(ExchangeEvent event) noexcept {
  busy_ = false;
  return event;
}

ExchangeEvent Exchange::step(Instant now) noexcept {
  if (!fill()) return end(ExchangeEvent::link_down);
  if (!busy_) {
    size_ = 0;  // nobody asked
    return ExchangeEvent::none;
  }
  frame_ = ndi::find_reply({buffer_.data(), size_}, kind_);
  if (frame_.status == ndi::FrameStatus::complete) {
    arrived_at_ = link_.last_arrival();
    return end(ExchangeEvent::reply);
  }
  if (frame_.status == ndi::FrameStatus::bad_crc || size_ == buffer_.size())
    return end(ExchangeEvent::damaged);
  if (now < deadline_) return ExchangeEvent::none;
  return end(frame_.status == ndi::FrameStatus::garbage ? ExchangeEvent::damaged : ExchangeEvent::timed_out);
}

}  // namespace orcart
