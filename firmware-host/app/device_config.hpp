// [camera], [pedal], [encoder] and [panel] of cart.toml: which device each of them is, and how it is set.
#pragma once

#include <cstdint>
#include <optional>

#include "board/linux/encoder/evdev_encoder.hpp"
#include "board/linux/kms/panel_choice.hpp"
#include "board/linux/pedal/keyboard_pedal.hpp"
#include "board/linux/pedal/requested_lines.hpp"
#include "board/linux/v4l2/camera_offer.hpp"
#include "firmware-host/camera/stamp_meaning.hpp"
#include "firmware-host/files/toml_reader.hpp"
#include "firmware-host/stages/encoder_stage.hpp"
#include "realtime/base/image.hpp"

namespace orcart {

enum class CameraKind : std::uint8_t { simulated, v4l2 };

struct CameraConfig {
  CameraKind kind = CameraKind::simulated;
  int width_px = 640, height_px = 480;
  PixelFormat format = PixelFormat::yuyv;  ///< of the cart's pictures
  double rate_hz = 30;
  double exposure_ms = 8;
  StampMeaning stamp = StampMeaning::end_of_exposure;
  double after_exposure_ms = 0;  ///< readout and dequeue meanings: from the exposure's end to the stamp
  CameraWish device;             ///< v4l2
};

/// none: no pedal; the space bar of `--panel window` presses, or nobody does.
enum class PedalKind : std::uint8_t { simulated, gpio, keyboard, none };

struct PedalConfig {
  PedalKind kind = PedalKind::simulated;
  GpioWish gpio;
  KeyboardWish keyboard;
};

enum class EncoderKind : std::uint8_t { simulated, evdev };
/// Which way the picture goes round, as it is seen, while the counts rise.
enum class CountsRise : std::uint8_t { clockwise, anticlockwise };

struct EncoderConfig {
  EncoderKind kind = EncoderKind::simulated;
  EncoderWish device;  ///< evdev
  std::int64_t counts_per_turn = 4096;
  CountsRise rise = CountsRise::clockwise;
  /// What an absolute encoder says at the passport's turn; nothing: it is a relative one.
  std::optional<std::int64_t> counts_at_zero;
};
EncoderScale scale_of(const EncoderConfig& encoder);

/// automatic: rendered on the GPU where there is one and it can be shown without a copy.
enum class PanelBuffersWish : std::uint8_t { automatic, mapped, gpu };

struct PanelConfig {
  int width_px = 1280, height_px = 800;
  double refresh_hz = 30;
  PanelWish device;  ///< `--panel kms`
  PanelBuffersWish buffers = PanelBuffersWish::automatic;
};

/// Keys of another kind than the stated one are unknown keys. Errors stay in the section's reader.
void read_camera(const TomlSection& section, CameraConfig& camera);
void read_pedal(const TomlSection& section, PedalConfig& pedal);
void read_encoder(const TomlSection& section, EncoderConfig& encoder);
void read_panel(const TomlSection& section, PanelConfig& panel);

}  // namespace orcart
