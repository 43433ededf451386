// The shipped surfaces can be made again from the volumes of a real head.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "firmware-host/files/surface_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tools/surface/surface_command.hpp"

namespace orcart {
namespace {

/// Where Colin27 lies on this machine; empty where it does not.
std::filesystem::path colin27(const char* name) {
  const char* data = std::getenv("ORCART_DATA");
  const std::filesystem::path root(std::getenv("ORCART_SOURCE_DIR"));
  const std::filesystem::path recordings = data != nullptr ? data : root / "../shared/data";
  for (const auto& folder :
       {recordings / "vol_mr_colin27", std::filesystem::path("/usr/share/mricron/templates")})
    if (std::filesystem::exists(folder / name)) return folder / name;
  return {};
}

/// What tools/make-surfaces gives for the ventricle.
SurfaceCommand ventricle(const TemporaryFolder& folder) {
  SurfaceCommand command;
  command.volume.path = colin27("ch2.nii.gz");
  command.region = {.seeds_mm = {{-8, 0, 20}}, .lowest = 0, .highest = 48};
  command.soft = {.close_mm = 2, .grid_mm = 0.5};
  command.extraction = {.triangles = 16'000, .pass_band = 0.01};
  command.output.out = folder / "made.ply";
  return command;
}

SurfaceCommand cortex(const TemporaryFolder& folder) {
  SurfaceCommand command;
  command.volume.path = colin27("ch2bet.nii.gz");
  command.region = {.seeds_mm = {{-20, 20, 40}}, .lowest = 50, .highest = 255, .largest_ml = 2000};
  command.soft.smooth_mm = 1;
  command.extraction.triangles = 50'000;
  command.output.out = folder / "made.ply";
  return command;
}

void expect_as_shipped(const SurfaceCommand& command, const std::string& name) {
  const auto shipped =
      read_surface(std::filesystem::path(std::getenv("ORCART_SOURCE_DIR")) / "share/surfaces" / name);
  ASSERT_TRUE(shipped) << shipped.error().message;
  const auto figures = make_surface_file(command, [](int, int, const std::string&) {});
  ASSERT_TRUE(figures) << figures.error().message;
  EXPECT_EQ(figures->identity.hash, shipped->identity.hash);
  EXPECT_TRUE(figures->closed);
}

TEST(Colin27, TheShippedVentricleIsMadeAgainToTheSameHash) {
  const TemporaryFolder folder;
  if (colin27("ch2.nii.gz").empty())
    GTEST_SKIP() << "ch2.nii.gz is neither in ORCART_DATA nor in mricron-data";
  expect_as_shipped(ventricle(folder), "ventricle.ply");
}

TEST(Colin27, TheShippedCortexIsMadeAgainToTheSameHash) {
  const TemporaryFolder folder;
  if (colin27("ch2bet.nii.gz").empty())
    GTEST_SKIP() << "ch2bet.nii.gz is neither in ORCART_DATA nor in mricron-data";
  expect_as_shipped(cortex(folder), "cortex.ply");
}

TEST(Colin27, TheVentricleLeaksAtAnIntensityOf55) {
  const TemporaryFolder folder;
  if (colin27("ch2.nii.gz").empty())
    GTEST_SKIP() << "ch2.nii.gz is neither in ORCART_DATA nor in mricron-data";
  SurfaceCommand command = ventricle(folder);
  command.region.highest = 55;
  const auto figures = make_surface_file(command, [](int, int, const std::string&) {});
  ASSERT_FALSE(figures);
  EXPECT_NE(figures.error().message.find("a lower HI"), std::string::npos) << figures.error().message;
}

TEST(Colin27, ANiftiThatIsCutShortIsRefused) {
  const TemporaryFolder folder;
  if (colin27("ch2.nii.gz").empty())
    GTEST_SKIP() << "ch2.nii.gz is neither in ORCART_DATA nor in mricron-data";
  SurfaceCommand command = ventricle(folder);
  std::filesystem::copy_file(command.volume.path, folder / "cut.nii.gz");
  std::filesystem::permissions(folder / "cut.nii.gz", std::filesystem::perms::owner_all);
  std::filesystem::resize_file(folder / "cut.nii.gz", 1'000'000);
  command.volume.path = folder / "cut.nii.gz";
  const auto figures = make_surface_file(command, [](int, int, const std::string&) {});
  ASSERT_FALSE(figures);
  EXPECT_NE(figures.error().message.find("it is cut short"), std::string::npos) << figures.error().message;
}

}  // namespace
}  // namespace orcart
