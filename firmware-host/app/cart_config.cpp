// Reads cart.toml, section by section; the errors of all sections are told together.
#include "firmware-host/app/cart_config.hpp"

#include "firmware-host/files/toml_reader.hpp"

namespace orcart {
namespace {

void read_files(TomlReader& reader, CartConfig& config) {
  const TomlSection top = reader.top();
  config.name = top.text("name", "cart");
  const TomlSection surface = reader.section("surface");
  config.surface = surface.path("file");
  config.seen_from = surface.choice_of<SeenFrom>(
      "seen_from", {{"outside", SeenFrom::outside}, {"inside", SeenFrom::inside}});
  config.texel_mm = surface.number("texel_mm", {.min = 0.05, .max = 2, .fallback = 0.2});
  const TomlSection scope = reader.section("scope");
  config.scope = scope.path("file");
  const TomlSection registration = reader.section("registration");
  config.registration = registration.path("file");
}

void read_camera(const TomlSection& section, CameraConfig& camera) {
  camera.kind = section.choice("kind", {"simulated"});
  camera.width_px = static_cast<int>(section.integer("width_px", {.min = 64, .max = 4096, .fallback = 640}));
  camera.height_px =
      static_cast<int>(section.integer("height_px", {.min = 64, .max = 4096, .fallback = 480}));
  camera.format = section.choice_of<PixelFormat>(
      "format", {{"yuyv", PixelFormat::yuyv}, {"nv12", PixelFormat::nv12}}, PixelFormat::yuyv);
  camera.rate_hz = section.number("rate_hz", {.min = 5, .max = 240, .fallback = 30});
  camera.exposure_ms = section.number("exposure_ms", {.min = 0.1, .max = 100, .fallback = 8});
  camera.stamp = section.choice_of<StampMeaning>("stamp",
                                                 {{"start_of_exposure", StampMeaning::start_of_exposure},
                                                  {"end_of_exposure", StampMeaning::end_of_exposure}},
                                                 StampMeaning::end_of_exposure);
  if (camera.exposure_ms > 1000 / camera.rate_hz) {
    section.refuse("exposure_ms", "is longer than the period of rate_hz; at most " +
                                      std::to_string(1000 / camera.rate_hz) + " is accepted");
  }
}

void read_panel(const TomlSection& section, PanelConfig& panel) {
  panel.width_px = static_cast<int>(section.integer("width_px", {.min = 640, .max = 3840, .fallback = 1280}));
  panel.height_px =
      static_cast<int>(section.integer("height_px", {.min = 480, .max = 2400, .fallback = 800}));
  panel.refresh_hz = section.number("refresh_hz", {.min = 10, .max = 240, .fallback = 60});
}

void read_simulation(const TomlSection& section, SimulationConfig& simulation) {
  simulation.seed = static_cast<std::uint64_t>(section.integer("seed", {.min = 0, .fallback = 1}));
  simulation.duration_s = section.number("duration_s", {.min = 2, .max = 3600, .fallback = 30});
  simulation.marker_noise_mm = section.number("marker_noise_mm", {.min = 0, .max = 2, .fallback = 0.05});
  simulation.picture_noise = section.flag("picture_noise", true);
  simulation.movie = section.path("movie", std::filesystem::path{});
  simulation.entry_direction = section.numbers("entry_direction", 3, simulation.entry_direction);
}

}  // namespace

Result<CartConfig> read_cart(const std::filesystem::path& file) {
  auto opened = TomlReader::open(file);
  if (!opened) return tl::unexpected(opened.error());
  TomlReader& reader = **opened;
  CartConfig config;
  config.file = file;
  read_files(reader, config);
  read_tracker(reader.section("tracker"), config.tracker);
  read_camera(reader.section("camera"), config.camera);
  read_panel(reader.section("panel"), config.panel);
  read_simulation(reader.section("simulation"), config.simulation);
  const TomlSection sync = reader.section("sync");
  config.tracker_against_video = from_seconds(
      1e-3 * sync.number("tracker_against_video_ms", {.min = -500, .max = 500, .fallback = 0.0}));
  const TomlSection painting = reader.section("painting");
  config.mode = painting.choice_of<TextureMode>(
      "mode", {{"perspective", TextureMode::perspective}, {"paper", TextureMode::paper}},
      TextureMode::perspective);
  const TomlSection view = reader.section("view");
  config.view_from = view.numbers("from", 3, config.view_from);
  config.view_up = view.numbers("up", 3, config.view_up);
  if (auto finished = reader.finish(); !finished) return tl::unexpected(finished.error());
  return config;
}

}  // namespace orcart
