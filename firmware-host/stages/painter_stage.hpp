// Takes pictures to the GPU, paints the captures, takes back what was undone. Thread: render. Rate: panel.
// Budget: topology, row "upload + paint".
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware-host/stages/capture_sink.hpp"
#include "firmware-host/stages/frame_ledger.hpp"
#include "firmware-host/stages/lanes.hpp"
#include "firmware-host/stages/view_errors.hpp"
#include "realtime/kernel/clock.hpp"
#include "realtime/kernel/stage.hpp"
#include "render/atlas/painter.hpp"
#include "render/egl/context.hpp"

namespace orcart {

/// What the painter stage tells the panel stage; both run on the render thread.
struct PaintState {
  std::uint64_t version = 0;   ///< of the painting
  std::uint32_t captures = 0;  ///< units painted and not undone
  std::uint32_t refused = 0;
  bool acknowledge_pending = false;  ///< a press whose picture is neither painted nor refused yet
  std::uint32_t acknowledged_unit = 0;
  bool streaming = false;
  Refusal last_refusal = Refusal::none;
  Instant failed_at{};
  Instant undone_at{};
  Instant warned_at{};
  FrameRecord newest;          ///< the frame in the inset
  Instant newest_exposed{};    ///< its exposure's end
  bool newest_is_new = false;  ///< not yet part of a submitted panel picture
};

class PainterStage final : public Stage {
 public:
  struct Parts {
    Painter& painter;
    const Clock& clock;
    Lanes& lanes;
    std::vector<CutoutPatch>& patches;
    Ledger<CaptureRecord>& captures;
    const ViewErrors* errors = nullptr;  ///< null: the painter goes by the passport's residuals
    CaptureSink* sink = nullptr;         ///< null: nothing is kept on disk
    GlContext* context = nullptr;  ///< made current on the thread that steps; null: it is current already
    std::uint32_t buffer_count = 0;
  };
  explicit PainterStage(const Parts& parts);

  std::string_view name() const noexcept override { return "upload + paint"; }
  void enter_thread() noexcept override;
  void leave_thread() noexcept override;
  StepReport step(Instant now) noexcept override;

  const PaintState& state() const noexcept { return state_; }
  /// The panel stage hands back what became of the newest frame.
  void mark_submitted() noexcept { state_.newest_is_new = false; }

 private:
  void handle(const PaintOrder& order, Instant now) noexcept;
  void show(const CapturedFrame& frame) noexcept;
  void paint(const PaintOrder& order, Instant now) noexcept;
  void refuse(const PaintOrder& order, Instant now) noexcept;
  void go_on() noexcept;
  void painted(const PaintOrder& order, bool on_surface) noexcept;
  void fail(const PaintOrder& order, Instant now) noexcept;
  void end_stream(std::uint32_t unit, Instant now) noexcept;
  void take_back(Instant now) noexcept;
  void done_with(std::uint32_t buffer) noexcept;
  void upload_newest() noexcept;

  Painter& painter_;
  const Clock& clock_;
  Lanes& lanes_;
  std::vector<CutoutPatch>& patches_;
  Ledger<CaptureRecord>& captures_;
  const ViewErrors* errors_;
  CaptureSink* sink_;
  GlContext* context_;
  std::vector<std::uint8_t> holds_;  ///< per buffer: how many reasons there are to keep it
  CapturedFrame newest_;
  bool have_newest_ = false;
  bool upload_due_ = false;
  struct Unit {
    std::uint32_t number = 0;
    bool on_surface = false;  ///< false: nothing of it is on the surface, and the painter knows of none
  };
  std::array<Unit, 64> units_{};  ///< captured and not undone, newest last
  std::uint32_t unit_count_ = 0;
  std::uint32_t cancelled_unit_ = 0, undone_unit_ = 0;  ///< the last ones: what still comes of them is let go
  std::uint32_t failed_unit_ = 0;                       ///< the newest
  PaintOrder carried_;                                  ///< what the texel cap stopped
  bool is_carried_ = false;
  PaintState state_;
};

}  // namespace orcart
