// The cart: everything is built at start, owned here and lent by reference; started along the way of the
// data, stopped backward.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "board/ports/byte_link.hpp"
#include "board/ports/frame_source.hpp"
#include "board/ports/gpio_lines.hpp"
#include "board/ports/panel.hpp"
#include "board/ports/turn_encoder.hpp"
#include "firmware-host/app/cart_config.hpp"
#include "firmware-host/app/patient.hpp"
#include "firmware-host/app/topology.hpp"
#include "firmware-host/session/session_stage.hpp"
#include "firmware-host/stages/frame_ledger.hpp"
#include "realtime/kernel/clock.hpp"
#include "realtime/kernel/thread_loop.hpp"
#include "render/atlas/painter.hpp"
#include "render/egl/context.hpp"
#include "render/hud/status.hpp"

namespace orcart {

/// The seams, already opened. Lent; they outlive the cart.
struct Ports {
  ByteLink& tracker;
  FrameSource& camera;
  GpioLines& pedal;
  Panel& panel;
  TurnEncoder* encoder = nullptr;  ///< null where the turn is not followed by one
};

/// What a run did, read after stop().
struct CartFigures {
  std::uint64_t frames_taken = 0;   ///< from the camera
  std::uint64_t sequence_gaps = 0;  ///< lost before they reached us, by the driver's count
  std::uint64_t queue_drops = 0;
  std::uint64_t tracker_polls = 0, tracker_missing = 0, tracker_bad_crc = 0;
  std::uint64_t panel_pictures = 0;
};

/// Puts a stage of its own around each of the cart's before the threads start: guards, and tests' bugs.
class StageWrapper {
 public:
  virtual ~StageWrapper() = default;
  /// What the thread will step instead of `stage`; owned by the wrapper, outlives the cart's run.
  virtual Stage& around(const ThreadSpec& thread, StageId id, Stage& stage) = 0;
};

class Cart {
 public:
  struct Setup {
    const CartConfig& config;
    const Patient& patient;
    Ports ports;
    Clock& clock;
    NativeDisplay display{};          ///< where EGL is opened: the panel's card, or nowhere
    SessionStage* session = nullptr;  ///< null: nothing is kept on disk
    double longest_run_s = 3600;      ///< what the ledgers of frames and captures have room for
    StageWrapper* wrapper = nullptr;  ///< null: the stages run as they are
    std::size_t traced = 0;           ///< newest events kept of each thread; 0: nothing is traced
  };
  /// Builds and arms everything but the threads. The calling thread must be the one that calls
  /// run_simulated(), or start() and stop().
  static Result<std::unique_ptr<Cart>> create(const Setup& setup);
  ~Cart();

  /// One thread per row of the topology, along the way of the data.
  Result<void> start();
  /// Backward, what the session still holds last; idempotent. Afterwards the GL context is current on the
  /// calling thread again.
  void stop() noexcept;
  /// Instead of start(): everything on the calling thread in simulated time, the clock given at creation
  /// being `clock`.
  void run_simulated(SimulatedClock& clock, Instant end);

  const Ledger<FrameRecord>& frames() const;
  const Ledger<CaptureRecord>& captures() const;
  const std::array<StageLedger, kStageCount>& stage_ledgers() const;
  const std::vector<ThreadLedger const*>& thread_ledgers()
      const;  ///< in the order of ThreadId, those that ran
  /// What each thread traced, in the order of ThreadId, those that ran; empty where nothing was.
  const std::vector<std::unique_ptr<TraceRing>>& traces() const;
  const std::vector<std::string>& lacks() const;  ///< of real-time rights: each a sentence with its remedy
  CartFigures figures() const;
  RenderClass render_class() const;
  const GlContext& context() const;
  Painter& painter();  ///< after stop(), or before start()
  /// What the panel says; after stop(), or between calls of run_simulated().
  const Status& status() const;
  /// For a progress line. Any thread.
  struct Now {
    double coverage = 0;
    std::size_t frames = 0, captures = 0;  ///< shown; painted or refused
    /// What is wrong with each device; nothing_yet where nothing is.
    PortFault camera = PortFault::nothing_yet, pedal = PortFault::nothing_yet, panel = PortFault::nothing_yet,
              encoder = PortFault::nothing_yet;
    int mismatch_deg = 0;            ///< SyncStage::mismatch_deg()
    std::uint64_t session_lost = 0;  ///< captures that are not in the session
    bool session_failing = false;    ///< its newest write failed
    /// NdiDriver::trouble_sentence(), empty where there is none; and its remark().
    std::string tracker, tracker_remark;
  };
  Now now() const;

 private:
  struct State;
  explicit Cart(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace orcart
