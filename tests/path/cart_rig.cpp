// The demo's files, made smaller.
#include "tests/path/cart_rig.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>

namespace orcart::testing {
namespace {

std::filesystem::path folder_of(const char* variable) {
  const char* folder = std::getenv(variable);
  return folder != nullptr ? folder : std::filesystem::current_path();
}

/// The shipped angled scope, looking off its shaft by another angle: written where a patient is read from.
std::filesystem::path passport_of(const AngledWish& wish) {
  auto scope = read_scope(folder_of("ORCART_SOURCE_DIR") / "share/scopes/neuro-30.toml");
  if (!scope) return {};
  const double more_rad = wish.view_deg * std::numbers::pi / 180 - scope->turning->view_angle_rad;
  scope->X_SC.rotation *= Eigen::AngleAxisd(more_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
  scope->turning->view_angle_rad += more_rad;
  const auto file = folder_of("ORCART_BINARY_DIR") / ("angled-" + std::to_string(getpid()) + ".toml");
  return write_scope(file, *scope) ? file : std::filesystem::path();
}

}  // namespace

RigWish presses() {
  return {.duration_s = 5.4,
          .script = {.press_every_s = 1.6, .undo_at = 0.4, .stream_at = -1, .hide_at = 0.8},
          .more_presses = {4950ms}};
}

RigWish stream() {
  return {.duration_s = 4.8,
          .script = {.press_every_s = 1.6, .undo_at = -1, .stream_at = 0.5, .hide_at = -1},
          .more_presses = {4350ms, 4580ms}};
}

std::unique_ptr<CartRig> CartRig::create(const RigWish& wish) {
  auto rig = std::make_unique<CartRig>();
  auto config = read_cart(folder_of("ORCART_SOURCE_DIR") /
                          (wish.angled ? "share/carts/demo-angled.toml" : "share/carts/demo.toml"));
  if (!config) {
    ADD_FAILURE() << config.error().message;
    return nullptr;
  }
  rig->config = std::move(*config);
  rig->config.texel_mm = wish.texel_mm;
  rig->config.panel = {.width_px = 640, .height_px = 480, .refresh_hz = 20};
  rig->config.camera.rate_hz = wish.camera_hz;
  rig->config.simulation.duration_s = wish.duration_s;
  rig->config.simulation.marker_noise_mm = 0;
  rig->config.simulation.picture_noise = false;
  rig->config.simulation.movie = folder_of("ORCART_BINARY_DIR") / "movies-of-tests";
  if (wish.angled) {
    rig->config.scope = passport_of(*wish.angled);
    rig->config.turn = wish.angled->follow;
    if (wish.angled->follow == TurnSource::told || wish.angled->follow == TurnSource::encoder)
      rig->config.turn_rad = wish.angled->told_rad;
    rig->config.most_mismatch_rad = wish.angled->most_mismatch_deg * std::numbers::pi / 180;
    rig->config.tracker.second = wish.angled->follow == TurnSource::marker;
    rig->config.simulation.marker_noise_mm = wish.angled->marker_noise_mm;
    rig->config.simulation.turn_rad = wish.script.turn_rad;
    rig->config.simulation.turn_every_s = wish.script.turn_every_s;
  }
  auto patient = read_patient(rig->config);
  if (wish.angled) std::filesystem::remove(rig->config.scope);
  if (!patient) {
    ADD_FAILURE() << patient.error().message;
    return nullptr;
  }
  rig->patient = std::move(*patient);
  auto devices =
      SimulatedDevices::create({.config = rig->config,
                                .patient = rig->patient,
                                .clock = rig->clock,
                                .pictures = 1,
                                .drawing = {},
                                .script = wish.script,
                                .camera_faults = wish.camera_faults,
                                .encoder_faults = wish.angled ? wish.angled->encoder : EncoderFaults{},
                                .more_presses = wish.more_presses});
  if (!devices) {
    ADD_FAILURE() << devices.error().message;
    return nullptr;
  }
  rig->devices = std::move(*devices);
  if (wish.holds.empty()) return rig;
  GpioScript pedal;
  for (const Stretch& hold : wish.holds) {
    pedal.edges.push_back({.at = rig->at(hold.from), .kind = EdgeKind::pressed});
    pedal.edges.push_back({.at = rig->at(hold.until), .kind = EdgeKind::released});
  }
  rig->held_pedal = std::make_unique<SimulatedGpio>(rig->clock, pedal);
  return rig;
}

bool CartRig::arm(SessionStage* session, StageWrapper* wrapper, std::size_t traced) {
  const Ports ports = devices->ports();
  camera = std::make_unique<LentFrames>(ports.camera);
  auto made =
      Cart::create({.config = config,
                    .patient = patient,
                    .ports = {.tracker = ports.tracker,
                              .camera = *camera,
                              .pedal = held_pedal ? static_cast<GpioLines&>(*held_pedal) : ports.pedal,
                              .panel = ports.panel,
                              .encoder = ports.encoder},
                    .clock = clock,
                    .session = session,
                    .longest_run_s = 20,
                    .wrapper = wrapper,
                    .traced = traced});
  if (!made) {
    ADD_FAILURE() << made.error().message;
    return false;
  }
  cart = std::move(*made);
  return true;
}

void CartRig::run_until(Nanos since_start) {
  cart->run_simulated(clock, at(since_start));
}

Nanos CartRig::until(Instant from, const std::function<bool(const Status&)>& holds) {
  while (clock.now() < devices->end()) {
    cart->run_simulated(clock, clock.now() + 5ms);
    if (holds(cart->status())) return clock.now() - from;
  }
  return Nanos::max();
}

}  // namespace orcart::testing
