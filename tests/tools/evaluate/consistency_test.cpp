// Two pictures of one wall are found to lie apart by as much as one of them was put wrong.
#include "tools/evaluate/consistency.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "board/sim/tissue.hpp"
#include "tests/tools/evaluate/ball_scene.hpp"
#include "tools/evaluate/error_chain.hpp"

namespace orcart {
namespace {

/// What a camera at the pose sees of the ball: mottled tissue, no light, no noise.
TakenPicture picture_from(const BallScene& ball, const Pose<M, C>& truly, const Pose<M, C>& believed) {
  TakenPicture taken{.picture = {.width_px = 640, .height_px = 480, .rgba = {}}, .X_MC = believed};
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      std::uint8_t grey = 0;
      if (const auto direction = direction_of(ball.scope.lens, {x, y})) {
        const Eigen::Vector3f along = (truly.rotation * *direction).cast<float>(),
                              from = truly.translation_mm.cast<float>();
        if (const auto hit = ball.rays.nearest(from, along, 100))
          grey = static_cast<std::uint8_t>(
              255 * tissue_colour(from + hit->distance_mm * along, 1).dot(Eigen::Vector3f(0.3F, 0.6F, 0.1F)));
      }
      taken.picture.rgba.insert(taken.picture.rgba.end(), {grey, grey, grey, 255});
    }
  return taken;
}

Pose<M, C> near_the_wall(double turn_rad) {
  Twist twist = Twist::Zero();
  twist[3] = turn_rad;
  Pose<M, C> pose = moved(Pose<M, C>{}, twist);
  pose.translation_mm = {0, 0, 14};
  return pose;
}

PairConsistency shifted_by(double shift_mm) {
  const BallScene ball;
  const Pose<M, C> first = near_the_wall(0), second = near_the_wall(0.1);
  Pose<M, C> wrong = second;
  wrong.translation_mm.x() += shift_mm;
  RandomStream random(1, 1);
  return compare(ball.scene(), picture_from(ball, first, first), picture_from(ball, second, wrong),
                 {.patches = 30}, random);
}

TEST(Consistency, PicturesInTheirPlaceAgree) {
  const PairConsistency pair = shifted_by(0);
  ASSERT_GE(pair.patches.size(), 3U);
  EXPECT_LT(pair.median_mm, 0.06);
}

TEST(Consistency, AShiftOfOneOfThemIsMeasured) {
  const PairConsistency pair = shifted_by(0.8);
  ASSERT_GE(pair.patches.size(), 3U);
  EXPECT_NEAR(pair.median_mm, 0.8, 0.12);
}

TEST(Consistency, AShiftThatBothShareIsNotSeen) {
  const BallScene ball;
  Pose<M, C> first = near_the_wall(0), second = near_the_wall(0.1);
  Pose<M, C> first_wrong = first, second_wrong = second;
  first_wrong.translation_mm.x() += 0.8;
  second_wrong.translation_mm.x() += 0.8;
  RandomStream random(1, 1);
  const PairConsistency pair = compare(ball.scene(), picture_from(ball, first, first_wrong),
                                       picture_from(ball, second, second_wrong), {.patches = 30}, random);
  ASSERT_GE(pair.patches.size(), 3U);
  EXPECT_LT(pair.median_mm, 0.1);
}

TEST(Consistency, TheCircleOfAnamorphicPixelsIsAnEllipse) {
  // The same optics and views: which patches are seen whole does not depend on the pixels' shape.
  const auto looked_at = [](double aspect) {
    BallScene ball;
    ball.scope.lens.fy_px = aspect * ball.scope.lens.fx_px;
    TakenPicture even{.picture = {.width_px = 640, .height_px = 480, .rgba = {}}, .X_MC = near_the_wall(0)};
    even.picture.rgba.assign(640UL * 480 * 4, 128);
    RandomStream random(1, 1);
    return compare(ball.scene(), even, even, {.patches = 300}, random).looked_at;
  };
  EXPECT_GT(looked_at(1), 50U);
  EXPECT_EQ(looked_at(0.9), looked_at(1));
}

TEST(Consistency, AnEvenPictureTellsNothing) {
  const BallScene ball;
  TakenPicture even{.picture = {.width_px = 640, .height_px = 480, .rgba = {}}, .X_MC = near_the_wall(0)};
  even.picture.rgba.assign(640UL * 480 * 4, 128);
  RandomStream random(1, 1);
  const PairConsistency pair = compare(ball.scene(), even, even, {.patches = 30}, random);
  EXPECT_TRUE(pair.patches.empty());
  EXPECT_GT(pair.looked_at, 0U);
}

TEST(Consistency, APatternThatRepeatsTellsNothing) {
  const BallScene ball;
  TakenPicture chequered{.picture = {.width_px = 640, .height_px = 480, .rgba = {}},
                         .X_MC = near_the_wall(0)};
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      const auto grey =
          static_cast<std::uint8_t>(std::lround(128 + 50 * std::sin(x / 6.0) + 50 * std::sin(y / 6.0)));
      chequered.picture.rgba.insert(chequered.picture.rgba.end(), {grey, grey, grey, 255});
    }
  RandomStream random(1, 1);
  const PairConsistency pair = compare(ball.scene(), chequered, chequered, {.patches = 30}, random);
  EXPECT_TRUE(pair.patches.empty()) << "many places are alike";
  EXPECT_GT(pair.looked_at, 0U);
}

}  // namespace
}  // namespace orcart
