// `orcart surface` on a surface that was made elsewhere: options of volumes are refused, not ignored.
#include <gtest/gtest.h>

#include "firmware-host/files/surface_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

class SurfaceVerb : public ::testing::Test {
 protected:
  void SetUp() override {
    TriangleMesh mesh{.vertices_mm = {{0, 0, 0}, {50, 0, 0}, {0, 50, 0}, {0, 0, 50}},
                      .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
    ASSERT_TRUE(write_ply(folder_ / "in.ply", *make_surface(mesh, "in")));
  }
  int run(const std::vector<std::string>& more) {
    CLI::App app;
    int exit_code = -1;
    add_surface(app, exit_code);
    std::vector<std::string> words{"surface", (folder_ / "in.ply").string(), "--out",
                                   (folder_ / "out.ply").string()};
    words.insert(words.end(), more.begin(), more.end());
    std::reverse(words.begin(), words.end());
    ::testing::internal::CaptureStderr();
    ::testing::internal::CaptureStdout();
    app.parse(words);
    said_ = ::testing::internal::GetCapturedStderr();
    ::testing::internal::GetCapturedStdout();
    return exit_code;
  }
  TemporaryFolder folder_;
  std::string said_;
};

TEST_F(SurfaceVerb, TakesASurface) {
  EXPECT_EQ(run({}), 0) << said_;
}

TEST_F(SurfaceVerb, RefusesOptionsOfVolumesForASurface) {
  EXPECT_EQ(run({"--smooth", "2"}), 1);
  EXPECT_NE(said_.find("is a surface, and --smooth is of a volume"), std::string::npos) << said_;
  EXPECT_EQ(run({"--piece", "largest"}), 1);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.ply"));
}

}  // namespace
}  // namespace orcart
