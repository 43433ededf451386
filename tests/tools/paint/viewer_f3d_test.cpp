// f3d, a viewer that people have: the painted globe in each format, rendered in memory and looked at.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "firmware-host/files/picture_file.hpp"
#include "tests/board/sim/virtual_screen.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/tools/paint/globe.hpp"

namespace orcart::testing {
namespace {

constexpr int kSize_px = 240;

bool there_is(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

std::string words(const Eigen::Vector3d& p) {
  return std::to_string(p.x()) + "," + std::to_string(p.y()) + "," + std::to_string(p.z());
}

class F3d : public ::testing::TestWithParam<const char*> {};

TEST_P(F3d, ShowsTheRightPictureAtTheRightPlace) {
  if (!there_is("f3d")) GTEST_SKIP() << "f3d is not installed";
  if (!there_is("Xvfb")) GTEST_SKIP() << "Xvfb, without which f3d does not draw here, is not installed";
  const VirtualScreen screen;
  ASSERT_TRUE(screen.runs());
  const TemporaryFolder folder;
  Globe::write(folder / "");
  const std::string kind = GetParam();
  const bool gltf = kind == "glb";
  for (const GlobeView& view : globe_views()) {
    const Eigen::Vector3d eye = gltf ? as_gltf(view.eye_mm()) : view.eye_mm(),
                          target = gltf ? as_gltf(Globe::kCentre_mm) : Globe::kCentre_mm,
                          up = gltf ? Eigen::Vector3d(1000 * as_gltf(view.up)) : view.up;
    const std::string picture_file = (folder / "shown.png").string();
    const std::string command =
        "f3d --quiet --no-background " + (folder / ("globe." + kind)).string() + " --output=" + picture_file +
        " --resolution=" + std::to_string(kSize_px) + "," + std::to_string(kSize_px) +
        " --camera-position=" + words(eye) + " --camera-focal-point=" + words(target) +
        " --camera-view-up=" + words(up) + " --camera-view-angle=30" +
        (kind == "ply" ? " --roughness=1 --texture-base-color=" + (folder / "globe.png").string() : "") +
        " >/dev/null 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    const auto picture = read_picture(picture_file);
    ASSERT_TRUE(picture) << picture.error().message;
    ASSERT_EQ(picture->width_px, kSize_px);
    const Agreement found = agreement(view, kSize_px, [&](int x, int y) {
      const auto* rgb = &picture->rgba[4 * static_cast<std::size_t>(y * kSize_px + x)];
      return std::array<int, 3>{rgb[0], rgb[1], rgb[2]};
    });
    EXPECT_GT(found.right, 500);
    EXPECT_LE(found.wrong, found.right / 50) << "of " << found.right;
    if (const char* kept = std::getenv("ORCART_PICTURES"))
      std::filesystem::copy_file(
          picture_file,
          std::filesystem::path(kept) / ("f3d_" + kind + (view.from.x() > 0 ? "_a" : "_b") + ".png"),
          std::filesystem::copy_options::overwrite_existing);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, F3d, ::testing::Values("obj", "ply", "glb"),
                         [](const auto& name) { return std::string(name.param); });

}  // namespace
}  // namespace orcart::testing
