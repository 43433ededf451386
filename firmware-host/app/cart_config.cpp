// Reads cart.toml, section by section; the errors of all sections are told together.
#include "firmware-host/app/cart_config.hpp"

#include <Eigen/Geometry>
#include <numbers>

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
  if (scope.has("medium"))
    config.passport.medium = scope.choice_of<Medium>(
        "medium", {{"air", Medium::air}, {"water", Medium::water}, {"saline", Medium::saline}});
  if (scope.has("serial")) config.passport.serial = scope.text("serial");
  config.turn = scope.choice_of<TurnSource>("turn",
                                            {{"told", TurnSource::told},
                                             {"marker", TurnSource::marker},
                                             {"encoder", TurnSource::encoder},
                                             {"notch", TurnSource::notch}},
                                            TurnSource::told);
  if (scope.has("turn_deg")) {
    config.turn_rad = scope.number("turn_deg", {.min = -360, .max = 360}) * std::numbers::pi / 180;
    if (config.turn == TurnSource::marker || config.turn == TurnSource::notch)
      scope.refuse("turn_deg",
                   "stands beside turn = \"marker\" or \"notch\"; a turn is either told or followed");
  }
  if (scope.has("turn_deviation_deg"))
    config.turn_deviation_rad =
        scope.number("turn_deviation_deg", {.min = 0, .max = 20}) * std::numbers::pi / 180;
  config.passport.most_residual_px =
      scope.number("most_residual_px", {.min = 0.01, .max = 50, .fallback = 1.0});
  config.passport.most_residual_mm =
      scope.number("most_residual_mm", {.min = 0.01, .max = 50, .fallback = 2.0});
  config.most_mismatch_rad =
      scope.number("most_mismatch_deg", {.min = 0.2, .max = 180, .fallback = 2.0}) * std::numbers::pi / 180;
  const TomlSection registration = reader.section("registration");
  config.registration = registration.path("file");
}

/// The turn is followed by a second marker exactly where there is one.
void check_second_marker(const TomlSection& section, const CartConfig& config) {
  const bool there = section.has("second_rom") || section.has("second_port");
  if (there == (config.turn == TurnSource::marker)) return;
  section.refuse(section.has("second_port") ? "second_port" : "second_rom",
                 there
                     ? "names a marker that nobody asks: [scope] turn is not \"marker\""
                     : "is missing: [scope] turn = \"marker\" wants the second marker's definition or port");
}

/// An encoder is there exactly where the turn is followed by it.
void read_turn_encoder(const TomlSection& section, CartConfig& config) {
  if (config.turn == TurnSource::encoder) {
    read_encoder(section, config.encoder);
  } else if (section.present()) {
    EncoderConfig unasked;
    read_encoder(section, unasked);
    section.refuse("kind", "names an encoder that nobody asks: [scope] turn is not \"encoder\"");
  }
}

void read_painting(const TomlSection& section, CartConfig& config) {
  config.mode = section.choice_of<TextureMode>(
      "mode", {{"perspective", TextureMode::perspective}, {"paper", TextureMode::paper}},
      TextureMode::perspective);
  config.policy = section.choice_of<PaintPolicy>(
      "policy", {{"newest", PaintPolicy::newest}, {"best", PaintPolicy::best}}, config.policy);
  config.highlights = section.choice_of<Highlights>(
      "highlights", {{"yield", Highlights::yield}, {"keep", Highlights::keep}}, config.highlights);
  config.light = section.choice_of<LightModel>("light",
                                               {{"as_seen", LightModel::as_seen},
                                                {"fixed_exposure", LightModel::fixed_exposure},
                                                {"auto_exposure", LightModel::auto_exposure}},
                                               config.light);
}

/// Directions that do not tell where up is would show nothing.
void read_view(const TomlSection& view, CartConfig& config) {
  config.view_from = view.numbers("from", 3, config.view_from);
  config.view_up = view.numbers("up", 3, config.view_up);
  const Eigen::Vector3d from(config.view_from[0], config.view_from[1], config.view_from[2]);
  const Eigen::Vector3d up(config.view_up[0], config.view_up[1], config.view_up[2]);
  constexpr double kLeastSine = 1e-3;
  if (from.isZero(0) || up.isZero(0))
    view.refuse(from.isZero(0) ? "from" : "up",
                "is [0, 0, 0]; a direction in the surface's axes is accepted");
  else if (from.normalized().cross(up.normalized()).norm() < kLeastSine)
    view.refuse("up",
                "lies along from; another direction than that of from is accepted (it is [0, 0, 1] "
                "where it is not stated)");
}

void read_simulation(const TomlSection& section, SimulationConfig& simulation) {
  simulation.seed = static_cast<std::uint64_t>(section.integer("seed", {.min = 0, .fallback = 1}));
  simulation.duration_s = section.number("duration_s", {.min = 2, .max = 3600, .fallback = 30});
  simulation.marker_noise_mm = section.number("marker_noise_mm", {.min = 0, .max = 2, .fallback = 0.05});
  simulation.picture_noise = section.flag("picture_noise", true);
  simulation.turn_rad =
      section.number("turn_deg", {.min = 0, .max = 180, .fallback = 0.0}) * std::numbers::pi / 180;
  simulation.turn_every_s = section.number("turn_every_s", {.min = 1, .max = 3600, .fallback = 8.0});
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
  check_second_marker(reader.section("tracker"), config);
  read_camera(reader.section("camera"), config.camera);
  read_pedal(reader.section("pedal"), config.pedal);
  read_turn_encoder(reader.section("encoder"), config);
  read_panel(reader.section("panel"), config.panel);
  read_simulation(reader.section("simulation"), config.simulation);
  const TomlSection sync = reader.section("sync");
  config.tracker_against_video = from_seconds(
      1e-3 * sync.number("tracker_against_video_ms", {.min = -500, .max = 500, .fallback = 0.0}));
  if (sync.has("tracker_against_video_deviation_ms"))
    config.time_deviation_s =
        1e-3 * sync.number("tracker_against_video_deviation_ms", {.min = 0, .max = 100});
  read_painting(reader.section("painting"), config);
  const TomlSection view = reader.section("view");
  read_view(view, config);
  const bool measured =
      config.tracker.kind != TrackerKind::simulated && config.camera.kind != CameraKind::simulated;
  if (measured && config.turn == TurnSource::encoder && config.encoder.kind == EncoderKind::simulated)
    reader.section("encoder").refuse("kind",
                                     "is \"simulated\", which turns by the script of a simulated "
                                     "procedure; with tracker and camera real, evdev is accepted");
  if (measured && config.pedal.kind == PedalKind::simulated) {
    reader.section("pedal").refuse(
        "kind",
        "is \"simulated\", which presses by the script of a simulated procedure; with "
        "tracker and camera real, gpio, keyboard or none is accepted");
  }
  config.colour_by = view.choice_of<ColourBy>("colour_by",
                                              {{"picture", ColourBy::picture},
                                               {"capture", ColourBy::capture},
                                               {"angle", ColourBy::angle},
                                               {"resolution", ColourBy::resolution},
                                               {"error", ColourBy::error}},
                                              ColourBy::picture);
  if (auto finished = reader.finish(); !finished) return tl::unexpected(finished.error());
  return config;
}

}  // namespace orcart
