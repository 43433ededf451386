// The chain of poses is right where it can be worked out by hand, and propagation agrees with draws.
#include "tools/evaluate/propagation.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/tools/evaluate/ball_scene.hpp"
#include "tools/evaluate/draw.hpp"

namespace orcart {
namespace {

Capture from_the_middle() {
  return {.X_MC = {}};  // looks along z at (0, 0, 30)
}

TEST(ErrorChain, WithoutErrorsLightLandsWhereItCameFrom) {
  const BallScene ball;
  RandomStream random(1, 1);
  for (int i = 0; i < 20; ++i) {
    const auto view = view_of_chance(ball.scene(), random);
    ASSERT_TRUE(view);
    for (const Landmark& landmark : landmarks_of_chance(ball.scene(), *view, 5, random)) {
      const auto place = painted_place(ball.scene(), {.X_MC = *view}, landmark, {}, {});
      ASSERT_TRUE(place);
      EXPECT_LT((*place - landmark.place_mm).norm(), 1e-3);
    }
  }
}

TEST(ErrorChain, ATurnOfTheScopeMarkerActsOverTheLever) {
  const BallScene ball;
  const auto landmark = landmark_at(ball.scene(), from_the_middle().X_MC, {320, 240});
  ASSERT_TRUE(landmark);
  DrawnErrors errors;
  errors.scope[4] = 0.001;  // about y, 250 mm to C and 30 more to the wall
  const auto place = painted_place(ball.scene(), from_the_middle(), *landmark, errors, {});
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->x(), 0.280, 0.002);
  EXPECT_NEAR(place->y(), 0, 0.001);
}

TEST(ErrorChain, AShiftOfTheRegistrationMovesThePaintByAsMuch) {
  const BallScene ball;
  const auto landmark = landmark_at(ball.scene(), from_the_middle().X_MC, {320, 240});
  DrawnErrors errors;
  errors.registration[0] = 0.4;
  const auto place = painted_place(ball.scene(), from_the_middle(), *landmark, errors, {});
  EXPECT_NEAR(place->x(), 0.4, 0.002);
}

TEST(ErrorChain, ADelayMovesThePaintBySpeedTimesTime) {
  const BallScene ball;
  const auto landmark = landmark_at(ball.scene(), from_the_middle().X_MC, {320, 240});
  Capture moving = from_the_middle();
  moving.velocity[1] = 20;
  DrawnErrors errors;
  errors.time_s = 0.01;
  EXPECT_NEAR(painted_place(ball.scene(), moving, *landmark, errors, {})->y(), 0.2, 0.002);
}

TEST(ErrorChain, AirForWaterBendsAsSnellSays) {
  const BallScene ball;
  DrawnErrors errors;
  errors.refraction = 0.333;
  const double angle = 0.2;
  const auto direction = believed_direction(ball.scene(), {320 + 340 * std::tan(angle), 240}, errors);
  ASSERT_TRUE(direction);
  EXPECT_NEAR(std::asin(direction->x()), std::asin(1.333 * std::sin(angle)), 1e-9);
}

TEST(BodySpread, OfThreeMarkersIsTheTextbooks) {
  // Markers on the axes at 10 mm: x moves by sigma / sqrt(n) at the centroid's own place.
  const auto root = body_spread({{10, 0, 0}, {-10, 0, 0}, {0, 10, 0}, {0, -10, 0}}, 0.2);
  const Eigen::Matrix<double, 6, 6> covariance = root * root.transpose();
  EXPECT_NEAR(std::sqrt(covariance(0, 0)), 0.2 / 2, 1e-9);
  EXPECT_NEAR(std::sqrt(covariance(5, 5)), 0.2 / std::sqrt(400.0), 1e-9);  // about z: sum of r^2
  EXPECT_NEAR(std::sqrt(covariance(3, 3)), 0.2 / std::sqrt(200.0), 1e-9);
}

TEST(BodySpread, AgreesWithDrawnBodies) {
  const auto markers = BallScene().scene().scope_markers_mm;
  const auto root = body_spread(markers, 0.12 / std::numbers::sqrt3);
  const Eigen::Matrix<double, 6, 6> expected = root * root.transpose();
  Eigen::Matrix<double, 6, 6> drawn = Eigen::Matrix<double, 6, 6>::Zero();
  RandomStream random(3, 1);
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const Twist twist = drawn_body(markers, 0.12, random);
    drawn += twist * twist.transpose() / kDraws;
  }
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(drawn(i, i) / expected(i, i), 1, 0.05) << i;
}

TEST(Propagation, OfARegistrationShiftAloneIsItsSpread) {
  const BallScene ball;
  const EvaluationScene scene = ball.scene();
  const auto landmark = landmark_at(scene, from_the_middle().X_MC, {320, 240});
  RandomStream random(1, 2);
  const auto fiducials = fiducials_of_chance(scene, 6, random);
  const ErrorModel model;
  const auto predicted = predict(scene, model, spread_of(scene, model, fiducials), from_the_middle(),
                                 *landmark, only(Component::registration));
  ASSERT_TRUE(predicted);
  double sum = 0;
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; ++i) {
    DrawnErrors errors;
    errors.registration = drawn_registration(scene, model, fiducials, random);
    const auto place = painted_on_plane(scene, from_the_middle(), *landmark, errors, {});
    sum += (*place - landmark->place_mm).squaredNorm() / kDraws;
  }
  EXPECT_NEAR(std::sqrt(sum) / predicted->rms_mm(), 1, 0.04);
}

TEST(PredictedError, AnEllipseOf95PercentHoldsThatMany) {
  const PredictedError error{.covariance_mm2 = Eigen::Vector2d(0.04, 0.25).asDiagonal()};
  RandomStream random(5, 1);
  int held = 0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const double x = 0.2 * random.gaussian(), y = 0.5 * random.gaussian();
    held += error.covers({x, y}) ? 1 : 0;
  }
  EXPECT_NEAR(held / static_cast<double>(kDraws), 0.95, 0.006);
}

}  // namespace
}  // namespace orcart
