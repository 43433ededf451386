// The whole of `orcart surface` on a small volume: a file that reads back, or no file at all.
#include "tools/surface/surface_command.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "firmware-host/files/surface_file.hpp"
#include "tests/tools/surface/sample_volume.hpp"

namespace orcart {
namespace {

SurfaceCommand command(const TemporaryFolder& folder, const PlainPoint& seed) {
  SurfaceCommand made;
  made.volume.path = dark_ball(10).write(folder);
  made.region = {.seeds_mm = {seed}, .lowest = 0, .highest = 48};
  made.extraction.triangles = 800;
  made.output.out = folder / "ball.ply";
  return made;
}

TEST(SurfaceCommand, WritesAClosedSurfaceWithItsFigures) {
  const TemporaryFolder folder;
  std::vector<int> steps;
  const auto figures = make_surface_file(command(folder, {20, 20, 20}),
                                         [&](int step, int, const std::string&) { steps.push_back(step); });
  ASSERT_TRUE(figures) << figures.error().message;
  EXPECT_EQ(steps, (std::vector{1, 2, 3, 4, 5}));
  EXPECT_TRUE(figures->closed);
  EXPECT_EQ(figures->mesh.euler_number, 2);
  EXPECT_NEAR(figures->mesh.volume_ml, 4.19, 0.15);
  EXPECT_NEAR(figures->mesh.area_mm2, 4 * std::numbers::pi * 100, 40);
  const auto surface = read_surface(folder / "ball.ply");
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->identity.hash, figures->identity.hash);
  EXPECT_EQ(surface->identity.series, "volume.mha");
  EXPECT_EQ(surface->mesh.triangles.size(), figures->mesh.triangles);
}

TEST(SurfaceCommand, LeavesNoFileWhereItFails) {
  const TemporaryFolder folder;
  EXPECT_FALSE(make_surface_file(command(folder, {2, 2, 2}), [](int, int, const std::string&) {}));
  EXPECT_FALSE(std::filesystem::exists(folder / "ball.ply"));
}

TEST(SurfaceCommand, RefusesAnotherKindOfFile) {
  const TemporaryFolder folder;
  SurfaceCommand wrong = command(folder, {20, 20, 20});
  wrong.output.out = folder / "ball.stl";
  const auto figures = make_surface_file(wrong, [](int, int, const std::string&) {});
  ASSERT_FALSE(figures);
  EXPECT_NE(figures.error().message.find("ending in .ply is accepted"), std::string::npos);
}

TEST(SurfaceCommand, MakesAPageWithPicturesAndThinnerLevels) {
  const TemporaryFolder folder;
  SurfaceCommand full = command(folder, {20, 20, 20});
  full.output.page = folder / "page";
  full.output.levels = 2;
  const auto report = make_surface_file(full, [](int, int, const std::string&) {});
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->levels.size(), 2U);
  const auto level = read_surface(folder / "ball-2.ply");
  ASSERT_TRUE(level) << level.error().message;
  EXPECT_TRUE(level->closed);
  EXPECT_LE(level->mesh.triangles.size(), 200U);
  for (const char* name : {"surface.html", "surface.json", "slice-x.png", "slice-y.png", "slice-z.png",
                           "from-left.png", "from-front.png", "from-above.png"})
    EXPECT_TRUE(std::filesystem::exists(folder / "page" / name)) << name;
}

}  // namespace
}  // namespace orcart
