// Keeps captures: takes copies on the render thread, writes them on its own. Thread: session, not a real-time
// one. Rate: topology. Budget: row "session".
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "firmware-host/session/capture_slots.hpp"
#include "firmware-host/session/session_writer.hpp"
#include "firmware-host/stages/capture_sink.hpp"
#include "realtime/kernel/stage.hpp"

namespace orcart {

class SessionStage final : public Stage, public CaptureSink {
 public:
  /// `picture_bytes`: of the largest picture, packed tightly.
  SessionStage(SessionWriter& writer, std::size_t slots, std::size_t picture_bytes)
      : writer_(writer), slots_(slots, picture_bytes) {}

  std::string_view name() const noexcept override { return "session"; }
  /// Session thread: writes everything that waits. What fails is counted, told by last_error(), and does not
  /// stop the cart. Call once more after the render thread has ended, for what came last.
  StepReport step(Instant now) noexcept override;

  /// Render thread: one copy, no wait.
  void keep(const CapturedFrame& frame, const CaptureRecord& record) noexcept override;
  void undone(std::uint32_t unit) noexcept override { (void)slots_.undone(unit); }

  /// Any thread.
  std::uint64_t kept() const noexcept { return kept_.load(std::memory_order_relaxed); }  // a count alone
  /// Those for which there was no slot, and those whose write failed.
  std::uint64_t lost() const noexcept override {
    return slots_.lost() + unwritten_.load(std::memory_order_relaxed);  // a count alone
  }
  bool failing() const noexcept override { return failing_.load(std::memory_order_relaxed); }  // a flag alone
  /// Any thread: steps whose write failed.
  std::uint64_t failures() const noexcept {
    return failures_.load(std::memory_order_relaxed);
  }  // a count alone
  /// The session thread's own, or after it has ended: the newest failure, one sentence; empty where there was
  /// none.
  const std::string& last_error() const noexcept { return last_error_; }

 private:
  SessionWriter& writer_;
  CaptureSlots slots_;
  std::atomic<std::uint64_t> kept_{0}, failures_{0}, unwritten_{0};
  std::atomic<bool> failing_{false};
  std::string last_error_;
};

}  // namespace orcart
