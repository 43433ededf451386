// Surfaces made elsewhere come in with their report, or not at all.
#include "tools/mesh/import_command.hpp"

#include <gtest/gtest.h>

#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/tools/mesh/shapes.hpp"

namespace orcart {
namespace {

std::string obj_of(const TriangleMesh& mesh, const std::string& comment) {
  std::string text = "# " + comment + "\n";
  for (const auto& v : mesh.vertices_mm)
    text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) + "\n";
  for (const auto& t : mesh.triangles)
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  return text;
}

Result<SurfaceReport> imported(const ImportCommand& command) {
  return import_surface(command, read_surface, [](int, int, const std::string&) {});
}

TEST(ImportCommand, WritesTheSurfaceAndTellsItsFigures) {
  const TemporaryFolder folder;
  const auto report = imported({.input = folder.write("cube.obj", obj_of(cube(10), "SPACE=RAS")),
                                .output = {.out = folder / "cube.ply"}});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->closed);
  EXPECT_NEAR(report->mesh.volume_ml, 1, 1e-6);
  const auto written = read_surface(folder / "cube.ply");
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(written->identity.series, "cube.obj");
  EXPECT_EQ(written->identity.hash, report->identity.hash);
  EXPECT_LT(written->mesh.vertices_mm[1].x(), -9);  // RAS was turned into LPS
}

TEST(ImportCommand, WritesTheChartsThatTheCartPaintsIn) {
  const TemporaryFolder folder;
  const auto report = imported(
      {.input = folder.write("cube.obj", obj_of(cube(10), "SPACE=LPS")),
       .output = {.out = folder / "cube.ply", .charts = {.file = folder / "charts.ply", .texel_mm = 0.5}}});
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_TRUE(report->charts);
  EXPECT_EQ(report->charts->charts, 6u) << "a cube's sides";
  EXPECT_EQ(report->charts->texel_mm, 0.5);
  const double texels = 6 * 20 * 20;  // 10 mm a side
  EXPECT_NEAR(report->charts->used_share * report->charts->size_texels * report->charts->size_texels, texels,
              0.15 * texels);
  EXPECT_TRUE(std::filesystem::exists(folder / "charts.png"));
  const auto charts = read_surface(folder / "charts.ply");
  ASSERT_TRUE(charts) << charts.error().message;
  EXPECT_EQ(charts->identity.hash, report->identity.hash) << "the same surface, places apart";
  EXPECT_NE(text_of(*report).find("charts      charts.ply: 6 in"), std::string::npos) << text_of(*report);
}

TEST(ImportCommand, RefusesChartsUnderANameOfNoTexturedFile) {
  const TemporaryFolder folder;
  const auto input = folder.write("cube.obj", obj_of(cube(10), "SPACE=LPS"));
  for (const char* name : {"charts.stl", "cube.ply", "nowhere/charts.ply"}) {
    const auto report =
        imported({.input = input, .output = {.out = folder / "cube.ply", .charts = {.file = folder / name}}});
    EXPECT_FALSE(report) << name;
    EXPECT_FALSE(std::filesystem::exists(folder / "cube.ply")) << name;
  }
}

TEST(ImportCommand, TellsAnOpenSurface) {
  const TemporaryFolder folder;
  TriangleMesh open = cube(10);
  open.triangles.pop_back();
  const auto report = imported(
      {.input = folder.write("cube.obj", obj_of(open, "SPACE=LPS")), .output = {.out = folder / "cube.ply"}});
  ASSERT_TRUE(report);
  EXPECT_FALSE(report->closed);
  EXPECT_NE(text_of(*report).find("open along 3 edges"), std::string::npos);
}

TEST(ImportCommand, RefusesASurfaceInMetres) {
  const TemporaryFolder folder;
  const auto report = imported({.input = folder.write("cube.obj", obj_of(cube(0.2F), "SPACE=LPS")),
                                .output = {.out = folder / "cube.ply"}});
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("is 0.346 mm across; that looks like metres"), std::string::npos);
}

TEST(ImportCommand, LeavesNoFileWhereTheSpaceIsNotKnown) {
  const TemporaryFolder folder;
  const auto report = imported({.input = folder.write("cube.obj", obj_of(cube(10), "by hand")),
                                .output = {.out = folder / "cube.ply"}});
  ASSERT_FALSE(report);
  EXPECT_FALSE(std::filesystem::exists(folder / "cube.ply"));
}

TEST(ImportCommand, APageThatCannotBeOneIsRefusedBeforeAnythingIsWritten) {
  const TemporaryFolder folder;
  const auto input = folder.write("cube.obj", obj_of(cube(10), "SPACE=LPS"));
  for (const char* page : {"cube.obj", "cube.obj/report"}) {
    const auto report =
        imported({.input = input, .output = {.out = folder / "cube.ply", .page = folder / page}});
    ASSERT_FALSE(report);
    EXPECT_NE(report.error().message.find("cube.obj: is no folder that can be written into"),
              std::string::npos)
        << report.error().message;
    EXPECT_FALSE(std::filesystem::exists(folder / "cube.ply"));
  }
}

TEST(ImportCommand, TellsHowLongItTook) {
  const TemporaryFolder folder;
  const auto report = imported({.input = folder.write("cube.obj", obj_of(cube(10), "SPACE=LPS")),
                                .output = {.out = folder / "cube.ply"}});
  ASSERT_TRUE(report);
  EXPECT_GT(report->seconds, 0);
}

TEST(ImportCommand, AJsonReportHoldsTheFigures) {
  const TemporaryFolder folder;
  const auto report = imported({.input = folder.write("cube.obj", obj_of(cube(10), "SPACE=LPS")),
                                .output = {.out = folder / "cube.ply"}});
  ASSERT_TRUE(report);
  EXPECT_NE(json_of(*report).find("\"euler_number\": 2, \"closed\": true, \"vertices\": 8, \"edges\": 18"),
            std::string::npos)
      << json_of(*report);
}

TEST(ImportCommand, RefusesAnotherKindOfOutput) {
  const TemporaryFolder folder;
  const auto report = imported({.input = folder / "cube.obj", .output = {.out = folder / "cube.stl"}});
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("ending in .ply is accepted"), std::string::npos);
}

}  // namespace
}  // namespace orcart
