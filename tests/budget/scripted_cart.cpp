// Each stage has lanes of its own; what it may see is moved in when its step begins, what it made is moved
// out when its time is over.
#include "tests/budget/scripted_cart.hpp"

#include <array>
#include <functional>

#include "board/sim/picture_supply.hpp"
#include "board/sim/simulated_frame_source.hpp"
#include "board/sim/simulated_gpio.hpp"
#include "board/sim/simulated_panel.hpp"
#include "firmware-host/stages/camera_stage.hpp"
#include "firmware-host/stages/pedal_stage.hpp"
#include "firmware-host/stages/sync_stage.hpp"

namespace orcart::testing {
namespace {

/// Does what it is told, and keeps its thread busy for its cost.
class Part final : public Stage {
 public:
  explicit Part(std::function<void(Instant)> act) : act_(std::move(act)) {}
  std::string_view name() const noexcept override { return "part"; }
  StepReport step(Instant now) noexcept override {
    act_(now);
    return {.worked = true};
  }

 private:
  std::function<void(Instant)> act_;
};

LaneDepths depths() {
  return {.poses = kPoseQueueDepth,
          .pedal = kPedalQueueDepth,
          .frames = kFrameQueueDepth,
          .orders = kPaintQueueDepth,
          .patches = kPatchSlots};
}

template <class T>
void move_all(SpscQueue<T>& from, SpscQueue<T>& to) {
  for (T one; from.try_pop(one);) (void)to.try_push(one);
}

/// A tracker that sees both tools at every measurement.
PoseSample sample_at(Instant measured_at, Nanos delay) {
  PoseSample sample{.measured_at = measured_at, .arrived_at = measured_at + delay};
  sample.scope = sample.reference = ToolState::seen;
  return sample;
}

/// Samples whose delay is over, at the instants at which it is.
class Tracker final : public WakeSource {
 public:
  Tracker(const ScriptedSetup& setup, Instant start) : setup_(setup), start_(start) {}
  void wait(Instant) noexcept override {}
  Instant next_event() const noexcept override { return measured(next_) + setup_.tracker_delay; }
  void hand_over(Instant now, SpscQueue<PoseSample>& to) {
    for (; measured(next_) + setup_.tracker_delay <= now; ++next_)
      (void)to.try_push(sample_at(measured(next_), setup_.tracker_delay));
  }

 private:
  Instant measured(int k) const { return start_ + setup_.tracker_phase + period_of(setup_.tracker_hz) * k; }
  const ScriptedSetup& setup_;
  Instant start_;
  int next_ = 0;
};

class ScriptedCart {
 public:
  explicit ScriptedCart(const ScriptedSetup& setup);
  ScriptedOutcome run();

 private:
  Nanos cost(StageId id) const {
    const Budget budget = budget_of(id, setup_.render_class);
    return setup_.times == Times::p999 ? budget.p999 : budget.bound;
  }
  void render(Instant now);
  void paint(const PaintOrder& order);
  void let_go(std::uint32_t buffer) {
    if (--holds_[buffer] == 0) (void)camera_lanes_.frames_home.try_push(buffer);
  }
  void present(Instant now);
  void take_flips(Instant now);
  ThreadPlan plan(ThreadId id, std::vector<std::size_t> parts);
  Part& part(Nanos cost, std::function<void(Instant)> act);

  const ScriptedSetup& setup_;
  SimulatedClock clock_;
  Instant start_ = clock_.now();
  MemoryPictures pictures_;
  SimulatedFrameSource camera_;
  SimulatedGpio gpio_;
  SimulatedPanel panel_;
  Tracker tracker_;
  Lanes camera_lanes_{depths()}, pedal_lanes_{depths()}, match_lanes_{depths()}, render_lanes_{depths()};
  CameraStage camera_stage_;
  PedalStage pedal_stage_;
  SyncStage match_stage_;
  std::vector<std::unique_ptr<Part>> parts_;
  std::vector<Nanos> costs_;
  std::vector<std::vector<Nanos>> plan_costs_;

  std::array<int, kFrameBuffers> holds_{};
  std::optional<CapturedFrame> newest_;
  bool newest_is_new_ = false, acknowledge_due_ = false, paint_due_ = false;
  /// What the picture that waits for its flip shows.
  struct Picture {
    std::optional<ShownFrame> frame;
    bool acknowledges = false, paints = false;
  } submitted_;
  ScriptedOutcome outcome_;
};

ScriptedCart::ScriptedCart(const ScriptedSetup& setup)
    : setup_(setup),
      pictures_({.width_px = 8, .height_px = 2, .format = PixelFormat::yuyv, .rate_hz = setup.camera_hz},
                {.rate_hz = setup.camera_hz, .exposure = setup.exposure, .first = setup.camera_phase},
                1'000'000,
                {std::vector<std::byte>(32, std::byte{1}), std::vector<std::byte>(32, std::byte{2})}),
      camera_(clock_, pictures_, {.start = start_, .readout = setup.readout, .buffers = kFrameBuffers}),
      gpio_(clock_, {.edges = {{.at = start_ + setup.press_at, .kind = EdgeKind::pressed},
                               {.at = start_ + setup.press_at + 100ms, .kind = EdgeKind::released}}}),
      panel_(clock_, {.mode = {.width_px = 8, .height_px = 2, .refresh_hz = setup.panel_hz},
                      .first_vblank = start_ + setup.vblank_phase,
                      .flips_kept = 64}),
      tracker_(setup, start_),
      camera_stage_(camera_, clock_, {.exposure = setup.exposure}, camera_lanes_),
      pedal_stage_(gpio_, {}, pedal_lanes_),
      match_stage_({.history = {.period = period_of(setup.tracker_hz)}, .matcher = {}, .selector = {}},
                   match_lanes_) {}

Part& ScriptedCart::part(Nanos cost, std::function<void(Instant)> act) {
  costs_.push_back(cost);
  return *parts_.emplace_back(std::make_unique<Part>(std::move(act)));
}

ThreadPlan ScriptedCart::plan(ThreadId id, std::vector<std::size_t> parts) {
  ThreadPlan plan{.spec = spec_of(id)};
  auto& costs = plan_costs_.emplace_back();
  for (const std::size_t i : parts) {
    plan.stages.push_back(parts_[i].get());
    costs.push_back(costs_[i]);
  }
  plan.virtual_costs = costs;
  if (id == ThreadId::render) plan.spec.rate_hz = setup_.panel_hz;
  if (id == ThreadId::pedal) plan.wake = &gpio_;
  if (id == ThreadId::tracker) plan.wake = &tracker_;
  if (id == ThreadId::camera) plan.wake = &camera_;
  if (plan.wake != nullptr) plan.spec.event_timeout = 1h;
  return plan;
}

ScriptedOutcome ScriptedCart::run() {
  plan_costs_.reserve(kThreadCount);
  const auto nothing = [](Instant) {};
  part(cost(StageId::pedal), [this](Instant now) { (void)pedal_stage_.step(now); });
  part(0ns, [this](Instant) { move_all(pedal_lanes_.pedal, match_lanes_.pedal); });
  part(0ns, [this](Instant now) { tracker_.hand_over(now, match_lanes_.poses); });
  part(cost(StageId::camera), nothing);  // from the frame's stamp to its being dequeued
  part(0ns, [this](Instant now) {
    (void)camera_stage_.step(now);
    move_all(camera_lanes_.frames, match_lanes_.frames);
  });
  part(cost(StageId::sync), [this](Instant now) { (void)match_stage_.step(now); });
  part(0ns, [this](Instant) { move_all(match_lanes_.orders, render_lanes_.orders); });
  part(cost(StageId::mapper), nothing);
  part(0ns, [this](Instant now) {
    for (Selection one; match_lanes_.selected.try_pop(one);)
      (void)render_lanes_.orders.try_push({.kind = PaintOrderKind::paint,
                                           .frame = one.matched.frame,
                                           .request = one.request,
                                           .matched_at = one.decided_at,
                                           .mapped_at = now});
  });
  part(cost(StageId::painter), [this](Instant now) { render(now); });
  part(cost(StageId::panel), [this](Instant now) { take_flips(now); });
  part(0ns, [this](Instant now) { present(now); });

  std::vector<ThreadPlan> plans;
  plans.push_back(plan(ThreadId::pedal, {0, 1}));
  plans.push_back(plan(ThreadId::tracker, {2}));
  plans.push_back(plan(ThreadId::camera, {3, 4}));
  plans.push_back(plan(ThreadId::mapping, {5, 6, 7, 8}));
  plans.push_back(plan(ThreadId::render, {9, 10, 11}));
  (void)camera_.start();
  SimulatedRunner runner(std::move(plans), clock_);
  runner.run_until(start_ + setup_.run_for);
  take_flips(clock_.now());
  outcome_.mapping_slips = runner.ledger(3).slips;
  outcome_.render_slips = runner.ledger(4).slips;
  for (const Lanes* lanes : {&camera_lanes_, &pedal_lanes_, &match_lanes_, &render_lanes_})
    outcome_.drops += lanes->poses.dropped() + lanes->pedal.dropped() + lanes->frames.dropped() +
                      lanes->orders.dropped() + lanes->selected.dropped();
  return std::move(outcome_);
}

void ScriptedCart::render(Instant) {
  for (PaintOrder order; render_lanes_.orders.try_pop(order);) paint(order);
}

void ScriptedCart::paint(const PaintOrder& order) {
  switch (order.kind) {
    case PaintOrderKind::show:
      if (newest_) let_go(newest_->buffer);
      newest_ = order.frame;
      newest_is_new_ = true;
      holds_[order.frame.buffer] = 2;
      break;
    case PaintOrderKind::release:
      let_go(order.frame.buffer);
      break;
    case PaintOrderKind::acknowledge:
      acknowledge_due_ = true;
      break;
    case PaintOrderKind::fail:
      outcome_.failed = true;
      outcome_.refusal = order.refusal;
      break;
    case PaintOrderKind::paint:
      outcome_.painted = paint_due_ = true;
      outcome_.painted_sequence = order.frame.sequence;
      outcome_.mid_exposure = order.frame.mid_exposure() - start_;
      outcome_.matched = order.matched_at - start_;
      let_go(order.frame.buffer);
      break;
    default:
      break;
  }
}

void ScriptedCart::present(Instant now) {
  take_flips(now);
  if (!panel_.acquire() || !panel_.present(now)) return;
  submitted_ = {.frame = std::nullopt, .acknowledges = acknowledge_due_, .paints = paint_due_};
  if (newest_is_new_)
    submitted_.frame = ShownFrame{
        .sequence = newest_->sequence, .dequeued = newest_->dequeued_at - start_, .submitted = now - start_};
  newest_is_new_ = acknowledge_due_ = paint_due_ = false;
}

void ScriptedCart::take_flips(Instant now) {
  for (auto flip = panel_.take_flip(now); flip; flip = panel_.take_flip(now)) {
    if (submitted_.frame) {
      submitted_.frame->scan_out = flip->at - start_;
      outcome_.shown.push_back(*submitted_.frame);
    }
    if (submitted_.acknowledges) outcome_.acknowledged = flip->at - start_;
    if (submitted_.paints) outcome_.on_panel = flip->at - start_;
    submitted_ = {};
  }
}

}  // namespace

ScriptedOutcome run_scripted(const ScriptedSetup& setup) {
  return ScriptedCart(setup).run();
}

}  // namespace orcart::testing
