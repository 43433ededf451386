// Simulated set-ups: independent, repeatable, and where the answer is known, right.
#include "tools/evaluate/simulation.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/tools/evaluate/ball_scene.hpp"

namespace orcart {
namespace {

SimulationRequest small(int setups = 200) {
  SimulationRequest request;
  request.setups = setups;
  request.landmarks = 4;
  return request;
}

TEST(Simulation, DoesNotDependOnTheNumberOfThreads) {
  const BallScene ball;
  SimulationRequest one = small(40), many = small(40);
  one.threads = 1;
  many.threads = 3;
  const auto a = simulate(ball.scene(), one), b = simulate(ball.scene(), many);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->mapping_errors_mm, b->mapping_errors_mm);
}

TEST(Simulation, AnotherSeedDrawsOtherSetUps) {
  const BallScene ball;
  SimulationRequest other = small(40);
  other.seed = 2;
  const auto a = simulate(ball.scene(), small(40)), b = simulate(ball.scene(), other);
  ASSERT_TRUE(a && b);
  EXPECT_NE(a->mapping_errors_mm, b->mapping_errors_mm);
}

SimulationRequest exactly(int setups) {
  SimulationRequest exact = small(setups);
  exact.model = {.marker_rms_mm = 0,
                 .fiducial_rms_mm = 0,
                 .hand_eye_mm = 0,
                 .hand_eye_rad = 0,
                 .lens_centre_px = 0,
                 .lens_focal = 0,
                 .lens_edge_px = 0,
                 .refraction = 0,
                 .time_s = 0,
                 .picture_px = 0,
                 .texel_mm = 0};
  return exact;
}

TEST(Simulation, WithoutAnyErrorNothingIsWrong) {
  const BallScene ball;
  const auto result = simulate(ball.scene(), exactly(40));
  ASSERT_TRUE(result);
  EXPECT_LT(result->mapping.max, 1e-3);
  EXPECT_LT(result->tip.max, 1e-9);
  EXPECT_LT(result->tracking.max, 1e-9);
}

TEST(Simulation, WhatThePassportLeavesOpenOfTheWindowIsAnErrorOfTheTipAlone) {
  const BallScene ball;
  SimulationRequest request = exactly(400);
  request.model.window_root = Eigen::Vector3d(0, 0, 0.3).asDiagonal();
  const auto result = simulate(ball.scene(), request);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->tip_3d.mean, 0.3 * std::sqrt(2 / std::numbers::pi), 0.03);  // of a Gaussian's size
  EXPECT_LT(result->mapping.max, 1e-3);
}

TEST(Simulation, TrackingIsTheRepeatabilityOfAPosition) {
  const BallScene ball;
  const auto result = simulate(ball.scene(), small(400));
  ASSERT_TRUE(result);
  // The marker at the body's origin and the centroid nearly coincide: 0.12 / sqrt(4) RMS, less 1/5 for the
  // mean.
  EXPECT_EQ(result->tracking.count, 2000U);
  EXPECT_NEAR(result->tracking.mean, 0.12 / 2 * std::sqrt(0.8) * std::sqrt(8 / (3 * std::numbers::pi)),
              0.006);
}

TEST(Simulation, ThePredictionCovers95Percent) {
  const BallScene ball;
  const auto result = simulate(ball.scene(), small(1000));
  ASSERT_TRUE(result);
  EXPECT_GT(result->coverage.points, 3500U);
  EXPECT_GT(result->coverage.share(), 0.93);
  EXPECT_LT(result->coverage.share(), 0.97);
}

TEST(Simulation, TheSquaresOfThePartsAddUp) {
  const BallScene ball;
  const auto honest = simulate(ball.scene(), small(300));
  ASSERT_TRUE(honest);
  // All together is more than any part, and the parts' squares add up to its square.
  double squares = 0;
  for (const Statistics& part : honest->alone) {
    EXPECT_LT(part.mean, honest->mapping.mean);
    squares += part.mean * part.mean + part.sd * part.sd;
  }
  const double all = honest->mapping.mean * honest->mapping.mean + honest->mapping.sd * honest->mapping.sd;
  EXPECT_NEAR(squares / all, 1, 0.25);
}

TEST(Simulation, ASurfaceWithoutRoomIsRefused) {
  const TriangleMesh mesh = hollow_ball(2, 8);
  const RayScene rays = *RayScene::create(mesh);
  const BallScene ball;
  EvaluationScene scene{.mesh = mesh, .rays = rays, .scope = ball.scope};
  scene.scope_markers_mm = ball.scene().scope_markers_mm;
  scene.reference_markers_mm = ball.scene().reference_markers_mm;
  const auto result = simulate(scene, small(10));
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("no view of the surface has 2 mm of room"), std::string::npos);
}

TEST(Statistics, OfOneToTen) {
  const Statistics s = statistics_of({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  EXPECT_DOUBLE_EQ(s.mean, 5.5);
  EXPECT_NEAR(s.sd, 3.02765, 1e-5);
  EXPECT_EQ(s.max, 10);
  EXPECT_NEAR(s.mean_high - s.mean, 2.262 * 3.02765 / std::sqrt(10.0), 1e-4);
}

}  // namespace
}  // namespace orcart
