// How well a light post's turn is known depends on what tells it.
#include "firmware-host/app/turn_deviation.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "firmware-host/stages/view_errors.hpp"
#include "tests/firmware-host/app/demo_cart.hpp"

namespace orcart::testing {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

class TurnDeviation : public ::testing::Test {
 protected:
  double rad() const { return turn_deviation_rad(config, turning, tracker); }

  CartConfig config = read_cart(demo_cart().parent_path() / "demo-angled.toml").value();
  NdiSettings tracker = settings_of(config.tracker).value();
  Turning turning{.R_SL = Eigen::Matrix3d::Identity()};
};

TEST_F(TurnDeviation, ByAMarkerIsThatOfBothBodiesWhateverThePassportSaysOfTheNotch) {
  const double both_rad =
      marked_turn_deviation_rad(turning, ndi::markers_of(tracker.tools[0].definition),
                                ndi::markers_of(tracker.tools[2].definition), config.marker_rms_mm());
  EXPECT_EQ(rad(), both_rad);
  turning.notch_deviation_rad = 0.5;
  EXPECT_EQ(rad(), both_rad);
}

TEST_F(TurnDeviation, ByTheNotchOrToldByItIsThePassportsAndElseAssumed) {
  for (const TurnSource source : {TurnSource::notch, TurnSource::told}) {
    config.turn = source;
    turning.notch_deviation_rad.reset();
    EXPECT_EQ(rad(), kAssumedErrors.light_post_rad);
    turning.notch_deviation_rad = 0.012;
    EXPECT_EQ(rad(), 0.012);
  }
}

TEST_F(TurnDeviation, ByAnEncoderAddsACountsWidth) {
  config.turn = TurnSource::encoder;
  config.encoder.counts_per_turn = 90;
  turning.notch_deviation_rad = 1 * kDegree;
  // 4 degrees a count, evenly: 4 / sqrt(12).
  EXPECT_NEAR(rad(), std::sqrt(1 + 16.0 / 12) * kDegree, 1e-12);
  config.encoder.rise = CountsRise::anticlockwise;
  EXPECT_NEAR(rad(), std::sqrt(1 + 16.0 / 12) * kDegree, 1e-12);
}

TEST_F(TurnDeviation, ThatIsToldStandsForAnySource) {
  config.turn_deviation_rad = 0.02;
  turning.notch_deviation_rad = 0.012;
  for (const TurnSource source :
       {TurnSource::marker, TurnSource::notch, TurnSource::told, TurnSource::encoder}) {
    config.turn = source;
    EXPECT_EQ(rad(), 0.02);
  }
}

}  // namespace
}  // namespace orcart::testing
