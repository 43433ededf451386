// Gives each stage its thread from the topology, and stops them backward.
#include "firmware-host/app/cart_state.hpp"

namespace orcart {

ThreadPlan Cart::State::plan(ThreadId id) {
  ThreadPlan plan{.spec = spec_of(id)};
  switch (id) {
    case ThreadId::pedal:
      plan.stages = {pedal.get()};
      plan.wake = &setup.ports.pedal;
      plan.ledgers = {ledger(StageId::pedal)};
      if (encoder != nullptr) {
        plan.stages.push_back(encoder.get());
        plan.ledgers.push_back(ledger(StageId::encoder));
      }
      break;
    case ThreadId::tracker:
      plan.stages = {tracker.get()};
      plan.wake = tracker_wake.get();
      plan.ledgers = {ledger(StageId::tracker)};
      break;
    case ThreadId::camera:
      plan.stages = {camera.get()};
      plan.wake = &setup.ports.camera;
      plan.ledgers = {ledger(StageId::camera)};
      break;
    case ThreadId::mapping:
      plan.stages = {sync.get(), mapping.get()};
      plan.ledgers = {ledger(StageId::sync), ledger(StageId::mapper)};
      break;
    case ThreadId::render:
      plan.spec.rate_hz = setup.config.panel.refresh_hz;
      plan.stages = {painting.get(), showing.get()};
      plan.ledgers = {ledger(StageId::painter), ledger(StageId::panel)};
      break;
    case ThreadId::session:
      plan.stages = {setup.session};
      plan.ledgers = {ledger(StageId::session)};
      break;
  }
  return plan;
}

void Cart::State::watch(ThreadPlan& plan) {
  if (setup.traced > 0) plan.trace = traces.emplace_back(std::make_unique<TraceRing>(setup.traced)).get();
  if (setup.wrapper == nullptr) return;
  for (std::size_t i = 0; i < plan.stages.size(); ++i) {
    const auto id = static_cast<StageId>(plan.ledgers[i] - ledgers.data());
    plan.stages[i] = &setup.wrapper->around(plan.spec, id, *plan.stages[i]);
  }
}

std::vector<ThreadPlan> Cart::State::plans() {
  std::vector<ThreadPlan> all;
  for (const ThreadId id :
       {ThreadId::pedal, ThreadId::tracker, ThreadId::camera, ThreadId::mapping, ThreadId::render}) {
    all.push_back(plan(id));
  }
  if (setup.session != nullptr) all.push_back(plan(ThreadId::session));
  for (ThreadPlan& one : all) watch(one);
  return all;
}

Result<std::unique_ptr<Cart>> Cart::create(const Setup& setup) {
  auto context = GlContext::create(setup.display);
  if (!context) return tl::unexpected(context.error());
  auto state = std::make_unique<State>(setup, std::move(*context));
  if (auto built = state->build_painting(); !built) return tl::unexpected(built.error());
  if (auto built = state->build_tracker(); !built) return tl::unexpected(built.error());
  state->warm_up();
  return std::unique_ptr<Cart>(new Cart(std::move(state)));
}

Cart::Cart(std::unique_ptr<State> state) : state_(std::move(state)) {}
Cart::~Cart() {
  stop();
}

Result<void> Cart::start() {
  State& s = *state_;
  s.lacks = lock_process_memory().lacks;
  s.build_stages();
  if (auto streaming = s.setup.ports.camera.start(); !streaming) {
    return fail("the camera does not start: " + std::string(word_for(streaming.error())));
  }
  s.context.release_current();
  s.running = true;
  for (ThreadPlan& plan : s.plans()) {
    s.threads.push_back(std::make_unique<WorkerThread>(std::move(plan), s.setup.clock));
    WorkerThread& thread = *s.threads.back();
    if (auto started = thread.start(); !started) {
      stop();
      return started;
    }
    s.thread_ledgers.push_back(&thread.ledger());
    for (const std::string& lack : thread.rights().lacks) s.lacks.push_back(lack);
  }
  if (!s.lacks.empty()) s.showing->tell_degraded();  // known only now: each thread asks for its own rights
  return {};
}

void Cart::stop() noexcept {
  State& s = *state_;
  if (!s.running) return;
  s.running = false;
  for (std::size_t i = s.threads.size(); i > 0; --i) s.threads[i - 1]->stop();
  if (s.setup.session != nullptr) (void)s.setup.session->step(s.setup.clock.now());
  s.setup.ports.camera.stop();
  unlock_process_memory();
  (void)s.context.make_current();
}

void Cart::run_simulated(SimulatedClock& clock, Instant end) {
  State& s = *state_;
  if (!s.runner) {
    s.build_stages();
    (void)s.setup.ports.camera.start();
    s.running = true;
    std::vector<ThreadPlan> plans = s.plans();
    const std::size_t count = plans.size();
    s.runner = std::make_unique<SimulatedRunner>(std::move(plans), clock);
    for (std::size_t i = 0; i < count; ++i) s.thread_ledgers.push_back(&s.runner->ledger(i));
  }
  s.runner->run_until(end);
}

const Ledger<FrameRecord>& Cart::frames() const {
  return state_->frames;
}
const Ledger<CaptureRecord>& Cart::captures() const {
  return state_->captures;
}
const std::array<StageLedger, kStageCount>& Cart::stage_ledgers() const {
  return state_->ledgers;
}
const std::vector<ThreadLedger const*>& Cart::thread_ledgers() const {
  return state_->thread_ledgers;
}
const std::vector<std::unique_ptr<TraceRing>>& Cart::traces() const {
  return state_->traces;
}
const std::vector<std::string>& Cart::lacks() const {
  return state_->lacks;
}
RenderClass Cart::render_class() const {
  return state_->context.render_class();
}
const GlContext& Cart::context() const {
  return state_->context;
}
Painter& Cart::painter() {
  return *state_->painter;
}

const Status& Cart::status() const {
  return state_->showing->status();
}

CartFigures Cart::figures() const {
  const State& s = *state_;
  const DriverCounters& tracker = s.driver->counters();
  CartFigures figures;
  figures.tracker_polls = tracker.polls;
  figures.tracker_bad_crc = tracker.crc_bad;
  for (const std::uint64_t missing : tracker.missing) figures.tracker_missing += missing;
  figures.queue_drops = s.lanes.poses.dropped() + s.lanes.pedal.dropped() + s.lanes.frames.dropped() +
                        s.lanes.orders.dropped() + s.lanes.selected.dropped();
  figures.sequence_gaps = s.camera ? s.camera->health().lost : 0;
  figures.frames_taken = s.camera ? s.camera->health().frames : 0;
  figures.panel_pictures = s.showing ? s.showing->presented() : 0;
  return figures;
}

Cart::Now Cart::now() const {
  const State& s = *state_;
  Now now{.frames = s.frames.size(), .captures = s.captures.size()};
  if (!s.showing) return now;
  now.coverage = s.showing->coverage();
  now.camera = s.camera->fault();
  now.pedal = s.pedal->fault();
  now.panel = s.showing->fault();
  now.mismatch_deg = s.sync->mismatch_deg();
  const TrackerState tracker = s.tracker->state();
  if (tracker.trouble != TrackerTrouble::none) now.tracker = s.driver->trouble_sentence(tracker);
  now.tracker_remark = s.driver->remark(tracker);
  if (s.encoder) now.encoder = s.encoder->fault();
  if (s.setup.session != nullptr) {
    now.session_lost = s.setup.session->lost();
    now.session_failing = s.setup.session->failing();
  }
  return now;
}

}  // namespace orcart
