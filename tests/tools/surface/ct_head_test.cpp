// A real CT head: headerless slices behind a NRRD header that states no patient space.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/real_data/data_folder.hpp"
#include "tools/surface/surface_command.hpp"

namespace orcart {
namespace {

using orcart::testing::data_folder;

TEST(CtHead, TheSkinHasThePublishedVolume) {
  const auto data = data_folder("vol_ct_headsq");
  if (!data) GTEST_SKIP() << orcart::testing::kNoData;
  const TemporaryFolder folder;
  SurfaceCommand command;
  command.volume = {.path = *data / "quarter.nhdr", .where_unstated = Space::lps};
  // Voxel (28, 28, 46) holds 1092. 500: skin, as VTK's examples.
  command.region = {.seeds_mm = {{89.6, 89.6, 69}}, .lowest = 500, .highest = 5000};
  command.soft.smooth_mm = 0;
  command.extraction = {.triangles = 100'000, .smoothing_iterations = 0};
  command.region.leak = LeakPolicy::accept;
  command.output.out = folder / "skin.ply";
  const auto report = make_surface_file(command, [](int, int, const std::string&) {});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->closed);
  // vtkMarchingCubes at 500: 1863.6 ml, the head's cavities left open; here they are filled.
  EXPECT_GT(report->mesh.volume_ml, 1864);
  EXPECT_LT(report->mesh.volume_ml, 1864 * 1.35);
}

}  // namespace
}  // namespace orcart
