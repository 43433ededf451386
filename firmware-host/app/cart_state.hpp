// What a cart owns. For cart_building.cpp, which makes it, and cart.cpp, which runs it.
#pragma once

#include "firmware-host/app/cart.hpp"
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

struct Cart::State {
  State(const Setup& from, GlContext gl);

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

}  // namespace orcart
