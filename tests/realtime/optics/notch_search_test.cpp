// The notch is found to a fifth of a degree at any turn, and nowhere else.
#include "realtime/optics/notch_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "realtime/optics/scope_turn.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

ScopeModel scope_with_notch() {
  ScopeModel scope{.width_px = 640, .height_px = 480};
  scope.lens = {.fx_px = 340, .fy_px = 320, .cx_px = 322, .cy_px = 238};
  scope.mask = {.cx_px = 321, .cy_px = 239, .radius_px = 210};
  scope.notch_rad = 0.4;
  scope.turning = Turning{.centre_px = {317, 243}};
  return scope;
}

enum class Tooth { none, inward, outward };

struct Look {
  Tooth tooth = Tooth::inward;
  double second_rad = -1;                     ///< another tooth, so far round from the first; below 0: none
  double light = 120;                         ///< of the tissue
  double unevenness = 0.3;                    ///< of the light round the circle
  double noise = 3;                           ///< standard deviation, grey levels
  double dark_from_rad = 0, dark_to_rad = 0;  ///< of the circle, since turn 0: unlit
};

/// Grey, drawn with four samples a pixel each way. Written down without NotchSearch.
std::vector<std::byte> drawn(const ScopeModel& scope, double turn, const Look& look) {
  const CircularMask mask = optics_at(scope, turn).mask;
  const double aspect = scope.lens.fy_px / scope.lens.fx_px;
  std::mt19937 random(static_cast<unsigned>(std::lround(1000 * (turn + 10))));
  std::normal_distribution<double> noise(0, look.noise);
  std::vector<std::byte> picture;
  const auto bright = [&](double x, double y) {
    const double dx = x - mask.cx_px, dy = (y - mask.cy_px) / aspect;
    const double radius = std::hypot(dx, dy) / mask.radius_px, angle = std::atan2(dy, dx);
    if (radius > 1.1) return 0.0;
    const double light = look.light * (1 + look.unevenness * std::cos(3 * angle + 1)) *
                         (1 + 0.2 * std::sin(0.15 * x) * std::sin(0.11 * y));
    const double where = std::remainder(angle - turn, 2 * std::numbers::pi);
    if (where > look.dark_from_rad && where < look.dark_to_rad) return 0.0;
    bool lit = radius < 1;
    for (const double off : {0.0, look.second_rad}) {
      if (look.tooth == Tooth::none || off < 0) continue;
      const double away =
          std::abs(std::remainder(angle - *scope.notch_rad - turn - off, 2 * std::numbers::pi));
      if (look.tooth == Tooth::inward && radius > 0.91 && away < 0.05 * (radius - 0.91) / 0.09) lit = false;
      if (look.tooth == Tooth::outward && radius < 1.08 && away < 0.05 * (1.08 - radius) / 0.08) lit = true;
    }
    return lit ? light : 0.0;
  };
  for (int y = 0; y < scope.height_px; ++y)
    for (int x = 0; x < scope.width_px; ++x) {
      const double off = std::hypot(x - mask.cx_px, (y - mask.cy_px) / aspect) / mask.radius_px;
      double sum = 0;
      if (off < 0.88)
        sum = bright(x, y);
      else
        for (int i = 0; i < 16; ++i) {
          const int row = i / 4;
          sum += bright(x - 0.375 + 0.25 * (i % 4), y - 0.375 + 0.25 * row) / 16;
        }
      picture.push_back(static_cast<std::byte>(std::clamp(16 + sum + noise(random), 0.0, 255.0)));
    }
  return picture;
}

std::optional<double> found(const ScopeModel& scope, double turn, const Look& look) {
  auto picture = drawn(scope, turn, look);
  NotchSearch search(scope);
  return search.turn_in(packed_image(picture.data(), PixelFormat::gray8, scope.width_px, scope.height_px));
}

class EachTooth : public ::testing::TestWithParam<Tooth> {};

TEST_P(EachTooth, IsFoundToAFifthOfADegreeAtAnyTurn) {
  const ScopeModel scope = scope_with_notch();
  double squares = 0, worst = 0;
  constexpr int kTurns = 15;
  for (int i = 0; i < kTurns; ++i) {
    const double turn_deg = -179 + 23.7 * i;
    const auto turn = found(scope, turn_deg * kDegree, {.tooth = GetParam()});
    ASSERT_TRUE(turn) << turn_deg;
    const double off = std::remainder(*turn - turn_deg * kDegree, 2 * std::numbers::pi) / kDegree;
    squares += off * off;
    worst = std::max(worst, std::abs(off));
  }
  const double rms = std::sqrt(squares / kTurns);
  RecordProperty("rms_mdeg", static_cast<int>(1000 * rms));
  RecordProperty("worst_mdeg", static_cast<int>(1000 * worst));
  EXPECT_LE(rms, 0.1);
  EXPECT_LE(worst, 0.2);
}
INSTANTIATE_TEST_SUITE_P(NotchSearch, EachTooth, ::testing::Values(Tooth::inward, Tooth::outward));

TEST(NotchSearch, SaysNothingWhereNoneStandsOut) {
  const ScopeModel scope = scope_with_notch();
  EXPECT_TRUE(found(scope, 0.7, {}));
  EXPECT_FALSE(found(scope, 0.7, {.tooth = Tooth::none})) << "there is none";
  EXPECT_FALSE(found(scope, 0.7, {.second_rad = 1.8})) << "two alike";
  EXPECT_FALSE(found(scope, 0.7, {.light = 6})) << "too dark";
  EXPECT_FALSE(found(scope, 0.7, {.dark_from_rad = 0.1, .dark_to_rad = 0.7})) << "its surroundings are unlit";
  EXPECT_TRUE(found(scope, 0.7, {.dark_from_rad = 2.0, .dark_to_rad = 3.0})) << "unlit elsewhere";
}

TEST(NotchSearch, SaysNothingOfAPictureOfAnotherSizeOrWithoutPixels) {
  const ScopeModel scope = scope_with_notch();
  NotchSearch search(scope);
  auto picture = drawn(scope, 0, {});
  EXPECT_FALSE(search.turn_in(packed_image(picture.data(), PixelFormat::gray8, 480, 640)));
  EXPECT_FALSE(search.turn_in(packed_image(nullptr, PixelFormat::gray8, 640, 480)));
  EXPECT_FALSE(search.turn_in({}));
}

TEST(NotchSearch, AsksNothingOfTheHeap) {
  const ScopeModel scope = scope_with_notch();
  NotchSearch search(scope);
  auto picture = drawn(scope, 0.3, {});
  const auto image = packed_image(picture.data(), PixelFormat::gray8, 640, 480);
  std::optional<double> turn;
  EXPECT_TRUE(testing::zero_allocation([&] { turn = search.turn_in(image); }));
  EXPECT_TRUE(turn);
}

}  // namespace
}  // namespace orcart
