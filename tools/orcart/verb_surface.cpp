// orcart surface: from a CT or MR volume, or a surface made elsewhere, to the surface that the cart paints
// on.
#include <unistd.h>

#include <array>
#include <cstdio>
#include <memory>
#include <sstream>

#include "tools/mesh/import_command.hpp"
#include "tools/orcart/verbs.hpp"

#ifdef ORCART_WITH_VOLUMES
#include "tools/surface/surface_command.hpp"
#include "tools/surface/vtk_surface.hpp"
#endif

namespace orcart {

namespace {

constexpr const char* kFooter =
    "DICOM (a folder of slices, or an enhanced multi-frame file), NIfTI, NRRD, MetaImage or\n"
    "FreeSurfer's MGH and MGZ: the region is every voxel connected to a seed whose\n"
    "intensity lies from LO to HI (Hounsfield in CT). Seeds are millimetres in DICOM's LPS (x to the "
    "patient's left,\n"
    "y to the back, z up); with --seed-space RAS they are as MNI atlases and NIfTI viewers give them.\n"
    "PLY, STL, OBJ, mz3, VTK or VTP: checked, measured and written as the cart likes it.\n"
    "Files are obeyed in what they say of patient space; one that says nothing needs --space. Out comes "
    "LPS.\n\n"
    "Examples (the right lateral ventricle of Colin27, MNI 8,0,20; a mesh in MNI space):\n"
    "  orcart surface ch2.nii.gz --seed 8,0,20 --seed-space RAS --range 0:48 --triangles 16000 --out "
    "ventricle.ply --page report\n"
    "  orcart surface cortex_5124.mz3 --space RAS --out cortex.ply --json\n";

struct Arguments {
  std::filesystem::path input;
  std::vector<std::string> seeds;
  std::string seed_space = "LPS", space, range, piece = "largest";
  int triangles = 0, stack = 0;
  double denoise_mm = 0, close_mm = 0, smooth_mm = 0.7, grid_mm = 0, pass_band = 0.1, largest_ml = 0;
  bool accept_leak = false, json = false;
  SurfaceOutput output;

  std::optional<Space> where_unstated() const {
    if (space.empty()) return std::nullopt;
    return space == "RAS" ? Space::ras : Space::lps;
  }
};

#ifdef ORCART_WITH_VOLUMES

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

Result<void> take_region(const Arguments& arguments, RegionGrowing& region) {
  if (arguments.seeds.empty() || arguments.range.empty())
    return fail(arguments.input.string() +
                ": a volume needs --seed x,y,z and --range LO:HI; see orcart surface --help");
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
  region.largest_ml = arguments.largest_ml;
  region.leak = arguments.accept_leak ? LeakPolicy::accept : LeakPolicy::refuse;
  return {};
}

Result<PieceChoice> piece_of(const std::string& word) {
  using Kind = PieceChoice::Kind;
  if (word == "largest") return PieceChoice{};
  if (word == "all") return PieceChoice{.kind = Kind::all};
  std::array<double, 1> number{};
  if (!parse_numbers(word, ' ', number) || number[0] < 1 || number[0] > 1e6)
    return fail("--piece is \"" + word + "\"; largest, all or a number from 1 is accepted");
  return PieceChoice{.kind = Kind::numbered, .number = static_cast<int>(number[0])};
}

Result<SurfaceReport> from_volume(const Arguments& arguments, const SurfaceProgress& progress) {
  SurfaceCommand command;
  command.volume = {
      .path = arguments.input, .where_unstated = arguments.where_unstated(), .stack = arguments.stack};
  if (auto taken = take_region(arguments, command.region); !taken) return tl::unexpected(taken.error());
  const auto piece = piece_of(arguments.piece);
  if (!piece) return tl::unexpected(piece.error());
  command.denoise_mm = arguments.denoise_mm;
  command.soft = {
      .close_mm = arguments.close_mm, .smooth_mm = arguments.smooth_mm, .grid_mm = arguments.grid_mm};
  command.extraction.pass_band = arguments.pass_band;
  command.extraction.pieces = *piece;
  if (arguments.triangles > 0) command.extraction.triangles = arguments.triangles;
  command.output = arguments.output;
  return make_surface_file(command, progress);
}

Result<Surface> read_any_surface(const std::filesystem::path& file, SurfaceNotes* notes,
                                 std::optional<Space> where_unstated) {
  const std::string ending = ending_of(file);
  if (ending == ".vtk" || ending == ".vtp") return read_vtk_surface(file, notes, where_unstated);
  return read_surface(file, notes, where_unstated);
}

#else

Result<SurfaceReport> from_volume(const Arguments& arguments, const SurfaceProgress& progress) {
  progress(1, 1, "reading " + arguments.input.string());
  return fail(arguments.input.string() +
              ": this build cannot read volumes; install libinsighttoolkit5-dev and libvtk9-dev, and build "
              "with -DORCART_WITH_VOLUMES=ON (surfaces as PLY, STL, OBJ and mz3 are read)");
}

Result<Surface> read_any_surface(const std::filesystem::path& file, SurfaceNotes* notes,
                                 std::optional<Space> where_unstated) {
  return read_surface(file, notes, where_unstated);
}

#endif

Result<SurfaceReport> run_it(const Arguments& arguments, const SurfaceProgress& progress) {
  if (!is_surface_name(arguments.input)) return from_volume(arguments, progress);
  return import_surface({.input = arguments.input,
                         .where_unstated = arguments.where_unstated(),
                         .triangles = arguments.triangles,
                         .output = arguments.output},
                        read_any_surface, progress);
}

int run(const Arguments& arguments) {
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  const auto report = run_it(arguments, [&](int step, int steps, const std::string& what) {
    if (!arguments.json || terminal) std::fprintf(stderr, "[%d/%d] %s\n", step, steps, what.c_str());
  });
  if (!report) {
    std::fprintf(stderr, "orcart surface: %s\n", report.error().message.c_str());
    return 1;
  }
  std::fputs((arguments.json ? json_of(*report) : text_of(*report)).c_str(), stdout);
  return 0;
}

constexpr const char* kOfVolumes = "Of a volume";

void add_growing_options(CLI::App& verb, Arguments& arguments) {
  const std::size_t before = verb.get_options().size();
  verb.add_option("--seed", arguments.seeds, "x,y,z inside the region, mm; may be given more than once")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb.add_option("--seed-space", arguments.seed_space,
                  "of the seeds: LPS (DICOM, the default) or RAS (MNI, NIfTI viewers)")
      ->check(CLI::IsMember({"LPS", "RAS"}));
  verb.add_option("--range", arguments.range, "LO:HI, the intensities of the region, both included");
  verb.add_option("--stack", arguments.stack, "of DICOM that holds several (series, echoes, times), from 1")
      ->check(CLI::Range(1, 1'000'000));
  verb.add_option("--denoise", arguments.denoise_mm, "Gaussian over the volume before growing, sigma in mm")
      ->check(CLI::Range(0.0, 10.0));
  verb.add_option("--close", arguments.close_mm, "fill dents and handles narrower than twice this, mm")
      ->check(CLI::Range(0.0, 10.0));
  verb.add_option("--smooth", arguments.smooth_mm, "Gaussian over the region, sigma in mm")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  verb.add_option("--grid", arguments.grid_mm, "spacing the surface is cut from, mm; 0 is the volume's own")
      ->check(CLI::Range(0.0, 20.0));
  verb.add_option("--pass-band", arguments.pass_band, "of the windowed sinc; less is smoother")
      ->check(CLI::Range(0.001, 2.0))
      ->capture_default_str();
  verb.add_option("--piece", arguments.piece, "of the cut surface: largest, all, or its number by size")
      ->capture_default_str();
  verb.add_option("--max-volume", arguments.largest_ml, "a larger region is refused as a leak, ml")
      ->check(CLI::PositiveNumber);
  verb.add_flag("--accept-leak", arguments.accept_leak, "take a region whose volume jumps within the range");
  const auto all = verb.get_options();
  for (std::size_t i = before; i < all.size(); ++i) all[i]->group(kOfVolumes);
}

/// Nothing is grown on a surface that was made elsewhere.
Result<void> check_growing_options(const CLI::App& verb, const Arguments& arguments) {
  if (!is_surface_name(arguments.input)) return {};
  for (const CLI::Option* option : verb.get_options())
    if (option->count() > 0 && option->get_group() == kOfVolumes)
      return fail(arguments.input.string() + ": is a surface, and " + option->get_name() +
                  " is of a volume; leave it out");
  return {};
}

}  // namespace

void add_surface(CLI::App& app, int& exit_code) {
  CLI::App* verb = app.add_subcommand("surface", "Make the surface to paint on from a CT, an MR or a mesh");
  auto arguments = std::make_shared<Arguments>();
  verb->footer(kFooter);
  verb->add_option(
          "input", arguments->input,
          "a DICOM folder or enhanced file, NIfTI, NRRD, MetaImage, MGH; or PLY, STL, OBJ, mz3, VTK, VTP")
      ->required();
  verb->add_option("--space", arguments->space, "patient space of a file that states none: LPS or RAS")
      ->check(CLI::IsMember({"LPS", "RAS"}));
  add_growing_options(*verb, *arguments);
  verb->add_option("--triangles", arguments->triangles,
                   "at most so many (a volume: 50000 unless told; a surface: as many as it has)")
      ->check(CLI::Range(100, 4'000'000));
  verb->add_option("--levels", arguments->output.levels,
                   "thinner copies beside it, each with half the triangles")
      ->check(CLI::Range(0, 8));
  verb->add_option("--charts", arguments->output.charts.file,
                   "PLY, OBJ or GLB: the surface with the charts it is painted in, each in its colour");
  verb->add_option("--texel-mm", arguments->output.charts.texel_mm, "of the charts, mm")
      ->check(CLI::Range(0.01, 10.0))
      ->capture_default_str();
  verb->add_option("--out", arguments->output.out, "the surface, a PLY file")->required();
  verb->add_option("--page", arguments->output.page, "a folder for a page with pictures and figures");
  verb->add_flag("--json", arguments->json, "the report as JSON");
  verb->callback([verb, arguments, &exit_code] {
    const auto checked = check_growing_options(*verb, *arguments);
    if (!checked) std::fprintf(stderr, "orcart surface: %s\n", checked.error().message.c_str());
    exit_code = checked ? run(*arguments) : 1;
  });
}

}  // namespace orcart
