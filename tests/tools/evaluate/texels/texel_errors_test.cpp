// Predictions of painted texels against independent draws, and against what really lands in the atlas.
#include "tools/evaluate/texels/error_map.hpp"

#include <gtest/gtest.h>

#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/tools/evaluate/ball_scene.hpp"

namespace orcart {
namespace {

/// A ball painted from within by views of chance, the files a person would have.
class TexelErrors : public ::testing::Test {
 protected:
  void SetUp() override {
    ball_.scope.calibrated_on = "2026-01-01";
    const Surface surface = *make_surface(ball_.mesh, "ball");
    ASSERT_TRUE(write_ply(folder_ / "ball.ply", surface));
    ASSERT_TRUE(write_scope(folder_ / "scope.toml", ball_.scope));
    ASSERT_TRUE(write_registration(folder_ / "registration.toml",
                                   {.X_MR = ball_.scene().X_MR, .surface_hash = surface.identity.hash}));
    const std::vector<std::uint8_t> grey(640UL * 480 * 4, 128);
    ASSERT_TRUE(write_png(folder_ / "grey.png", 640, 480, grey));
    RandomStream random(7, 1);
    std::string csv;
    for (int i = 0; i < 3; ++i) {
      const auto X = view_of_chance(ball_.scene(), random);
      ASSERT_TRUE(X);
      csv += "grey.png";
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
          char number[32];
          std::snprintf(number, sizeof number, ",%.17g",
                        column < 3 ? X->rotation(row, column) : X->translation_mm[row]);
          csv += number;
        }
      csv += "\n";
    }
    folder_.write("views.csv", csv);
  }

  ErrorMapCommand command(const std::string& out) const {
    const auto share = std::filesystem::path(std::getenv("ORCART_SOURCE_DIR")) / "share/tools";
    return {.surface = folder_ / "ball.ply",
            .scope = folder_ / "scope.toml",
            .registration = folder_ / "registration.toml",
            .scope_rom = share / "scope.rom",
            .reference_rom = share / "reference.rom",
            .views = folder_ / "views.csv",
            .out = folder_ / out,
            .texel_mm = 0.8,
            .setups = 300};
  }
  static Result<ErrorMapReport> made(const ErrorMapCommand& command) {
    return make_error_map(command, [](const std::string&, double) {});
  }

  BallScene ball_;
  TemporaryFolder folder_;
};

TEST_F(TexelErrors, TheirNinetyFivePercentHoldNinetyThreeToNinetySeven) {
  const auto report = made(command("map.ply"));
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_GT(report->texels, 300U);
  EXPECT_GE(report->drawn.coverage.points, 7000U);  // 300 set-ups, 3 views, 8 texels
  EXPECT_GE(report->drawn.coverage.share(), 0.93);
  EXPECT_LE(report->drawn.coverage.share(), 0.97);
  ::testing::Test::RecordProperty("coverage95", std::to_string(report->drawn.coverage.share()));
  EXPECT_GT(report->rms_mm.mean, 0.2);
  EXPECT_LT(report->rms_mm.mean, 2);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "map.ply"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "map.png"));
}

TEST_F(TexelErrors, GrowWithTheTrackersNoise) {
  auto quiet = command("map.png"), loud = quiet;
  quiet.setups = loud.setups = 1;
  quiet.model.marker_rms_mm = 0.05;
  loud.model.marker_rms_mm = 0.5;
  const auto a = made(quiet), b = made(loud);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->texels, b->texels);
  EXPECT_GT(b->rms_mm.mean, 2 * a->rms_mm.mean);
  const auto picture = read_picture(folder_ / "map.png");
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->width_px, 640);
}

TEST_F(TexelErrors, NothingIsWrittenWhereNothingIsPainted) {
  auto wrong = command("map.ply");
  wrong.seen_from = SeenFrom::outside;
  const auto report = made(wrong);
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("none of the 3 views painted anything"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "map.ply"));
}

}  // namespace
}  // namespace orcart
