// orcart evaluate board: the paper's Table 1 on recorded, tracked pictures of a calibration board.
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "tools/evaluate/recorded/board_mapping.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "The paper's three errors beside the paper's, each view judged by what the other views alone say about "
    "hand-eye and\n"
    "board. Tracking: readings of a tool at rest about their mean, from the recordings that --still names "
    "(NDI "
    "dialogues,\n"
    "PLUS sequences .mha, poses); without them what the views imply, and said so. Tip: its distance to the "
    "board's\n"
    "corners, by tracker and hand-eye against by the picture. Mapping: each picture is painted onto the "
    "board's "
    "plane and\n"
    "its corners are found again in the painting. Also the step of grey across the joins, with and without "
    "--light of\n"
    "`orcart paint`. With --page the folder also holds the files by which `orcart paint` paints each view "
    "again.\n\n"
    "Example:\n"
    "  orcart evaluate board image*.png --poses poses.csv --pattern chessboard:18x16:2mm --still at-rest.mha "
    "--page out/mapping\n";

struct Arguments {
  BoardMappingCommand command;
  std::string pattern;
  bool json = false;
};

int run(Arguments& arguments) {
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  const auto bar = [&](const std::string& what, double done) {
    if (terminal) std::fprintf(stderr, "\r\033[K%s %3.0f %%", what.c_str(), 100 * done);
  };
  const auto pattern = parse_pattern(arguments.pattern);
  if (pattern) arguments.command.hand_eye.pattern = *pattern;
  const auto report = pattern ? evaluate_board(arguments.command, bar) : tl::unexpected(pattern.error());
  if (terminal) std::fputs("\r\033[K", stderr);
  if (!report) {
    std::fprintf(stderr, "orcart evaluate board: %s\n", report.error().message.c_str());
    return 1;
  }
  std::fputs((arguments.json ? json_of(*report) : text_of(*report)).c_str(), stdout);
  if (!arguments.command.page.empty() && !arguments.json)
    std::printf("page     %s\n", (arguments.command.page / "mapping.html").string().c_str());
  return 0;
}

}  // namespace

void add_evaluate_board(CLI::App& evaluate, int& exit_code) {
  CLI::App* verb =
      evaluate.add_subcommand("board", "The paper's Table 1 on recorded pictures of a calibration board");
  verb->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  BoardMappingCommand& command = arguments->command;
  verb->add_option("images", command.hand_eye.images, "pictures of the board")->required();
  verb->add_option("--poses", command.hand_eye.poses,
                   "the marker's poses: a file or a folder, by the pictures' names or in their order")
      ->required();
  verb->add_option("--pattern", arguments->pattern, "as for `orcart calibrate camera`")->required();
  verb->add_option(
      "--still", command.still,
      "recordings of tracked tools at rest, for the tracking error: NDI dialogues, PLUS sequences "
      "(.mha), or poses");
  verb->add_option("--scope", command.scope,
                   "the passport; the camera is calibrated from the pictures unless told");
  verb->add_option("--mode", command.mode, "perspective (default), or paper")
      ->transform(
          one_of<TextureMode>({{"perspective", TextureMode::perspective}, {"paper", TextureMode::paper}}));
  verb->add_option("--marker-noise", command.hand_eye.noise.marker_mm, "of one marker in 3-D, mm RMS")
      ->check(CLI::Range(0.001, 5.0))
      ->capture_default_str();
  verb->add_option("--marker-radius", command.hand_eye.noise.body_radius_mm,
                   "of the body's markers about their middle, mm")
      ->check(CLI::Range(5.0, 500.0))
      ->capture_default_str();
  verb->add_option("--depth-ratio", command.hand_eye.noise.depth_ratio,
                   "marker noise along the sensor's z against x and y; with --poses-in tracker")
      ->check(CLI::Range(1.0, 20.0))
      ->capture_default_str();
  verb->add_option("--poses-in", command.hand_eye.noise.poses_in,
                   "tracker (the default), or reference: a marker body beside the board")
      ->transform(one_of<PosesIn>({{"tracker", PosesIn::tracker}, {"reference", PosesIn::reference}}));
  verb->add_option("--texel-mm", command.texel_mm, "size of the paint's texels")
      ->check(CLI::Range(0.02, 1.0))
      ->capture_default_str();
  verb->add_option("--page", command.page, "a folder for a page with pictures and figures");
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace orcart
