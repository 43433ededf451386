// Draws the screen and hands it to the panel; decides LIVE, STALE or LOST; learns when each picture was
// scanned out. Thread: render. Rate: panel. Budget: topology, row "render + submit".
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "board/ports/panel.hpp"
#include "firmware-host/stages/capture_sink.hpp"
#include "firmware-host/stages/frame_ledger.hpp"
#include "firmware-host/stages/lanes.hpp"
#include "firmware-host/stages/painter_stage.hpp"
#include "firmware-host/stages/watched_fault.hpp"
#include "realtime/kernel/budget.hpp"
#include "realtime/kernel/clock.hpp"
#include "realtime/kernel/stage.hpp"
#include "realtime/sync/freshness.hpp"
#include "render/views/screen.hpp"

namespace orcart {

struct PanelStageSettings {
  Eye eye;
  bool simulated = true;
  bool software_rendering = true;
  TurnSource turn = TurnSource::told;
  std::string painting_blocked;  ///< the reason, shown as long as the program runs; empty: it is not
  Nanos
      submit_deadline{};  ///< from dequeue, the sum of the stages' bounds (topology): late is counted from it
  FreshnessRules freshness;
};

class PanelStage final : public Stage {
 public:
  struct Parts {
    Panel& panel;
    Screen& screen;
    Painter& painter;
    PainterStage& painter_stage;
    const Clock& clock;
    Lanes& lanes;
    Ledger<FrameRecord>& frames;
    Ledger<CaptureRecord>& captures;
    std::span<const StageLedger> stages{};  ///< of the whole cart: whose misses the status line tells
    const CaptureSink* sink = nullptr;      ///< null: nothing is kept on disk
  };
  PanelStage(const Parts& parts, const PanelStageSettings& settings);

  std::string_view name() const noexcept override { return "render + submit"; }
  StepReport step(Instant now) noexcept override;

  const Status& status() const noexcept { return screen_state_.status; }
  std::uint64_t presented() const noexcept { return presented_; }
  /// The newest share of the surface that carries paint. Any thread.
  double coverage() const noexcept { return coverage_.load(std::memory_order_relaxed); }  // a figure alone
  /// What the panel last refused a picture with, but for being busy; nothing_yet while it shows them. Any
  /// thread.
  PortFault fault() const noexcept { return fault_.get(); }
  /// The machine does not grant what the threads want; said from the next picture on. Any thread.
  void tell_degraded() noexcept { degraded_.store(true, std::memory_order_relaxed); }  // a flag alone
  /// A person turned the view; takes effect with the next picture. Same thread as step().
  void look_from(const Eye& eye) noexcept { screen_state_.eye = eye; }

 private:
  /// What a submitted picture holds, until its flip is known.
  struct Submitted {
    std::uint64_t serial = 0;
    FrameRecord frame;
    bool has_new_frame = false;
    std::size_t captures_shown = 0;  ///< ledger length when it was drawn
    std::uint32_t acknowledged_unit = 0;
    bool acknowledges = false;
  };
  void take_flips(Instant now) noexcept;
  void settle(const Submitted& shown, Instant scan_out) noexcept;
  void fill_status() noexcept;
  void tell_misses() noexcept;
  void choose_notice(Instant now) noexcept;
  void notice_turn() noexcept;
  bool loses_captures(Instant now) noexcept;
  void notice(Notice::Level level, std::string_view text) noexcept;

  static constexpr Nanos kFiguresEvery = 500ms;  ///< more often nobody reads them

  Parts parts_;
  PanelStageSettings settings_;
  ScreenState screen_state_;
  TrackerNews tracker_;
  CameraNews camera_;
  PedalNews pedal_;
  WatchedFault fault_;
  ScopeNow scope_;
  std::array<Submitted, 8> submitted_{};
  std::size_t settled_captures_ = 0;
  std::uint32_t last_acknowledged_ = 0;
  Instant acknowledged_scan_out_{};
  std::uint64_t presented_ = 0;
  Instant count_due_{};  ///< of the pictures a second
  std::uint32_t since_counted_ = 0;
  Instant latency_due_{};
  Instant coverage_due_{};             ///< of a painting that goes on; else in the picture after a change
  std::uint64_t counted_version_ = 0;  ///< of the painting whose coverage is told
  Nanos longest_latency_{0};           ///< of the frames since the panel last said it
  std::uint64_t captures_lost_ = 0;    ///< by the sink, as far as the panel has seen
  std::optional<Instant> lost_at_;     ///< when it saw the newest
  std::atomic<double> coverage_{0};
  std::atomic<bool> degraded_{false};
};

}  // namespace orcart
