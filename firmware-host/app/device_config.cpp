// What the simulated device and the real one have in common first, then each kind's own keys.
#include "firmware-host/app/device_config.hpp"

#include <charconv>
#include <numbers>

namespace orcart {
namespace {

/// "gain=20" becomes a control.
void read_controls(const TomlSection& section, CameraWish& wish) {
  for (const std::string& text : section.texts("controls", std::vector<std::string>{})) {
    const auto equals = text.find('=');
    CameraWish::Control control{.name = text.substr(0, equals)};
    const char* begin = equals == std::string::npos ? text.data() + text.size() : text.data() + equals + 1;
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(begin, end, control.value);
    if (control.name.empty() || read.ec != std::errc{} || read.ptr != end) {
      section.refuse("controls", "holds \"" + text +
                                     "\"; NAME=NUMBER as orcart probe lists them, e.g. "
                                     "\"gain=20\", would be accepted");
      return;
    }
    wish.controls.push_back(std::move(control));
  }
}

void read_v4l2(const TomlSection& section, CameraConfig& camera) {
  CameraWish& wish = camera.device;
  wish.device = section.text("device");
  wish.format = section.choice_of<WireFormat>("format",
                                              {{"yuyv", WireFormat::yuyv},
                                               {"uyvy", WireFormat::uyvy},
                                               {"nv12", WireFormat::nv12},
                                               {"mjpeg", WireFormat::mjpeg}},
                                              WireFormat::yuyv);
  wish.field = section.choice_of<FieldChoice>(
      "field",
      {{"progressive", FieldChoice::progressive}, {"top", FieldChoice::top}, {"bottom", FieldChoice::bottom}},
      FieldChoice::progressive);
  read_controls(section, wish);
  camera.format = picture_format(wish.format);
  wish.width_px = camera.width_px;
  wish.height_px = camera.height_px;
  wish.rate_hz = camera.rate_hz;
  camera.stamp =
      section.choice_of<StampMeaning>("stamp", {{"start_of_exposure", StampMeaning::start_of_exposure},
                                                {"end_of_exposure", StampMeaning::end_of_exposure},
                                                {"start_of_readout", StampMeaning::start_of_readout},
                                                {"end_of_readout", StampMeaning::end_of_readout},
                                                {"dequeued", StampMeaning::dequeued}});
  camera.after_exposure_ms = section.number("after_exposure_ms", {.min = 0, .max = 500, .fallback = 0.0});
  if (wish.format == WireFormat::mjpeg && wish.field != FieldChoice::progressive)
    section.refuse("field", "goes with uncompressed formats; mjpeg is progressive");
}

void read_simulated(const TomlSection& section, CameraConfig& camera) {
  camera.format = section.choice_of<PixelFormat>(
      "format", {{"yuyv", PixelFormat::yuyv}, {"nv12", PixelFormat::nv12}}, PixelFormat::yuyv);
  camera.stamp = section.choice_of<StampMeaning>("stamp",
                                                 {{"start_of_exposure", StampMeaning::start_of_exposure},
                                                  {"end_of_exposure", StampMeaning::end_of_exposure}},
                                                 StampMeaning::end_of_exposure);
}

ActiveLevel read_level(const TomlSection& section, std::string_view key) {
  return section.choice_of<ActiveLevel>(key, {{"high", ActiveLevel::high}, {"low", ActiveLevel::low}},
                                        ActiveLevel::high);
}

void read_gpio(const TomlSection& section, GpioWish& gpio) {
  gpio.chip = section.text("chip");
  gpio.line = section.text("line");
  gpio.bias = section.choice_of<LineBias>("bias",
                                          {{"as_is", LineBias::as_is},
                                           {"pull_up", LineBias::pull_up},
                                           {"pull_down", LineBias::pull_down},
                                           {"disabled", LineBias::disabled}},
                                          LineBias::as_is);
  gpio.pressed = read_level(section, "pressed");
  if (!section.has("trigger_line")) return;
  gpio.trigger_line = section.text("trigger_line");
  gpio.raised = read_level(section, "trigger_raised");
}

}  // namespace

void read_camera(const TomlSection& section, CameraConfig& camera) {
  const auto kind =
      section.kind_of<CameraKind>("kind", {{"simulated", CameraKind::simulated}, {"v4l2", CameraKind::v4l2}});
  if (!kind) return;
  camera.kind = *kind;
  camera.width_px = static_cast<int>(section.integer("width_px", {.min = 64, .max = 4096, .fallback = 640}));
  camera.height_px =
      static_cast<int>(section.integer("height_px", {.min = 64, .max = 4096, .fallback = 480}));
  camera.rate_hz = section.number("rate_hz", {.min = 5, .max = 240, .fallback = 30});
  camera.exposure_ms = section.number("exposure_ms", {.min = 0.1, .max = 100, .fallback = 8});
  if (camera.exposure_ms > 1000 / camera.rate_hz) {
    section.refuse("exposure_ms", "is longer than the period of rate_hz; at most " +
                                      std::to_string(1000 / camera.rate_hz) + " is accepted");
  }
  if (camera.kind == CameraKind::v4l2) {
    read_v4l2(section, camera);
  } else {
    read_simulated(section, camera);
  }
}

void read_pedal(const TomlSection& section, PedalConfig& pedal) {
  const auto kind = section.kind_of<PedalKind>("kind",
                                               {{"simulated", PedalKind::simulated},
                                                {"gpio", PedalKind::gpio},
                                                {"keyboard", PedalKind::keyboard},
                                                {"none", PedalKind::none}},
                                               PedalKind::simulated);
  pedal.kind = kind.value_or(PedalKind::none);  // a refused one is not complained of as simulated too
  if (pedal.kind == PedalKind::gpio) read_gpio(section, pedal.gpio);
  if (pedal.kind != PedalKind::keyboard) return;
  pedal.keyboard = {.device = section.text("device"), .key = section.text("key")};
  if (!pedal.keyboard.key.empty() && !key_code_of(pedal.keyboard.key))
    section.refuse("key",
                   "\"" + pedal.keyboard.key + "\" is unknown; " + known_keys() + " would be accepted");
}

EncoderScale scale_of(const EncoderConfig& encoder) {
  const double rad_per_count = 2 * std::numbers::pi / static_cast<double>(encoder.counts_per_turn);
  return {.rad_per_count = encoder.rise == CountsRise::clockwise ? rad_per_count : -rad_per_count,
          .counts_at_zero = encoder.counts_at_zero.value_or(0)};
}

// A turn of the picture is from x towards y, which goes clockwise as it is seen.
void read_encoder(const TomlSection& section, EncoderConfig& encoder) {
  const auto kind = section.kind_of<EncoderKind>(
      "kind", {{"simulated", EncoderKind::simulated}, {"evdev", EncoderKind::evdev}});
  encoder.kind = kind.value_or(EncoderKind::evdev);  // a refused one is not complained of as simulated too
  if (!kind) return;
  encoder.counts_per_turn = section.integer("counts_per_turn", {.min = 90, .max = 10'000'000});
  encoder.rise = section.choice_of<CountsRise>(
      "counts_rise", {{"clockwise", CountsRise::clockwise}, {"anticlockwise", CountsRise::anticlockwise}});
  if (encoder.kind == EncoderKind::simulated) {
    if (encoder.rise != CountsRise::clockwise)
      section.refuse("counts_rise", "is \"anticlockwise\"; those of a simulated encoder rise clockwise");
    return;
  }
  encoder.device.device = section.text("device");
  encoder.device.axis = section.text("axis", "rel_dial");
  const auto axis = encoder_axis_of(encoder.device.axis);
  if (!encoder.device.axis.empty() && !axis)
    section.refuse("axis",
                   "\"" + encoder.device.axis + "\" is unknown; " + known_axes() + " would be accepted");
  if (!section.has("counts_at_zero")) return;
  encoder.counts_at_zero = section.integer("counts_at_zero");
  if (axis && axis->kind == AxisKind::relative)
    section.refuse("counts_at_zero", "stands beside " + encoder.device.axis +
                                         ", which knows no place of its own; an axis abs_... does");
}

void read_panel(const TomlSection& section, PanelConfig& panel) {
  panel.width_px = static_cast<int>(section.integer("width_px", {.min = 640, .max = 3840, .fallback = 1280}));
  panel.height_px =
      static_cast<int>(section.integer("height_px", {.min = 480, .max = 3840, .fallback = 800}));
  panel.refresh_hz = section.number("refresh_hz", {.min = 10, .max = 240, .fallback = 60});
  PanelWish& wish = panel.device;
  wish = {.width_px = panel.width_px, .height_px = panel.height_px, .refresh_hz = panel.refresh_hz};
  if (section.has("device")) wish.device = section.text("device");
  if (section.has("connector")) wish.connector = section.text("connector");
  if (section.has("tty")) wish.tty = section.text("tty");
  const auto degrees = section.integer("rotation_deg", {.min = 0, .max = 270, .fallback = 0});
  if (degrees % 90 != 0)
    section.refuse("rotation_deg", "is " + std::to_string(degrees) + "; 0, 90, 180 or 270 would be accepted");
  wish.rotation = static_cast<Rotation>(degrees);
  panel.buffers = section.choice_of<PanelBuffersWish>("buffers",
                                                      {{"auto", PanelBuffersWish::automatic},
                                                       {"mapped", PanelBuffersWish::mapped},
                                                       {"gpu", PanelBuffersWish::gpu}},
                                                      PanelBuffersWish::automatic);
}

}  // namespace orcart
