// The simulated world is made only where a simulated device wants it.
#include "firmware-host/app/devices.hpp"

#include "board/sim/simulated_panel.hpp"
#include "firmware-host/app/open_camera.hpp"
#include "firmware-host/app/open_encoder.hpp"
#include "firmware-host/app/open_panel.hpp"
#include "firmware-host/app/open_pedal.hpp"
#include "firmware-host/app/open_tracker.hpp"

namespace orcart {
namespace {

/// A panel that nobody plugged in: seen in a window, or in pictures taken every ten seconds.
struct UnseenPanel {
  static constexpr int kPictures = 6;

  UnseenPanel(const PanelConfig& config, Clock& clock, PanelObserver* preview)
      : mode{.width_px = config.width_px, .height_px = config.height_px, .refresh_hz = config.refresh_hz},
        pictures(mode, instants(clock.now())),
        observers{&pictures},
        panel(clock, {.mode = mode, .first_vblank = clock.now() + 7ms}, with(preview)) {}

  static std::vector<Instant> instants(Instant from) {
    std::vector<Instant> all;
    for (int i = 1; i <= kPictures; ++i) all.push_back(from + i * 10s);
    return all;
  }
  std::vector<PanelObserver*>& with(PanelObserver* preview) {
    if (preview != nullptr) observers.push_back(preview);
    return observers;
  }

  PanelMode mode;
  PanelPictures pictures;
  std::vector<PanelObserver*> observers;
  SimulatedPanel panel;
};

}  // namespace

struct Devices::State {
  std::unique_ptr<ByteLink> tracker;
  std::unique_ptr<FrameSource> camera;
  std::unique_ptr<GpioLines> pedal;
  std::unique_ptr<TurnEncoder> encoder;
  OpenedPanel panel;
  std::unique_ptr<UnseenPanel> unseen;
  std::unique_ptr<SimulatedDevices> simulated;
  std::vector<std::string> notes;
  Instant start{}, end = Instant::max();
  bool measured_world = false;

  Result<void> open_real(const Request& request);
  Result<void> open_simulated(const Request& request);
  Result<void> open_panels(const Request& request);
};

Result<void> Devices::State::open_real(const Request& request) {
  const CartConfig& config = request.config;
  auto link = open_tracker(config.tracker, request.clock);
  if (!link) return tl::unexpected(link.error());
  tracker = std::move(*link);
  auto source = open_camera(config.camera, request.clock);
  if (!source) return tl::unexpected(source.error());
  camera = std::move(*source);
  auto lines = open_pedal(config.pedal, request.clock,
                          request.preview != nullptr ? &request.preview->pedal() : nullptr);
  if (!lines) return tl::unexpected(lines.error());
  pedal = std::move(*lines);
  if (config.turn != TurnSource::encoder) return {};
  auto knob = open_encoder(config.encoder, request.clock);
  if (!knob) return tl::unexpected(knob.error());
  encoder = std::move(*knob);
  return {};
}

Result<void> Devices::State::open_simulated(const Request& request) {
  auto made = SimulatedDevices::create({.config = request.config,
                                        .patient = request.patient,
                                        .clock = request.clock,
                                        .preview = request.preview ? &request.preview->observer() : nullptr,
                                        .pedal = request.preview ? &request.preview->pedal() : nullptr,
                                        .drawing = request.drawing,
                                        .tracker = tracker.get(),
                                        .camera = camera.get(),
                                        .real_pedal = pedal.get(),
                                        .real_encoder = encoder.get()});
  if (!made) return tl::unexpected(made.error());
  simulated = std::move(*made);
  start = simulated->start();
  end = simulated->end();
  measured_world = !tracker && !camera;
  return {};
}

Result<void> Devices::State::open_panels(const Request& request) {
  PanelConfig& config = request.config.panel;
  if (request.panel != PanelKind::kms) {
    if (!simulated)
      unseen = std::make_unique<UnseenPanel>(config, request.clock,
                                             request.preview ? &request.preview->observer() : nullptr);
    return {};
  }
  auto opened = open_panel(config, request.clock);
  if (!opened) return tl::unexpected(opened.error());
  panel = std::move(*opened);
  config.refresh_hz = panel.panel->mode().refresh_hz;
  notes.push_back(panel.sentence);
  return {};
}

Result<std::unique_ptr<Devices>> Devices::open(const Request& request) {
  auto state = std::make_unique<State>();
  state->start = request.clock.now();
  if (request.run_for) state->end = state->start + *request.run_for;
  if (auto opened = state->open_real(request); !opened) return tl::unexpected(opened.error());
  if (!state->tracker || !state->camera || !state->pedal) {
    if (auto made = state->open_simulated(request); !made) return tl::unexpected(made.error());
  }
  if (auto opened = state->open_panels(request); !opened) return tl::unexpected(opened.error());
  return std::unique_ptr<Devices>(new Devices(std::move(state)));
}

Devices::Devices(std::unique_ptr<State> state) : state_(std::move(state)) {}
Devices::~Devices() = default;

Ports Devices::ports() {
  State& s = *state_;
  if (!s.simulated) {
    Panel& panel = s.panel.panel ? *s.panel.panel : static_cast<Panel&>(s.unseen->panel);
    return {.tracker = *s.tracker,
            .camera = *s.camera,
            .pedal = *s.pedal,
            .panel = panel,
            .encoder = s.encoder.get()};
  }
  const Ports ports = s.simulated->ports();
  return {.tracker = ports.tracker,
          .camera = ports.camera,
          .pedal = ports.pedal,
          .panel = s.panel.panel ? *s.panel.panel : ports.panel,
          .encoder = ports.encoder};
}

NativeDisplay Devices::display() const {
  return state_->panel.display;
}
Instant Devices::start() const {
  return state_->start;
}
Instant Devices::end() const {
  return state_->end;
}
const SimulatedWorld* Devices::truth() const {
  return state_->measured_world ? &state_->simulated->world() : nullptr;
}
std::vector<Picture> Devices::panel_pictures() const {
  if (state_->panel.panel) return {};
  return state_->simulated ? state_->simulated->pictures().kept() : state_->unseen->pictures.kept();
}
const std::vector<std::string>& Devices::notes() const {
  return state_->notes;
}

}  // namespace orcart
