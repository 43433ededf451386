// Facing and obliquity of single triangles, by hand.
#include "realtime/mapper/facing.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace orcart {
namespace {

using Corners = std::array<Eigen::Vector3f, 3>;

constexpr double kCos80 = 0.17364817766693033;
/// Outward normal -z.
const Corners kDown{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}};

TEST(Facing, IsFrontOnTheOutwardSide) {
  EXPECT_EQ(facing_of(kDown, {0.2F, 0.2F, -5}, SeenFrom::outside, kCos80), Facing::front);
  EXPECT_EQ(facing_of(kDown, {0.2F, 0.2F, 5}, SeenFrom::outside, kCos80), Facing::back);
}

TEST(Facing, IsFrontOnTheOtherSideSeenFromInside) {
  EXPECT_EQ(facing_of(kDown, {0.2F, 0.2F, -5}, SeenFrom::inside, kCos80), Facing::back);
  EXPECT_EQ(facing_of(kDown, {0.2F, 0.2F, 5}, SeenFrom::inside, kCos80), Facing::front);
}

TEST(Facing, TellsMicrometresAboveThePlaneFarFromTheOrigin) {
  Corners far = kDown;
  for (auto& corner : far) corner += Eigen::Vector3f(200, 150, 128);
  const float just_below = std::nextafter(128.F, 0.F);
  EXPECT_EQ(facing_of(far, {200.2F, 150.2F, just_below}, SeenFrom::outside, kCos80), Facing::front);
  EXPECT_EQ(facing_of(far, {200.2F, 150.2F, 128}, SeenFrom::outside, kCos80), Facing::back);
}

TEST(Facing, IsSteepBeyondTheLimitEverywhereOnTheTriangle) {
  // 1 mm above the plane, d mm beside the nearest edge at x = 0: atan(d) off the normal there; 80 degrees
  // at 5.671.
  EXPECT_EQ(facing_of(kDown, {-5.66F, 0.5F, -1}, SeenFrom::outside, kCos80), Facing::front);
  EXPECT_EQ(facing_of(kDown, {-5.68F, 0.5F, -1}, SeenFrom::outside, kCos80), Facing::steep);
}

TEST(Facing, LooksAtEdgesAndMiddleNotOnlyAtCorners) {
  const Corners large{{{-100, -100, 0}, {0, 100, 0}, {100, -100, 0}}};
  EXPECT_EQ(facing_of(large, {0, 0, -1}, SeenFrom::outside, kCos80), Facing::front);
  EXPECT_EQ(facing_of(large, {0, -105, -1}, SeenFrom::outside, kCos80), Facing::front);
  EXPECT_EQ(facing_of(large, {0, -106, -1}, SeenFrom::outside, kCos80), Facing::steep);
}

TEST(Facing, IsBackWithoutArea) {
  const Corners line{{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}};
  EXPECT_EQ(facing_of(line, {5, 0, 0}, SeenFrom::outside, kCos80), Facing::back);
  EXPECT_EQ(facing_of(line, {5, 0, 0}, SeenFrom::inside, kCos80), Facing::back);
}

}  // namespace
}  // namespace orcart
