// Brightness compensation by hand.
#include "realtime/optics/fall_off.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(FallOff, IsOneAtTheReferenceDistanceOnTheAxis) {
  EXPECT_DOUBLE_EQ(brightness_compensation({.reference_mm = 20, .vignetting_cos_power = 4}, 20, 0), 1);
}

TEST(FallOff, GrowsWithTheSquareOfDistance) {
  EXPECT_DOUBLE_EQ(brightness_compensation({.reference_mm = 20}, 60, 0), 9);
}

TEST(FallOff, UndoesVignetting) {
  // cos(60 degrees) = 1/2, squared: a quarter of the light.
  EXPECT_NEAR(
      brightness_compensation({.reference_mm = 20, .vignetting_cos_power = 2}, 20, 1.0471975511965976), 4,
      1e-12);
}

}  // namespace
}  // namespace orcart
