// A window on this machine's screen that shows what the simulated panel shows, and whose keys are a pedal.
// Preview only.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "board/sim/live_pedal.hpp"
#include "board/sim/panel_observer.hpp"
#include "realtime/base/result.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// An observer of a SimulatedPanel, which goes on keeping the time: the window shows the newest picture when
/// it can, and holds nobody up. SDL lives in a thread of this class alone. Space is the pedal; q, Escape or
/// closing asks to quit.
class PreviewWindow final : public PanelObserver {
 public:
  /// Fails where there is no display. `clock` must be real: keys are stamped from the window's thread.
  static Result<std::unique_ptr<PreviewWindow>> open(const PanelMode& mode, const std::string& title,
                                                     Clock& clock);
  ~PreviewWindow() override;
  PreviewWindow(const PreviewWindow&) = delete;
  PreviewWindow& operator=(const PreviewWindow&) = delete;

  void flipped(const ShownPicture& now, const ShownPicture* before) noexcept override;

  /// To be given to a SimulatedGpio.
  LivePedal& pedal() noexcept { return pedal_; }
  /// Any thread.
  bool quit_asked() const noexcept { return quit_.load(std::memory_order_relaxed); }  // a flag alone
  std::uint64_t pictures_drawn() const noexcept {
    return drawn_.load(std::memory_order_relaxed);
  }  // a count alone

 private:
  struct Screen;
  PreviewWindow(const PanelMode& mode, Clock& clock);
  void run(Screen& screen, const std::stop_token& stopped);
  void handle_events(Screen& screen);
  void draw_newest(Screen& screen);

  PanelMode mode_;
  Clock& clock_;
  LivePedal pedal_;
  std::vector<std::byte>
      handed_over_;  ///< the panel's thread fills it while `full_` is false, the window's empties it
  std::atomic<bool> full_{false};
  std::atomic<bool> quit_{false};
  std::atomic<std::uint64_t> drawn_{0};
  std::jthread thread_;  ///< last: it stops before the rest goes
};

}  // namespace orcart
