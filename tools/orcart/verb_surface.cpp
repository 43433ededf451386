// orcart surface: from a CT or MR volume to the closed surface that the cart paints on.
#include <cstdio>

#include "tools/orcart/verbs.hpp"

#ifdef ORCART_WITH_VOLUMES
#include <unistd.h>

#include <array>
#include <memory>
#include <sstream>

#include "tools/surface/surface_command.hpp"
#endif

namespace orcart {

namespace {

constexpr const char* kDescription = "Make a closed surface from a CT or MR volume";

#ifdef ORCART_WITH_VOLUMES

constexpr const char* kFooter =
    "The region is every voxel connected to a seed whose intensity lies from LO to HI. Seeds are millimetres "
    "in DICOM's\n"
    "LPS (x to the patient's left, y to the back, z up); with --seed-space RAS they are as MNI atlases and "
    "NIfTI viewers\n"
    "give them (x right, y front). The surface is written in LPS.\n\n"
    "Example (the right lateral ventricle of Colin27, MNI 8,0,20):\n"
    "  orcart surface ch2.nii.gz --seed 8,0,20 --seed-space RAS --range 0:48 --triangles 16000 --out "
    "ventricle.ply\n";

struct Arguments {
  SurfaceCommand command;
  std::vector<std::string> seeds;
  std::string seed_space = "LPS", range;
  bool json = false;
};

/// Numbers with one separator between them, and nothing else.
template <std::size_t Count>
bool parse_numbers(const std::string& text, char separator, std::array<double, Count>& numbers) {
  std::istringstream in(text);
  for (std::size_t i = 0; i < Count; ++i) {
    if (i > 0 && in.get() != separator) return false;
    if (!(in >> numbers[i])) return false;
  }
  return in.peek() == std::istringstream::traits_type::eof();
}

Result<void> take_seeds_and_range(Arguments& arguments) {
  RegionGrowing& region = arguments.command.region;
  region.seeds_mm.clear();
  for (const std::string& seed : arguments.seeds) {
    std::array<double, 3> xyz{};
    if (!parse_numbers(seed, ',', xyz))
      return fail("--seed is \"" + seed + "\"; x,y,z in millimetres is accepted");
    const double sign = arguments.seed_space == "RAS" ? -1 : 1;
    region.seeds_mm.push_back({sign * xyz[0], sign * xyz[1], xyz[2]});
  }
  std::array<double, 2> range{};
  if (!parse_numbers(arguments.range, ':', range) || range[0] > range[1])
    return fail("--range is \"" + arguments.range + "\"; LO:HI, such as 0:48, is accepted");
  region.lowest = range[0];
  region.highest = range[1];
  return {};
}

void tell(const SurfaceFigures& figures) {
  std::printf("region      %.2f ml (%zu voxels of it filled gaps and cavities)\n", figures.region_ml,
              figures.filled_voxels);
  std::printf("surface     %.2f ml, %.0f mm2, Euler number %ld, %s\n", figures.volume_ml, figures.area_mm2,
              figures.euler_number, figures.closed ? "closed" : "open");
  std::printf("            %zu vertices, %zu triangles\nhash        %s\n", figures.vertices,
              figures.triangles, figures.hash.c_str());
}

void tell_json(const SurfaceFigures& figures) {
  std::printf("{\"region_ml\": %.3f, \"filled_voxels\": %zu, \"volume_ml\": %.3f, \"area_mm2\": %.1f, ",
              figures.region_ml, figures.filled_voxels, figures.volume_ml, figures.area_mm2);
  std::printf(
      "\"euler_number\": %ld, \"closed\": %s, \"vertices\": %zu, \"triangles\": %zu, \"hash\": \"%s\"}\n",
      figures.euler_number, figures.closed ? "true" : "false", figures.vertices, figures.triangles,
      figures.hash.c_str());
}

int run(Arguments& arguments) {
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  const auto progress = [&](int step, int steps, const std::string& what) {
    if (!arguments.json || terminal) std::fprintf(stderr, "[%d/%d] %s\n", step, steps, what.c_str());
  };
  const auto taken = take_seeds_and_range(arguments);
  const auto figures = taken ? make_surface_file(arguments.command, progress) : tl::unexpected(taken.error());
  if (!figures) {
    std::fprintf(stderr, "orcart surface: %s\n", figures.error().message.c_str());
    return 1;
  }
  arguments.json ? tell_json(*figures) : tell(*figures);
  return 0;
}

#endif

}  // namespace

#ifdef ORCART_WITH_VOLUMES

void add_surface(CLI::App& app, int& exit_code) {
  CLI::App* verb = app.add_subcommand("surface", kDescription);
  auto arguments = std::make_shared<Arguments>();
  SurfaceCommand& command = arguments->command;
  verb->footer(kFooter);
  verb->add_option("volume", command.region.volume, "NIfTI (.nii, .nii.gz), .nrrd or MetaImage (.mha)")
      ->required();
  verb->add_option("--seed", arguments->seeds, "x,y,z inside the region, mm; may be given more than once")
      ->required()
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb->add_option("--seed-space", arguments->seed_space,
                   "LPS (DICOM, the default) or RAS (MNI, NIfTI viewers)")
      ->check(CLI::IsMember({"LPS", "RAS"}));
  verb->add_option("--range", arguments->range, "LO:HI, the intensities of the region, both included")
      ->required();
  verb->add_option("--triangles", command.extraction.triangles, "at most so many")
      ->check(CLI::Range(100, 4'000'000))
      ->capture_default_str();
  verb->add_option("--denoise", command.region.denoise_mm,
                   "Gaussian over the volume before growing, sigma in mm")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  verb->add_option("--close", command.region.close_mm, "fill dents and handles narrower than twice this, mm")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  verb->add_option("--smooth", command.region.smooth_mm, "Gaussian over the region, sigma in mm")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  verb->add_option("--grid", command.region.grid_mm,
                   "spacing the surface is cut from, mm; 0 is the volume's own")
      ->check(CLI::Range(0.0, 20.0))
      ->capture_default_str();
  verb->add_option("--pass-band", command.extraction.pass_band, "of the windowed sinc; less is smoother")
      ->check(CLI::Range(0.001, 2.0))
      ->capture_default_str();
  verb->add_option("--max-volume", command.region.largest_ml, "a larger region is refused as a leak, ml")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--out", command.out, "the surface, a PLY file")->required();
  verb->add_flag("--json", arguments->json, "the figures as JSON");
  verb->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

#else

void add_surface(CLI::App& app, int& exit_code) {
  CLI::App* verb = app.add_subcommand("surface", kDescription);
  verb->footer("This build has no readers for volumes; see the sentence that the verb prints.");
  verb->allow_extras();
  verb->callback([&exit_code] {
    std::fputs(
        "orcart surface: this build cannot read volumes; install libinsighttoolkit5-dev and libvtk9-dev, and "
        "build "
        "with -DORCART_WITH_VOLUMES=ON\n",
        stderr);
    exit_code = 1;
  });
}

#endif

}  // namespace orcart
