// cart.toml: which devices, tools, files and settings this cart has.
#pragma once

#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "firmware-host/app/device_config.hpp"
#include "firmware-host/app/tracker_config.hpp"
#include "firmware-host/files/passport_check.hpp"
#include "realtime/base/instant.hpp"
#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "realtime/mapper/cutout_patch.hpp"
#include "realtime/sync/notch_turn.hpp"
#include "render/atlas/colouring.hpp"
#include "render/atlas/paint_settings.hpp"

namespace orcart {

struct SimulationConfig {
  std::uint64_t seed = 1;
  double duration_s = 30;
  double marker_noise_mm = 0.05;
  bool picture_noise = true;                               ///< sensor noise, motion blur, specular highlights
  std::filesystem::path movie;                             ///< where the drawn pictures are kept between runs
  std::vector<double> entry_direction = {0.4, -0.6, 0.7};  ///< from the surface's centre to the burr hole, M
  double turn_rad = 0;      ///< how far the light post is turned to and fro, to each side
  double turn_every_s = 8;  ///< once to and fro
};

struct CartConfig {
  std::filesystem::path file;  ///< where this came from; relative paths in it start there
  std::string name = "cart";
  std::filesystem::path surface, scope, registration;
  PassportWish passport;
  TurnSource turn = TurnSource::told;
  /// Of the light post since the passport was made, for the whole run or at the start of an encoder's;
  /// nothing: not said.
  std::optional<double> turn_rad;
  std::optional<double>
      turn_deviation_rad;  ///< standard deviation of the turn, however it is known; not told
  double most_mismatch_rad =
      2 * std::numbers::pi / 180;  ///< between the turn and the notch, where both are there
  SeenFrom seen_from = SeenFrom::outside;
  double texel_mm = 0.2;
  TextureMode mode = TextureMode::perspective;
  PaintPolicy policy = PaintPolicy::newest;
  Highlights highlights = Highlights::yield;
  LightModel light = LightModel::auto_exposure;
  ColourBy colour_by = ColourBy::picture;  ///< what the panel shows
  TrackerConfig tracker;
  CameraConfig camera;
  PedalConfig pedal;
  EncoderConfig encoder;  ///< turn = encoder
  PanelConfig panel;
  Nanos tracker_against_video{};  ///< [sync]: added to a frame's mid-exposure before poses are looked up
  std::optional<double> time_deviation_s;      ///< standard deviation of it; nothing: not told
  std::vector<double> view_from = {0, -1, 0};  ///< from the surface's centre to the eye, M
  std::vector<double> view_up = {0, 0, 1};
  SimulationConfig simulation;

  /// RMS of one marker's 3-D error: as stated, or as simulated on each axis.
  double marker_rms_mm() const {
    return tracker.kind == TrackerKind::simulated ? std::numbers::sqrt3 * simulation.marker_noise_mm
                                                  : tracker.marker_rms_mm;
  }
  /// Whether any input is none of the operating room's: every view then wears a mark.
  bool simulated() const {
    return !is_device(tracker.kind) || camera.kind == CameraKind::simulated ||
           pedal.kind == PedalKind::simulated ||
           (turn == TurnSource::encoder && encoder.kind == EncoderKind::simulated);
  }
  /// Whether a device's own time passes in this cart: it needs the wall clock.
  bool any_device() const {
    return is_device(tracker.kind) || camera.kind != CameraKind::simulated || pedal.kind == PedalKind::gpio ||
           pedal.kind == PedalKind::keyboard ||
           (turn == TurnSource::encoder && encoder.kind == EncoderKind::evdev);
  }
};

/// Every error at once, each with its line; unknown keys are refused.
Result<CartConfig> read_cart(const std::filesystem::path& file);

}  // namespace orcart
