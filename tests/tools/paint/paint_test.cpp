// `orcart paint` from files to files: what comes out, what is said, and that nothing is left after an error.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <tuple>

#include "firmware-host/files/picture_file.hpp"
#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/render/support/scenes.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

struct Said {
  int exit_code = 0;
  std::string out, err;
};

/// A folder with a square plate 20 mm in front of a scope, a picture, and views.csv of one view.
class Paint : public ::testing::Test {
 protected:
  static constexpr const char* kView = "ramp.png,1,0,0,0,0,1,0,0,0,0,1,0\n";
  static constexpr const char* kFacingAway = "ramp.png,-1,0,0,0,0,1,0,0,0,0,-1,40\n";

  void SetUp() override {
    Surface plane = *make_surface(scenes::plane(20, 20, 8).mesh, "plane");
    ASSERT_TRUE(write_ply(folder_ / "surface.ply", plane));
    ASSERT_TRUE(write_scope(folder_ / "scope.toml", scope_));
    auto ramp = scenes::ramp(scope_);
    ASSERT_TRUE(write_png(folder_ / "ramp.png", ramp.width_px, ramp.height_px, ramp.bytes));
    folder_.write("views.csv", kView);
    files_ = folder_.count();
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  Said run(const std::string& out, const std::vector<std::string>& more = {}) const {
    Said said;
    CLI::App app;
    add_paint(app, said.exit_code);
    std::vector<std::string> words = {"paint",           "--surface",        path("surface.ply"),
                                      "--scope",         path("scope.toml"), "--views",
                                      path("views.csv"), "--texel-mm",       "0.4",
                                      "--out",           path(out)};
    words.insert(words.end(), more.begin(), more.end());
    std::reverse(words.begin(), words.end());
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    try {
      app.parse(words);
    } catch (const CLI::ParseError& error) {
      said.exit_code = app.exit(error);
    }
    said.out = ::testing::internal::GetCapturedStdout();
    said.err = ::testing::internal::GetCapturedStderr();
    return said;
  }

  /// Runs and expects a refusal that says `words` and leaves nothing behind.
  void expect_refused(const std::string& words, const std::vector<std::string>& more = {}) const {
    const Said said = run("painted.obj", more);
    EXPECT_NE(said.exit_code, 0);
    EXPECT_EQ(said.out, "");
    EXPECT_NE(said.err.find(words), std::string::npos) << said.err;
    EXPECT_FALSE(std::filesystem::exists(path("painted.obj")));
    EXPECT_FALSE(std::filesystem::exists(path("painted.png")));
  }

  ScopeModel scope_ = scenes::scope();
  TemporaryFolder folder_;
  std::size_t files_ = 0;
};

/// Corners of an OBJ as viewers see them: position and the colour of its place in the picture.
struct Corner {
  Eigen::Vector3d position_mm;
  Eigen::Vector2d texels;  ///< from the top left corner of the picture
};

std::vector<Corner> corners_of(const std::filesystem::path& obj, const Picture& picture) {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector2d> places;
  std::vector<Corner> corners;
  std::ifstream in(obj);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    double x = 0, y = 0, z = 0;
    if (kind == "v" && words >> x >> y >> z) positions.emplace_back(x, y, z);
    if (kind == "vt" && words >> x >> y)
      places.emplace_back(x * picture.width_px, (1 - y) * picture.height_px);
    std::size_t vertex = 0, place = 0, normal = 0;
    char slash = 0;
    while (kind == "f" && words >> vertex >> slash >> place >> slash >> normal)
      corners.push_back({positions.at(vertex - 1), places.at(place - 1)});
  }
  return corners;
}

TEST_F(Paint, RefusesNamesThatWouldWriteOverEachOtherOrOverAPicture) {
  for (const char* name : {"painted.png", "painted.ply", "painted.obj", "./painted.png"})
    expect_refused("would hold the painting and the difference", {"--difference", path(name)});
  const Said over_picture = run("ramp.obj");
  EXPECT_NE(over_picture.exit_code, 0);
  EXPECT_NE(over_picture.err.find("ramp.png: is read, and would be written over"), std::string::npos)
      << over_picture.err;
  expect_refused("ramp.png: is read", {"--difference", path("ramp.png")});
  EXPECT_EQ(folder_.count(), files_);
}

TEST_F(Paint, PutsEachPixelWhereAViewerWillLookForIt) {
  const Said said = run("painted.obj");
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("1 views painted"), std::string::npos) << said.out;
  EXPECT_EQ(folder_.count(), files_ + 3);
  const auto picture = read_picture(path("painted.png"));
  ASSERT_TRUE(picture) << picture.error().message;
  const auto corners = corners_of(path("painted.obj"), *picture);
  ASSERT_EQ(corners.size(), 3U * 128);
  for (const Corner& corner : corners) {
    if (corner.position_mm.head<2>().cwiseAbs().maxCoeff() > 9) continue;  // a silhouette: grey beside it
    const auto pixel = project(scope_.lens, corner.position_mm);
    ASSERT_TRUE(pixel);
    const auto at = static_cast<std::size_t>(std::floor(corner.texels.y())) *
                        static_cast<std::size_t>(picture->width_px) +
                    static_cast<std::size_t>(std::floor(corner.texels.x()));
    EXPECT_NEAR(picture->rgba[4 * at], 255 * pixel->x() / 639, 3);
    EXPECT_NEAR(picture->rgba[4 * at + 1], 255 * pixel->y() / 479, 3);
  }
}

TEST_F(Paint, WritesPly) {
  const Said said = run("painted.ply", {"--json"});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(folder_.count(), files_ + 2);
  const auto surface = read_surface(path("painted.ply"));
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->mesh.triangles.size(), 128U);
  EXPECT_EQ(said.out.find("{\"views\": 1, \"views_without_paint\": 0, \"coverage\": 1.0"), 0U) << said.out;
  EXPECT_EQ(std::count(said.out.begin(), said.out.end(), '\n'), 1);
}

TEST_F(Paint, PaperModePaintsToo) {
  EXPECT_EQ(run("painted.obj", {"--mode", "paper"}).exit_code, 0);
}

TEST_F(Paint, WarnsOfAViewThatPaintedNothing) {
  folder_.write("views.csv", std::string(kView) + kFacingAway);
  const Said said = run("painted.obj");
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_NE(said.err.find("ramp.png painted nothing"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("--seen-from inside"), std::string::npos);
}

TEST_F(Paint, RefusesWhereNoViewPaints) {
  expect_refused("none of the 1 views painted anything", {"--seen-from", "inside"});
  expect_refused("try --seen-from outside", {"--seen-from", "inside"});
}

TEST_F(Paint, TellsWhichPoseWasMended) {
  folder_.write("views.csv", "ramp.png,1.004,0,0,0,0,1,0,0,0,0,1,0\n");
  const Said said = run("painted.obj");
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_NE(said.err.find("views.csv:1: the pose differs by 0.008 from a rotation and was made one"),
            std::string::npos);
}

TEST_F(Paint, RefusesPosesThatAreNoRotation) {
  folder_.write("views.csv", "ramp.png,1.1,0,0,0,0,1,0,0,0,0,1,0\n");
  expect_refused("views.csv:1: the pose differs by");
}

TEST_F(Paint, RefusesAPictureOfAnotherSizeEvenAfterGoodOnes) {
  ASSERT_TRUE(write_png(folder_ / "small.png", 1, 1, std::vector<std::uint8_t>(4)));
  folder_.write("views.csv", std::string(kView) + "small.png,1,0,0,0,0,1,0,0,0,0,1,0\n");
  expect_refused("small.png: the picture is 1x1 pixels, the scope's calibration is for 640x480");
}

TEST_F(Paint, NamesTheFileThatIsMissing) {
  folder_.write("views.csv", "gone.png,1,0,0,0,0,1,0,0,0,0,1,0\n");
  expect_refused("gone.png");
  for (const char* name : {"views.csv", "scope.toml", "surface.ply"}) {
    std::filesystem::remove(folder_ / name);
    expect_refused(name);
  }
}

TEST_F(Paint, ASurfaceThatStatesNoSpaceNeedsToBeTold) {
  folder_.write(
      "surface.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "-4 -4 20\n0 4 20\n4 -4 20\n3 0 1 2\n");
  expect_refused("--space");
  EXPECT_EQ(run("painted.obj", {"--space", "lps"}).exit_code, 0);
  EXPECT_EQ(run("painted.obj", {"--space", "RAS"}).exit_code, 0);
}

TEST_F(Paint, RefusesFormatsItCannotWrite) {
  const Said said = run("painted.stl");
  EXPECT_NE(said.exit_code, 0);
  EXPECT_NE(said.err.find(".obj, .ply or .glb"), std::string::npos) << said.err;
}

TEST_F(Paint, WritesGlbAlone) {
  const Said said = run("painted.glb");
  ASSERT_EQ(said.exit_code, 0) << said.err;
  EXPECT_EQ(folder_.count(), files_ + 1);
}

TEST_F(Paint, SaysHowFinelyAndHowStraightTheSurfaceWasSeen) {
  const Said said =
      run("painted.ply", {"--json", "--policy", "best", "--highlights", "yield", "--light", "auto_exposure"});
  ASSERT_EQ(said.exit_code, 0) << said.err;
  // 20 to 24 mm away, seen up to 35 degrees from the normal; a pixel is 1 / 340 rad.
  for (const auto& [key, least, most] :
       {std::tuple{"footprint_mm_median", 20.0 / 340, 24.0 / 340 / 0.8}, {"angle_deg_median", 10.0, 30.0}}) {
    const std::size_t at = said.out.find(key);
    ASSERT_NE(at, std::string::npos) << said.out;
    const double value = std::stod(said.out.substr(said.out.find(':', at) + 1));
    EXPECT_GT(value, least) << key;
    EXPECT_LT(value, most) << key;
  }
}

TEST_F(Paint, MapsWhatPaperModeCosts) {
  const Said flat = run("painted.obj", {"--difference", path("difference.png")});
  ASSERT_EQ(flat.exit_code, 0) << flat.err;
  EXPECT_NE(flat.out.find("paper mode against perspective: mean 0"), std::string::npos) << flat.out;
  const auto picture = read_picture(path("difference.png"));
  ASSERT_TRUE(picture) << picture.error().message;
  ASSERT_EQ(picture->width_px, 640);
  // Square to the view all is yellow: nothing is displaced. Beside the picture's circle it is white.
  const std::uint8_t* middle = &picture->rgba[4 * (240 * 640 + 320)];
  EXPECT_GT(middle[0], 240);
  EXPECT_LT(middle[2], 60);
  EXPECT_EQ(picture->rgba[0], 255);
  EXPECT_EQ(picture->rgba[2], 255);
  // Slanted by 27 degrees it is not.
  folder_.write("views.csv", "ramp.png,0.894427,0,-0.447214,8,0,1,0,0,0.447214,0,0.894427,4\n");
  const Said slanted = run("painted.obj", {"--json", "--difference", path("difference.glb")});
  ASSERT_EQ(slanted.exit_code, 0) << slanted.err;
  const std::size_t at = slanted.out.find("\"difference\": {\"mean_mm\": ");
  ASSERT_NE(at, std::string::npos) << slanted.out;
  EXPECT_GT(std::stod(slanted.out.substr(at + 28)), 0.5);
  EXPECT_TRUE(std::filesystem::exists(path("difference.glb")));
}

TEST_F(Paint, MapsATurnedViewThroughTheLensAtItsTurn) {
  // By half a turn the lens goes from 320 to the other side of 250 px.
  scope_.turning = Turning{.centre_px = {250, 240}};
  ASSERT_TRUE(write_scope(folder_ / "scope.toml", scope_));
  const auto blue_at_430 = [&](const std::string& turn_rad) {
    folder_.write("views.csv", "ramp.png,1,0,0,0,0,1,0,0,0,0,1,0," + turn_rad + "\n");
    const Said said = run("painted.obj", {"--difference", path("difference.png")});
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return int{read_picture(path("difference.png"))->rgba[4 * (240 * 640 + 430) + 2]};
  };
  EXPECT_LT(blue_at_430("0"), 60) << "yellow: on the plate, seen by a lens about 320";
  EXPECT_EQ(blue_at_430("3.14159265"), 255) << "white: beside the plate, seen by a lens about 180";
}

TEST_F(Paint, RefusesATurnedViewThroughAPassportThatDoesNotTurn) {
  folder_.write("views.csv", "ramp.png,1,0,0,0,0,1,0,0,0,0,1,0,0.5\n");
  expect_refused("has no [turning]");
}

TEST_F(Paint, RefusesAMapOfAViewThatPaperModeHasNoScaleFor) {
  // The centre passes the plate's edge, which still is in the picture.
  folder_.write("views.csv", "ramp.png,1,0,0,12,0,1,0,0,0,0,1,0\n");
  expect_refused("ramp.png: the central ray misses the surface", {"--difference", path("difference.png")});
  EXPECT_FALSE(std::filesystem::exists(path("difference.png")));
}

TEST_F(Paint, ColoursByWhatIsKnownOfEachTexel) {
  ASSERT_EQ(run("painted.ply").exit_code, 0);
  const auto as_seen = read_picture(path("painted.png"));
  for (const char* by : {"capture", "angle", "resolution", "error"}) {
    const Said said = run("painted.ply", {"--colour-by", by});
    ASSERT_EQ(said.exit_code, 0) << said.err;
    EXPECT_NE(read_picture(path("painted.png"))->rgba, as_seen->rgba) << by;
  }
}

}  // namespace
}  // namespace orcart
