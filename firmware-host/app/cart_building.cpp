// Builds the stages along the way of the data, from the configuration and the patient.
#include "firmware-host/app/cart_state.hpp"
#include "firmware-host/app/turn_deviation.hpp"

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

Cart::State::State(const Setup& from, GlContext gl)
    : setup(from),
      context(std::move(gl)),
      lanes({.poses = kPoseQueueDepth,
             .pedal = kPedalQueueDepth,
             .frames = kFrameQueueDepth,
             .orders = kPaintQueueDepth,
             .patches = kPatchSlots,
             .encoder_angles = kEncoderQueueDepth}),
      frames(static_cast<std::size_t>(from.longest_run_s * from.config.camera.rate_hz) + 64),
      captures(static_cast<std::size_t>(from.longest_run_s * kCapturesPerSecond) + 64),
      ledgers(ledgers_for(context.render_class())) {}

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
                                                         .clock = setup.clock,
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
                        .stages = ledgers,
                        .sink = setup.session},
      PanelStageSettings{
          .eye = eye_on(patient.surface.mesh, vector_of(config.view_from), vector_of(config.view_up)),
          .simulated = config.simulated(),
          .software_rendering = context.render_class() == RenderClass::software,
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

}  // namespace orcart
