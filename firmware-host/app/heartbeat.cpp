// Counts of turns that stand still are hung threads.
#include "firmware-host/app/heartbeat.hpp"

#include <cstdio>

namespace orcart {

HeartbeatStage::HeartbeatStage(const ServiceManager& manager, std::vector<WatchedThread> threads)
    : manager_(manager), threads_(std::move(threads)), seen_(threads_.size()) {}

StepReport HeartbeatStage::step(Instant now) noexcept {
  const std::string_view before = hung_;
  look(now);
  if (hung_ != before) say_what_changed(before);
  if (!hung_.empty() || manager_.watchdog() <= Nanos{0} || now < next_sign_) return {};
  next_sign_ = now + manager_.watchdog() / 4;
  return {.worked = manager_.tell("WATCHDOG=1"), .items = 1};
}

void HeartbeatStage::look(Instant now) noexcept {
  hung_ = {};
  for (std::size_t i = 0; i < threads_.size(); ++i) {
    // Relaxed, without a partner: a count alone.
    const std::uint64_t turns = threads_[i].ledger->turns.load(std::memory_order_relaxed);
    const bool first_look = seen_[i].at == Instant{};
    if (first_look || turns != seen_[i].turns) {
      seen_[i] = {.turns = turns, .at = now};
    } else if (now - seen_[i].at >= kHung && hung_.empty()) {
      hung_ = threads_[i].name;
    }
  }
}

void HeartbeatStage::say_what_changed(std::string_view before) const noexcept {
  char line[128];
  if (hung_.empty()) {
    std::snprintf(line, sizeof line, "STATUS=thread %.*s moves again", static_cast<int>(before.size()),
                  before.data());
  } else {
    std::snprintf(line, sizeof line, "STATUS=thread %.*s hangs: no sign of life until it moves",
                  static_cast<int>(hung_.size()), hung_.data());
  }
  (void)manager_.tell(line);
}

Heartbeat::Heartbeat(ServiceManager manager, std::vector<WatchedThread> threads, Clock& clock)
    : manager_(std::move(manager)),
      stage_(manager_, std::move(threads)),
      thread_(
          {.spec = {.name = "heartbeat", .rate_hz = 1 / seconds(HeartbeatStage::kLook)}, .stages = {&stage_}},
          clock) {
  // Where the thread cannot be had no sign of life is sent, and the manager does what it does then.
  if (manager_.present()) (void)thread_.start();
  (void)manager_.tell("READY=1\nSTATUS=running");
}

Heartbeat::~Heartbeat() {
  thread_.stop();
  (void)manager_.tell("STOPPING=1");
}

}  // namespace orcart
