// orcart calibrate turn and orcart turn: scopes whose light post turns against the camera head.
#include <cstdio>
#include <memory>
#include <numbers>

#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/whole_file.hpp"
#include "tools/calibration/load_picture.hpp"
#include "tools/calibration/turning.hpp"
#include "tools/orcart/verbs.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

constexpr const char* kCalibrateExample =
    "Examples:\n  orcart calibrate turn turn-*.png --pattern charuco:19x26:5mm:4mm:4X4_250 --scope "
    "scope.toml "
    "--angle 30 --page turn.html\n"
    "  orcart calibrate turn turn-*.png --poses head.csv --pattern ... --scope scope.toml --angle 30\n\n"
    "Clamp the scope before a board and turn the camera head alone, all round; three pictures or more. "
    "--poses "
    "belongs to a marker on\nthe head; without, the marker sits on the shaft. With --second-poses, of a "
    "marker on "
    "the other side of the coupler, the cart can\nfollow the turn while it runs ([scope] turn = "
    "\"marker\"); a notch that the pictures show serves turn = \"notch\". The first picture is at the "
    "turn of "
    "the passport unless both show a notch.\nThe passport is written back with [turning] unless --out names "
    "another; with three pictures or "
    "more that show the notch it says how well a turn is known by it.";

constexpr const char* kTurnExample =
    "Example:\n  orcart turn frame.png --scope scope.toml\n\n"
    "The number is what orcartd --turn, [scope] turn_deg and orcart paint --turn take.";

struct CalibrateArguments {
  TurningCommand command;
  std::string pattern, scope, out, page;
  double angle_deg = 0;
  bool json = false;
};

Result<void> calibrate(CalibrateArguments& arguments) {
  const auto pattern = parse_pattern(arguments.pattern);
  if (!pattern) return tl::unexpected(pattern.error());
  arguments.command.pattern = *pattern;
  arguments.command.view_angle_rad = arguments.angle_deg * std::numbers::pi / 180;
  const auto scope = read_scope(arguments.scope);
  if (!scope) return tl::unexpected(scope.error());
  const auto calibration = calibrate_turning(arguments.command, *scope, {});
  if (!calibration) return tl::unexpected(calibration.error());
  if (!arguments.page.empty())
    if (auto written = write_whole_file(arguments.page, turning_page(*calibration)); !written) return written;
  if (auto written = write_scope(arguments.out.empty() ? arguments.scope : arguments.out, calibration->scope);
      !written)
    return written;
  std::fputs((arguments.json ? turning_json(*calibration) : turning_text(*calibration)).c_str(), stdout);
  return {};
}

struct TurnArguments {
  std::vector<std::filesystem::path> images;
  std::string scope;
  bool json = false;
};

Result<void> tell(const TurnArguments& arguments) {
  const auto scope = read_scope(arguments.scope);
  if (!scope) return tl::unexpected(scope.error());
  std::vector<std::string> answers;
  std::string text;
  for (const auto& image : arguments.images) {
    const cv::Mat picture = load_picture(image);
    if (picture.empty())
      return fail(image.string() + ": cannot be read as a picture; PNG, JPEG, TIFF and BMP are accepted");
    if (picture.cols != scope->width_px || picture.rows != scope->height_px)
      return fail(image.string() + json::format(": %dx%d px; a picture of the scope's %dx%d is accepted",
                                                picture.cols, picture.rows, scope->width_px,
                                                scope->height_px));
    const auto turn = turn_by_notch(picture, *scope);
    if (!turn) return fail(image.string() + ": " + turn.error().message);
    const double turn_deg = *turn * 180 / std::numbers::pi;
    text += json::format("%s: turned by %.2f degrees\n", image.filename().c_str(), turn_deg);
    answers.push_back("{\"image\": " + json::text(image.string()) +
                      ", \"turn_deg\": " + json::number(turn_deg) + "}");
  }
  std::fputs(arguments.json ? (json::list(answers) + "\n").c_str() : text.c_str(), stdout);
  return {};
}

}  // namespace

void add_turning(CLI::App& calibrate_verb, int& exit_code) {
  CLI::App* verb = calibrate_verb.add_subcommand("turn", "How an angled scope turns against its camera head");
  verb->footer(kCalibrateExample);
  const auto arguments = std::make_shared<CalibrateArguments>();
  verb->add_option("images", arguments->command.images, "pictures of the pattern at different turns")
      ->required();
  verb->add_option("--pattern", arguments->pattern, "as for `orcart calibrate camera`")->required();
  verb->add_option("--scope", arguments->scope, "the scope's passport")->required();
  verb->add_option("--poses", arguments->command.poses, "poses of a marker on the camera head");
  verb->add_option(
      "--second-poses", arguments->command.second_poses,
      "poses of a second marker, on the other side of the coupler: the cart follows the turn by it");
  verb->add_option_function<TurnMarker>(
          "--marker", [arguments](const TurnMarker& marker) { arguments->command.marker = marker; },
          "where the scope's own marker (--poses) sits: head or shaft; unless told head with --poses, "
          "shaft without. On the shaft its poses serve beside --second-poses only")
      ->transform(one_of<TurnMarker>({{"head", TurnMarker::head}, {"shaft", TurnMarker::shaft}}));
  verb->add_option("--angle", arguments->angle_deg, "degrees between view and shaft, as engraved")
      ->check(CLI::Range(0.0, 120.0))
      ->required();
  verb->add_option("--out", arguments->out, "the passport to write; the one read unless told");
  verb->add_option("--page", arguments->page, "also one HTML page with the corners and residuals");
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] {
    const auto done = calibrate(*arguments);
    if (!done) std::fprintf(stderr, "orcart calibrate turn: %s\n", done.error().message.c_str());
    exit_code = done ? 0 : 1;
  });
}

void add_turn(CLI::App& app, int& exit_code) {
  CLI::App* verb = app.add_subcommand("turn", "How far an angled scope is turned, by a picture's notch");
  verb->footer(kTurnExample);
  const auto arguments = std::make_shared<TurnArguments>();
  verb->add_option("images", arguments->images, "pictures of the scope")->required();
  verb->add_option("--scope", arguments->scope, "the scope's passport, with [turning]")->required();
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] {
    const auto done = tell(*arguments);
    if (!done) std::fprintf(stderr, "orcart turn: %s\n", done.error().message.c_str());
    exit_code = done ? 0 : 1;
  });
}

}  // namespace orcart
