// orcart calibrate and orcart rectify: a scope's lens from pictures of a board.
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "tools/orcart/verbs.hpp"

#ifdef ORCART_WITH_CALIBRATION
#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/whole_file.hpp"
#include "tools/calibration/camera_report.hpp"
#include "tools/calibration/rectify.hpp"
#endif

namespace orcart {

#ifdef ORCART_WITH_CALIBRATION

namespace {

constexpr const char* kCameraExample =
    "Example:\n  orcart calibrate camera left-*.png --pattern chessboard:14x10:3mm --out scope.toml --page "
    "scope.html\n\n"
    "Chessboards and dots count inner corners and dots, ChArUco boards squares (both layouts are tried). "
    "Parts of a board are enough;\n"
    "red, yellow and green dots on a chessboard, as on the CISST board, tell its origin.";

struct CameraArguments {
  CameraCommand command;
  std::string pattern, out, page;
  bool json = false;
};

int failed(const char* verb, const Error& error) {
  std::fprintf(stderr, "orcart %s: %s\n", verb, error.message.c_str());
  return 1;
}

Progress told_on_stderr(bool quiet) {
  if (quiet || ::isatty(STDERR_FILENO) != 1) return {};
  return [](std::size_t done, std::size_t all, const std::string& what) {
    std::fprintf(stderr, "\r\033[K  %zu/%zu %s%s", done, all, what.c_str(), done == all ? "\r\033[K" : "");
  };
}

int calibrate(CameraArguments& arguments) {
  const auto pattern = parse_pattern(arguments.pattern);
  if (!pattern) return failed("calibrate camera", pattern.error());
  arguments.command.pattern = *pattern;
  const auto calibration = calibrate_camera(arguments.command, told_on_stderr(arguments.json));
  if (!calibration) return failed("calibrate camera", calibration.error());
  if (!arguments.page.empty()) {
    const auto page = camera_page(*calibration);
    if (!page) return failed("calibrate camera", page.error());
    if (auto written = write_whole_file(arguments.page, *page); !written)
      return failed("calibrate camera", written.error());
  }
  if (auto written = write_scope(arguments.out, calibration->scope); !written)
    return failed("calibrate camera", written.error());
  std::fputs((arguments.json ? camera_json(*calibration) : camera_text(*calibration)).c_str(), stdout);
  return 0;
}

void add_camera(CLI::App& calibrate_verb, int& exit_code) {
  CLI::App* verb =
      calibrate_verb.add_subcommand("camera", "Lens, mask and fall-off from pictures of a board");
  verb->footer(kCameraExample);
  const auto arguments = std::make_shared<CameraArguments>();
  CameraCommand& command = arguments->command;
  verb->add_option("images", command.images, "pictures of the pattern")->required();
  verb->add_option("--pattern", arguments->pattern,
                   "chessboard:14x10:3mm | charuco:19x26:5mm:4mm:4X4_250[:legacy] | dots:16x14:4mm")
      ->required();
  static const std::vector<std::pair<std::string, LensModel>> models{
      {"brown", LensModel::brown}, {"poly4", LensModel::poly4}, {"fisheye", LensModel::fisheye}};
  verb->add_option("--model", command.model, "brown (the default), poly4 or fisheye")
      ->transform(one_of(models));
  static const std::vector<std::pair<std::string, Medium>> media{
      {"air", Medium::air}, {"water", Medium::water}, {"saline", Medium::saline}};
  verb->add_option("--medium", command.medium,
                   "what the pictures were taken in: air (the default), water or saline")
      ->transform(one_of(media));
  verb->add_option("--name", command.name, "the scope's name in its passport")->capture_default_str();
  verb->add_option("--serial", command.serial, "the scope's serial number, which the cart compares");
  verb->add_option("--distances", command.distances_mm,
                   "mm, one a picture, known but for a common offset: 10,20,30")
      ->delimiter(',');
  verb->add_option("--valid-days", command.valid_days, "days until the passport expires")
      ->check(CLI::Range(1, 3650))
      ->capture_default_str();
  verb->add_option("--out", arguments->out, "the passport, scope.toml")->required();
  verb->add_option("--page", arguments->page, "also one HTML page with the board in each picture");
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] { exit_code = calibrate(*arguments); });
}

}  // namespace

void add_calibrate(CLI::App& app, int& exit_code) {
  CLI::App* verb = app.add_subcommand("calibrate", "A scope's lens, and where it sits on its marker");
  verb->require_subcommand(1);
  add_camera(*verb, exit_code);
  add_hand_eye(*verb, exit_code);
  add_medium(*verb, exit_code);
  add_time(*verb, exit_code);
  add_tip(*verb, exit_code);
  add_turning(*verb, exit_code);
}

void add_rectify(CLI::App& app, int& exit_code) {
  struct Arguments {
    std::vector<std::filesystem::path> images;
    std::string scope, out;
  };
  CLI::App* verb = app.add_subcommand("rectify", "Pictures with the lens's distortion taken out");
  verb->footer("Example:\n  orcart rectify frame-*.png --scope scope.toml --out straight");
  const auto arguments = std::make_shared<Arguments>();
  verb->add_option("images", arguments->images, "pictures of the scope")->required();
  verb->add_option("--scope", arguments->scope, "the scope's passport")->required();
  verb->add_option("--out", arguments->out, "the folder for the pictures")->required();
  verb->callback([arguments, &exit_code] {
    const auto scope = read_scope(arguments->scope);
    const auto done =
        scope ? rectify(arguments->images, *scope, arguments->out) : tl::unexpected(scope.error());
    exit_code = done ? 0 : failed("rectify", done.error());
  });
}

#else

namespace {

void add_absent(CLI::App& app, const char* name, const char* what, int& exit_code) {
  CLI::App* verb = app.add_subcommand(name, what);
  verb->allow_extras();
  verb->callback([name, &exit_code] {
    std::fprintf(stderr,
                 "orcart %s: this build has no solvers; install libopencv-dev, libopencv-contrib-dev and "
                 "libceres-dev, and build with "
                 "-DORCART_WITH_CALIBRATION=ON\n",
                 name);
    exit_code = 1;
  });
}

}  // namespace

void add_calibrate(CLI::App& app, int& exit_code) {
  add_absent(app, "calibrate", "A scope's lens, and where it sits on its marker", exit_code);
}

void add_rectify(CLI::App& app, int& exit_code) {
  add_absent(app, "rectify", "Pictures with the lens's distortion taken out", exit_code);
}

void add_turn(CLI::App& app, int& exit_code) {
  add_absent(app, "turn", "How far an angled scope is turned, by a picture's notch", exit_code);
}

#endif

}  // namespace orcart
