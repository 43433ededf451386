// Builds the stages along the way of the data, gives each its thread from the topology, and stops them
// backward.
#include "firmware-host/app/cart.hpp"

#include "firmware-host/app/turn_deviation.hpp"
#include "firmware-host/stages/camera_stage.hpp"
#include "firmware-host/stages/encoder_stage.hpp"
#include "firmware-host/stages/mapper_stage.hpp"
#include "firmware-host/stages/painter_stage.hpp"
#include "firmware-host/stages/panel_stage.hpp"
#include "firmware-host/stages/pedal_stage.hpp"
#include "firmware-host/stages/sync_stage.hpp"
#include "firmware-host/stages/tracker_stage.hpp"
#include "realtime/kernel/simulated_runner.hpp"
#include "realtime/kernel/worker_thread.hpp"
#include "render/views/screen.hpp"

namespace orcart {
namespace {

constexpr double kCapturesPerSecond = 10;  // on the average of a long run; more are counted as overflow

std::array<StageLedger, kStageCount> ledgers_for(RenderClass render_class) {
  const auto one = [&](StageId id) { return StageLedger(row_of(id).name, budget_of(id, render_class)); };
  return {one(StageId::pedal),   one(StageId::encoder), one(StageId::tracker),
          one(StageId::camera),  one(StageId::sync),    one(StageId::mapper),
          one(StageId::painter), one(StageId::panel),   one(StageId::session)};
}

Eigen::Vector3d vector_of(const std::vector<double>& xyz) {
  return {xyz[0], xyz[1], xyz[2]};
}

}  // namespace

struct Cart::State {
  State(const Setup& s, GlContext gl)
      : setup(s),
        context(std::move(gl)),
        lanes({.poses = kPoseQueueDepth,
               .pedal = kPedalQueueDepth,
               .frames = kFrameQueueDepth,
               .orders = kPaintQueueDepth,
               .patches = kPatchSlots,
               .encoder_angles = kEncoderQueueDepth}),
        frames(static_cast<std::size_t>(s.longest_run_s * s.config.camera.rate_hz) + 64),
        captures(static_cast<std::size_t>(s.longest_run_s * kCapturesPerSecond) + 64),
        ledgers(ledgers_for(context.render_class())) {}

  Setup setup;
  GlContext context;
  Lanes lanes;
  Ledger<FrameRecord> frames;
  Ledger<CaptureRecord> captures;
  std::array<StageLedger, kStageCount> ledgers;
  std::vector<CutoutPatch> patches;
  std::unique_ptr<Mapper> mapper;
  std::unique_ptr<Painter> painter;
  std::unique_ptr<ViewErrors> errors;
  std::unique_ptr<Screen> screen;
  std::unique_ptr<NdiDriver> driver;
  std::unique_ptr<PedalStage> pedal;
  std::unique_ptr<EncoderStage> encoder;  ///< null where the turn is not followed by one
  std::unique_ptr<TrackerStage> tracker;
  std::unique_ptr<TrackerWake> tracker_wake;
  std::unique_ptr<NotchSearch> notch;  ///< null where the turn is not followed by it
  std::unique_ptr<CameraStage> camera;
  std::unique_ptr<SyncStage> sync;
  std::unique_ptr<MapperStage> mapping;
  std::unique_ptr<PainterStage> painting;
  std::unique_ptr<PanelStage> showing;
  std::vector<std::unique_ptr<WorkerThread>> threads;
  std::vector<ThreadLedger const*> thread_ledgers;
  std::vector<std::unique_ptr<TraceRing>> traces;
  std::unique_ptr<SimulatedRunner> runner;
  std::vector<std::string> lacks;
  bool running = false;

  Result<void> build_painting();
  Result<void> build_tracker();
  ChainErrors chain_errors(const NdiSettings& driven) const;
  void build_stages();
  void warm_up();
  ThreadPlan plan(ThreadId id);
  std::vector<ThreadPlan> plans();
  void watch(ThreadPlan& plan);
  StageLedger* ledger(StageId id) { return &ledgers[static_cast<std::size_t>(id)]; }
};

Result<void> Cart::State::build_painting() {
  const Patient& patient = setup.patient;
  const CartConfig& config = setup.config;
  auto made_mapper = Mapper::create(patient.surface, config.seen_from, patient.scope);
  if (!made_mapper) return tl::unexpected(made_mapper.error());
  mapper = std::make_unique<Mapper>(std::move(*made_mapper));
  for (std::size_t i = 0; i < kPatchSlots; ++i) patches.emplace_back(patch_capacity({}));
  const bool imports = context.render_class() == RenderClass::gpu && context.can_import_dma_buf();
  auto made_painter = Painter::create(patient.surface, patient.layout, patient.scope,
                                      {.seen_from = config.seen_from,
                                       .policy = config.policy,
                                       .highlights = config.highlights,
                                       .light = config.light,
                                       .picture_copy = imports ? PictureCopy::gpu : PictureCopy::cpu,
                                       .paint_by = paint_by_for(context.render_class())});
  if (!made_painter) return tl::unexpected(made_painter.error());
  painter = std::make_unique<Painter>(std::move(*made_painter));
  auto made_screen = Screen::create(patient.surface, patient.layout, patient.scope,
                                    {.width_px = config.panel.width_px,
                                     .height_px = config.panel.height_px,
                                     .seen_from = config.seen_from,
                                     .colour_by = config.colour_by,
                                     .draw_by = paint_by_for(context.render_class())});
  if (!made_screen) return tl::unexpected(made_screen.error());
  screen = std::make_unique<Screen>(std::move(*made_screen));
  return {};
}

ChainErrors Cart::State::chain_errors(const NdiSettings& driven) const {
  const RegistrationFile& registration = setup.patient.registration;
  const std::optional<Turning>& turning = setup.patient.scope.turning;
  return {.marker_rms_mm = setup.config.marker_rms_mm(),
          .scope_markers_mm = ndi::markers_of(driven.tools[0].definition),
          .reference_markers_mm = ndi::markers_of(driven.tools[1].definition),
          .registration = registration.covariance,
          .registration_mm = registration.predicted_tre_mm,
          .time_s = setup.config.time_deviation_s.value_or(kAssumedErrors.time_s),
          .light_post_rad = turning ? turn_deviation_rad(setup.config, *turning, driven) : 0,
          .texel_mm = setup.patient.layout.texel_mm};
}

Result<void> Cart::State::build_tracker() {
  auto settings = settings_of(setup.config.tracker);
  if (!settings) return tl::unexpected(settings.error());
  errors = std::make_unique<ViewErrors>(setup.patient.scope, setup.patient.registration.X_MR,
                                        chain_errors(*settings));
  driver = std::make_unique<NdiDriver>(std::move(*settings), setup.ports.tracker);
  return {};
}

void Cart::State::build_stages() {
  const CartConfig& config = setup.config;
  const Patient& patient = setup.patient;
  const Nanos tracker_period = period_of(config.tracker.rate_hz);
  pedal = std::make_unique<PedalStage>(setup.ports.pedal, PedalSettings{}, lanes);
  if (setup.ports.encoder != nullptr)
    encoder = std::make_unique<EncoderStage>(*setup.ports.encoder, scale_of(config.encoder), lanes);
  tracker = std::make_unique<TrackerStage>(
      *driver,
      ClockFitSettings{.rate_hz = config.tracker.rate_hz,
                       .device_latency = from_seconds(config.tracker.latency_ms * 1e-3)},
      lanes);
  tracker_wake = std::make_unique<TrackerWake>(setup.ports.tracker, *driver);
  const bool by_notch = config.turn == TurnSource::notch;
  const bool compared = !by_notch && patient.scope.turning && patient.scope.notch_rad;
  if (by_notch || compared) notch = std::make_unique<NotchSearch>(patient.scope);
  camera = std::make_unique<CameraStage>(
      setup.ports.camera, setup.clock,
      StampSettings{.meaning = config.camera.stamp,
                    .exposure = from_seconds(config.camera.exposure_ms * 1e-3),
                    .after_exposure = from_seconds(config.camera.after_exposure_ms * 1e-3)},
      lanes, notch.get());
  sync = std::make_unique<SyncStage>(
      SyncStageSettings{
          .history = {.period = tracker_period,
                      .needs_turn = config.turn == TurnSource::marker || config.turn == TurnSource::encoder},
          .matcher = {.turn = config.turn, .tracker_against_video = config.tracker_against_video},
          .selector = {},
          .X_MR = patient.registration.X_MR,
          .scope = patient.scope,
          .encoder = {.told_rad = config.turn_rad, .absolute = config.encoder.counts_at_zero.has_value()},
          .most_mismatch_rad = compared ? std::optional(config.most_mismatch_rad) : std::nullopt,
          .painting_blocked = !patient.painting_blocked.empty()},
      lanes);
  mapping = std::make_unique<MapperStage>(
      *mapper, patches, setup.clock,
      MapperStageSettings{.mode = config.mode, .X_MR = patient.registration.X_MR, .scope = patient.scope},
      lanes);
  painting =
      std::make_unique<PainterStage>(PainterStage::Parts{.painter = *painter,
                                                         .lanes = lanes,
                                                         .patches = patches,
                                                         .captures = captures,
                                                         .errors = errors.get(),
                                                         .sink = setup.session,
                                                         .context = &context,
                                                         .buffer_count = setup.ports.camera.buffer_count()});
  const PathBudget budget = path_budget(context.render_class(), config.panel.refresh_hz);
  showing = std::make_unique<PanelStage>(
      PanelStage::Parts{.panel = setup.ports.panel,
                        .screen = *screen,
                        .painter = *painter,
                        .painter_stage = *painting,
                        .clock = setup.clock,
                        .lanes = lanes,
                        .frames = frames,
                        .captures = captures,
                        .stages = ledgers},
      PanelStageSettings{
          .eye = eye_on(patient.surface.mesh, vector_of(config.view_from), vector_of(config.view_up)),
          .simulated = config.simulated(),
          .software_rendering = context.render_class() == RenderClass::software,
          .degraded = !lacks.empty(),
          .turn = config.turn,
          .painting_blocked = patient.painting_blocked,
          .submit_deadline = budget.dequeue_to_submitted.bound,
          .freshness = {.tracker_period = tracker_period, .video_period = period_of(config.camera.rate_hz)}});
}

// The driver compiles its shaders and takes its memory at first use: that use is now, not at the first press.
void Cart::State::warm_up() {
  const auto pixels =
      packed_bytes(setup.config.camera.format, setup.config.camera.width_px, setup.config.camera.height_px);
  std::vector<std::byte> grey(pixels, std::byte{128});
  const auto& triangles = setup.patient.surface.mesh.triangles;
  CutoutPatch patch(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) patch.triangles.push_back(t);
  painter->upload(packed_image(grey.data(), setup.config.camera.format, setup.config.camera.width_px,
                               setup.config.camera.height_px));
  painter->paint(patch, 1);
  while (painter->undo()) {
  }
  std::vector<std::byte> panel(
      packed_bytes(PixelFormat::xrgb8888, setup.config.panel.width_px, setup.config.panel.height_px));
  ScreenState state{.eye = eye_on(setup.patient.surface.mesh, vector_of(setup.config.view_from),
                                  vector_of(setup.config.view_up))};
  state.X_MC = Pose<M, C>{};
  screen->draw(state, *painter,
               packed_image(panel.data(), PixelFormat::xrgb8888, setup.config.panel.width_px,
                            setup.config.panel.height_px));
  painter->clear();
  (void)painter->coverage();
}

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
  if (s.encoder) now.encoder = s.encoder->fault();
  return now;
}

}  // namespace orcart
