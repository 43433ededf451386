// What passport and registration state takes the place of what is assumed, in draws, prediction and words.
#include "tools/evaluate/stated_errors.hpp"

#include <gtest/gtest.h>

#include "firmware-host/files/surface_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/tools/evaluate/ball_scene.hpp"
#include "tools/evaluate/draw.hpp"
#include "tools/evaluate/evaluate_command.hpp"

namespace orcart {
namespace {

/// A passport that leaves more open than is assumed, and not alike in its axes.
ScopeModel doubtful(ScopeModel scope) {
  scope.lens_covariance = LensCovariance::Zero();
  scope.lens_covariance->diagonal().head<5>() << 4, 4, 1, 1, 1e-4;
  (*scope.lens_covariance)(0, 4) = (*scope.lens_covariance)(4, 0) = -0.015;
  scope.hand_eye_covariance = TwistCovariance::Zero();
  scope.hand_eye_covariance->diagonal() << 0.25, 0.25, 1, 1e-5, 1e-5, 4e-5;
  (*scope.hand_eye_covariance)(0, 4) = (*scope.hand_eye_covariance)(4, 0) = 0.001;
  return scope;
}

TEST(StatedErrors, AreDrawnAsThePassportSays) {
  BallScene ball;
  ball.scope = doubtful(ball.scope);
  RegistrationFile registration{.covariance = TwistCovariance::Identity() / 100};
  const ErrorModel model = with_stated({}, ball.scope, registration);
  RandomStream random(3, 1);
  const auto fiducials = fiducials_of_chance(ball.scene(), model.fiducials, random);
  LensCovariance lens = LensCovariance::Zero();
  TwistCovariance hand_eye = TwistCovariance::Zero(), registered = TwistCovariance::Zero();
  constexpr int kDraws = 8000;
  for (int i = 0; i < kDraws; ++i) {
    const DrawnErrors e = drawn_errors(ball.scene(), model, kAllComponents, fiducials, random);
    EXPECT_TRUE(e.lens.isZero(0));
    lens += e.lens_numbers * e.lens_numbers.transpose() / kDraws;
    hand_eye += e.hand_eye * e.hand_eye.transpose() / kDraws;
    registered += e.registration * e.registration.transpose() / kDraws;
  }
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(hand_eye(i, i) / (*ball.scope.hand_eye_covariance)(i, i), 1, 0.08) << i;
    EXPECT_NEAR(registered(i, i) / 0.01, 1, 0.08) << i;
  }
  EXPECT_NEAR(hand_eye(0, 4), 0.001, 1e-4);
  EXPECT_NEAR(lens(4, 4) / 1e-4, 1, 0.08);
  EXPECT_NEAR(lens(0, 4), -0.015, 0.0015);
  const Eigen::MatrixXd held = lens.bottomRightCorner(6, 6);
  EXPECT_TRUE(held.isZero(0));
}

TEST(StatedErrors, ThePredictionStillCovers95Percent) {
  BallScene ball;
  ball.scope = doubtful(ball.scope);
  SimulationRequest request{.model = with_stated({}, ball.scope, {}), .setups = 600, .landmarks = 4};
  const auto result = simulate(ball.scene(), request);
  ASSERT_TRUE(result);
  EXPECT_GT(result->coverage.share(), 0.93);
  EXPECT_LT(result->coverage.share(), 0.97);
}

TEST(StatedErrors, AreTheAssumedOnesWhereNothingIsStated) {
  const ErrorModel model = with_stated({}, plain_scope(), {});
  EXPECT_FALSE(model.hand_eye_root || model.lens_root || model.registration_root);
  EXPECT_NE(sources_text(model).find("hand-eye 0.120 mm and 1.20 mrad an axis (assumed)"), std::string::npos);
  EXPECT_EQ(sources_json(with_time(model, 0.001)),
            "{\"hand-eye\": \"assumed\", \"lens\": \"assumed\", \"registration\": \"assumed\", \"medium\": "
            "\"assumed\", \"time\": \"told\"}");
}

TEST(StatedErrors, ATurnIsToldElseThePassportsNotchsElseAssumed) {
  ScopeModel scope = plain_scope();
  EXPECT_EQ(with_stated({}, scope, {}).light_post_rad, 0) << "a scope in one piece";
  scope.turning.emplace();
  const ErrorModel assumed = with_stated({}, scope, {});
  EXPECT_EQ(assumed.light_post_rad, kAssumedErrors.light_post_rad);
  EXPECT_NE(sources_text(assumed).find("light post's turn 0.20 degrees (assumed)"), std::string::npos);
  scope.turning->notch_deviation_rad = 0.01;
  const ErrorModel stated = with_stated({}, scope, {});
  EXPECT_EQ(stated.light_post_rad, 0.01);
  EXPECT_EQ(with_stated(stated, scope, {}).light_post_from, ErrorFrom::passport) << "stated once more";
  EXPECT_NE(sources_json(stated).find("\"light post\": \"passport\"}"), std::string::npos);
  for (const double told_rad : {0.02, 0.0}) {
    const ErrorModel told = with_stated(with_turn({}, told_rad), scope, {});
    EXPECT_EQ(told.light_post_rad, told_rad);
    EXPECT_NE(sources_json(told).find("\"light post\": \"told\"}"), std::string::npos);
  }
}

TEST(StatedErrors, ATurnsDeviationIsRefusedForAScopeThatDoesNotTurn) {
  ScopeModel scope = plain_scope();
  EXPECT_TRUE(check_turn_told({}, scope));
  const auto refused = check_turn_told(with_turn({}, 0.01), scope);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("has no [turning]"), std::string::npos) << refused.error().message;
  scope.turning.emplace();
  EXPECT_TRUE(check_turn_told(with_turn({}, 0.01), scope));
}

TEST(StatedErrors, ARegistrationOfAnotherSurfaceIsRefused) {
  EXPECT_TRUE(check_surface({.surface_hash = "cafe"}, "cafe"));
  EXPECT_TRUE(check_surface({.surface_hash = "unstated"}, "cafe"));
  const auto refused = check_surface({.surface_hash = "beef"}, "cafe");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("belongs to the surface beef"), std::string::npos);
}

TEST(Evaluate, RefusesARegistrationOfAnotherSurface) {
  const TemporaryFolder folder;
  const BallScene ball;
  ASSERT_TRUE(write_ply(folder / "ball.ply", *make_surface(ball.mesh, "ball")));
  ASSERT_TRUE(write_scope(folder / "scope.toml", ball.scope));
  const auto share = std::filesystem::path(std::getenv("ORCART_SOURCE_DIR")) / "share";
  const auto report = evaluate({.surface = folder / "ball.ply",
                                .scope = folder / "scope.toml",
                                .registration = share / "carts/demo-registration.toml",
                                .scope_rom = share / "tools/scope.rom",
                                .reference_rom = share / "tools/reference.rom",
                                .noises = {{"vega", 0.12}}},
                               [](const std::string&, double) {});
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("demo-registration.toml: belongs to the surface"), std::string::npos);
}

/// `orcart evaluate` on the ball, by files.
EvaluationReport evaluated(const TemporaryFolder& folder, const ScopeModel& scope,
                           const ErrorModel& model = {}) {
  const BallScene ball;
  const Surface surface = *make_surface(ball.mesh, "ball");
  EXPECT_TRUE(write_ply(folder / "ball.ply", surface));
  EXPECT_TRUE(write_scope(folder / "scope.toml", scope));
  EXPECT_TRUE(write_registration(folder / "registration.toml",
                                 {.X_MR = ball.scene().X_MR, .surface_hash = surface.identity.hash}));
  const auto share = std::filesystem::path(std::getenv("ORCART_SOURCE_DIR")) / "share/tools";
  EvaluateCommand command{.surface = folder / "ball.ply",
                          .scope = folder / "scope.toml",
                          .registration = folder / "registration.toml",
                          .scope_rom = share / "scope.rom",
                          .reference_rom = share / "reference.rom",
                          .simulation = {.model = model, .setups = 100, .landmarks = 4},
                          .noises = {{"vega", 0.12}},
                          .pairs = 0};
  const auto report = evaluate(command, [](const std::string&, double) {});
  EXPECT_TRUE(report) << report.error().message;
  return report.value_or(EvaluationReport{});
}

TEST(Evaluate, DrawsTheTurnAsWellAsItIsTold) {
  const TemporaryFolder folder;
  ScopeModel scope = plain_scope();
  scope.turning = Turning{.centre_px = {290, 260}};
  const auto part = static_cast<std::size_t>(Component::light_post);
  const auto mean_mm = [&](const ErrorModel& model) {
    const EvaluationReport report = evaluated(folder, scope, model);
    EXPECT_NE(json_of(report).find("\"light_post_rad\": "), std::string::npos);
    return report.runs[0].result.alone[part].mean;
  };
  const double assumed_mm = mean_mm({});
  EXPECT_NEAR(mean_mm(with_turn({}, 3 * kAssumedErrors.light_post_rad)) / assumed_mm, 3, 0.05);
  scope.turning->notch_deviation_rad = 2 * kAssumedErrors.light_post_rad;
  EXPECT_NEAR(mean_mm({}) / assumed_mm, 2, 0.05);
}

TEST(Evaluate, TakesThePassportsCovariancesAndSaysSo) {
  const TemporaryFolder folder;
  const EvaluationReport assumed = evaluated(folder, plain_scope()),
                         stated = evaluated(folder, doubtful(plain_scope()));
  const auto hand_eye = static_cast<std::size_t>(Component::hand_eye),
             lens = static_cast<std::size_t>(Component::lens),
             tracker = static_cast<std::size_t>(Component::tracker);
  EXPECT_GT(stated.runs[0].result.alone[hand_eye].mean, 2 * assumed.runs[0].result.alone[hand_eye].mean);
  EXPECT_GT(stated.runs[0].result.alone[lens].mean, 1.5 * assumed.runs[0].result.alone[lens].mean);
  EXPECT_EQ(stated.runs[0].result.alone[tracker].mean, assumed.runs[0].result.alone[tracker].mean);
  EXPECT_GT(stated.runs[0].result.predicted_rms.mean, 1.3 * assumed.runs[0].result.predicted_rms.mean);
  EXPECT_NE(json_of(stated).find("\"errors_from\": {\"hand-eye\": \"passport\", \"lens\": \"passport\""),
            std::string::npos);
  EXPECT_NE(json_of(assumed).find("\"errors_from\": {\"hand-eye\": \"assumed\", \"lens\": \"assumed\""),
            std::string::npos);
  EXPECT_NE(text_of(stated).find("(passport); lens"), std::string::npos);
}

}  // namespace
}  // namespace orcart
