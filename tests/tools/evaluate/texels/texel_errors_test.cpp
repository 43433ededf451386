// Predictions of painted texels against independent draws, and against what really lands in the atlas.
#include "tools/evaluate/texels/error_map.hpp"

#include <gtest/gtest.h>

#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/tools/evaluate/ball_scene.hpp"
#include "tools/evaluate/stated_errors.hpp"

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
    write_views({0, 0, 0});
  }

  /// One view of chance for each turn; `velocity` is the end of each line, with its commas.
  void write_views(const std::vector<double>& turns_rad, const std::string& velocity = "") {
    RandomStream random(7, 1);
    std::string csv = "image,m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23,turn_rad";
    csv += velocity.empty() ? "\n" : ",vx_mm_s,vy_mm_s,vz_mm_s,wx_rad_s,wy_rad_s,wz_rad_s\n";
    for (const double turn_rad : turns_rad) {
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
      csv += "," + std::to_string(turn_rad) + velocity + "\n";
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

TEST_F(TexelErrors, OfARegistrationOfAnotherSurfaceAreRefused) {
  ASSERT_TRUE(write_registration(folder_ / "registration.toml", {.surface_hash = "beef"}));
  const auto report = made(command("map.ply"));
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("belongs to the surface beef"), std::string::npos);
}

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

TEST_F(TexelErrors, OfAScopeThatTurnedHoldThemToo) {
  // A lens well beside what it turns about, and a camera known a lot better along its x than along its y.
  ball_.scope.turning =
      Turning{.centre_px = {290, 260}, .marker = TurnMarker::head, .axis = {0, 0.5, std::sqrt(0.75)}};
  ball_.scope.lens.cx_px = 335;
  ball_.scope.hand_eye_covariance = TwistCovariance::Zero();
  ball_.scope.hand_eye_covariance->diagonal() << 0.01, 0.25, 0.01, 1e-7, 1e-7, 1e-7;
  ASSERT_TRUE(write_scope(folder_ / "scope.toml", ball_.scope));
  write_views({0, 1.5, -2.2});
  auto ask = command("map.ply");
  ask.model.light_post_rad = 0.03;
  const auto turned = made(ask);
  ASSERT_TRUE(turned) << turned.error().message;
  EXPECT_GE(turned->drawn.coverage.share(), 0.93);
  EXPECT_LE(turned->drawn.coverage.share(), 0.97);
  ::testing::Test::RecordProperty("coverage95", std::to_string(turned->drawn.coverage.share()));
  EXPECT_NE(text_of(*turned).find("light post's turn 1.72 degrees"), std::string::npos) << text_of(*turned);
  ask.model.light_post_rad = 1e-6;
  const auto exact = made(ask);
  ASSERT_TRUE(exact);
  EXPECT_LT(exact->rms_mm.mean, 0.98 * turned->rms_mm.mean);
}

TEST_F(TexelErrors, OfTurnedViewsThroughAPassportThatDoesNotTurnAreRefused) {
  write_views({0, 0.5, 0});
  const auto refused = made(command("map.ply"));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("has no [turning]"), std::string::npos) << refused.error().message;
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

TEST_F(TexelErrors, OfTimeGrowWithTheVelocityThatTheViewsTell) {
  auto ask = command("map.ply");
  ask.model = with_time(ask.model, 0.02);
  const auto made_with = [&](const std::string& velocity) {
    write_views({0, 0, 0}, velocity);
    return made(ask);
  };
  const auto unsaid = made_with(""), unknown = made_with(",,,,,,"), still = made_with(",0,0,0,0,0,0"),
             fast = made_with(",60,80,0,0,0,0");
  ASSERT_TRUE(unsaid && unknown && still && fast);
  EXPECT_EQ(unknown->rms_mm.mean, unsaid->rms_mm.mean) << "as the model assumes";
  EXPECT_LT(still->rms_mm.mean, unsaid->rms_mm.mean);
  // 100 mm/s by 20 ms is 2 mm along the wall, and more where it slants.
  EXPECT_GT(std::sqrt(std::pow(fast->rms_mm.mean, 2) - std::pow(still->rms_mm.mean, 2)), 1.9);
  EXPECT_GE(fast->drawn.coverage.share(), 0.93) << "the draws move as fast";
  EXPECT_LE(fast->drawn.coverage.share(), 0.97);
  EXPECT_EQ(unknown->velocities.assumed, 3U);
  EXPECT_NE(text_of(*fast).find("velocity: of 3 views told, of 0 assumed; those told move by 100.0 mm/s"),
            std::string::npos)
      << text_of(*fast);
  EXPECT_NE(json_of(*fast).find("\"velocity\": {\"told\": 3, \"assumed\": 0"), std::string::npos);
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
