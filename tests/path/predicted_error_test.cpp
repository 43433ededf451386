// What the cart itself writes of each texel's predicted error: propagated through the pose that painted it.
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "firmware-host/stages/view_errors.hpp"
#include "tests/path/cart_rig.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart::testing {
namespace {

TEST(PredictedError, OfEachTexelIsPropagatedThroughTheCaptureThatPaintedIt) {
  RigWish three = presses();  // the places of the other tests, so no other movie
  three.script.undo_at = three.script.hide_at = -1;
  three.more_presses.clear();
  const auto rig = CartRig::create(three);
  ASSERT_TRUE(rig);
  rig->patient.registration.covariance = TwistCovariance::Zero();
  rig->patient.registration.covariance->diagonal() << 0.04, 0.04, 0.04, 4e-6, 4e-6, 4e-6;
  ASSERT_TRUE(rig->arm());
  rig->run_to_end();
  // Registration, hand-eye and time alone: the rig's markers are exact.
  const ViewErrors errors(rig->patient.scope, rig->patient.registration.X_MR,
                          {.marker_rms_mm = 0,
                           .registration = rig->patient.registration.covariance,
                           .texel_mm = rig->patient.layout.texel_mm});
  const AtlasRecords records = rig->cart->painter().read_records();
  const auto& captures = rig->cart->captures();
  std::set<std::uint16_t> seen;
  std::size_t texels = 0;
  for (std::size_t i = 0; i < records.texels.size(); ++i) {
    const TexelRecord& record = records.texels[i];
    if (record.capture == 0 || rig->patient.layout.inside[i] == 0) continue;
    const CaptureRecord* painted = nullptr;
    for (std::size_t c = 0; c < captures.size(); ++c)
      if (captures.at(c).refusal == Refusal::none && !captures.at(c).undone &&
          capture_number(captures.at(c).unit) == record.capture)
        painted = &captures.at(c);
    ASSERT_NE(painted, nullptr);
    const ViewError error = errors.at(painted->X_MC);
    const double distance_mm = (scenes::point_of(rig->patient.surface, rig->patient.layout, i) -
                                painted->X_MC.translation_mm)
                                   .norm(),
                 cosine = std::cos(record.angle_cdeg * std::numbers::pi / 18'000);
    const double across_mm =
        std::hypot(static_cast<double>(error.position_mm), static_cast<double>(error.angle_rad) * distance_mm,
                   static_cast<double>(error.pixels) * distance_mm / rig->patient.scope.lens.fx_px);
    const double expected_um = 1000 * across_mm * std::sqrt((1 + 1 / (cosine * cosine)) / 2);
    EXPECT_NEAR(record.error_um, expected_um, 2 + 0.01 * expected_um) << i;
    seen.insert(record.capture);
    ++texels;
  }
  EXPECT_GT(texels, 1000U);
  EXPECT_GE(seen.size(), 2U);
}

}  // namespace
}  // namespace orcart::testing
