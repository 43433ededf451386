// Pages of hand-eye, tip and medium hold a mark for every view and the answer itself.
#include <gtest/gtest.h>

#include "tests/tools/calibration/simulated_board.hpp"
#include "tools/calibration/camera_report.hpp"
#include "tools/calibration/hand_eye_command.hpp"
#include "tools/calibration/mask_finder.hpp"
#include "tools/calibration/medium.hpp"
#include "tools/calibration/tip.hpp"

namespace orcart {
namespace {

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

TEST(PassportPages, OfATipShowEveryDistance) {
  TipCalibration tip;
  for (const double known : {10.0, 20.0, 30.0})
    tip.views.push_back({.name = "view", .known_mm = known, .camera_mm = known + 1.5 + 0.01 * known});
  tip.fit = fit_tip(tip.views).value();
  const std::string page = tip_page(tip, "the answer");
  EXPECT_EQ(count(page, "<circle"), 3U);
  EXPECT_NE(page.find(">20 mm<"), std::string::npos);
  EXPECT_NE(page.find("the answer"), std::string::npos);
}

TEST(PassportPages, OfAMediumShowBothLensesAndEveryDepth) {
  ScopeModel air{.name = "scope", .width_px = 640, .height_px = 480};
  air.lens = testing::test_lens(LensModel::fisheye);
  air.mask = {.cx_px = 320, .cy_px = 240, .radius_px = 220};
  air.cone_half_angle_rad = cone_half_angle_rad(air.lens, air.mask, {640, 480});
  air.X_CE.translation_mm.z() = 1.5;
  const auto fluid = to_fluid(air, Medium::saline, {});
  ASSERT_TRUE(fluid) << fluid.error().message;
  const std::string page = medium_page(air, *fluid, "the answer");
  EXPECT_EQ(count(page, "<polyline"), 6U);
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

TEST(PassportPages, OfACameraEscapeNamesAndItsJsonHasTheNotes) {
  CameraCalibration camera;
  camera.scope.name = "30° <b> & co";
  camera.scope.width_px = 640, camera.scope.height_px = 480;
  camera.scope.lens = testing::test_lens(LensModel::brown);
  camera.scope.mask = {.cx_px = 320, .cy_px = 240, .radius_px = 220};
  camera.notes.emplace_back("folds with five");
  const auto page = camera_page(camera);
  ASSERT_TRUE(page);
  EXPECT_NE(page->find("30° &lt;b> &amp; co"), std::string::npos);
  EXPECT_EQ(page->find("<b>"), std::string::npos);
  EXPECT_NE(camera_json(camera).find("\"notes\": [\"folds with five\"]"), std::string::npos)
      << camera_json(camera);
}

TEST(PassportPages, OfAHandEyeShowEveryViewEvenWhereItsPictureIsGone) {
  HandEyeCalibration hand_eye;
  hand_eye.refined.lens = testing::test_lens(LensModel::brown);
  for (const char* name : {"one.png", "two<2>.png", "three.png"}) {
    hand_eye.names.emplace_back(name);
    hand_eye.refined.scatters_mm.push_back(0.5);
    hand_eye.left_out_mm.push_back(0.7);
    hand_eye.views.push_back({.X_TS = {}, .X_CB = testing::board_before(40, {0, 0, 0}), .board = {}});
  }
  const std::string page = hand_eye_page(hand_eye, "the answer");
  EXPECT_EQ(count(page, "<figure>"), 3U);
  EXPECT_NE(page.find("two&lt;2>.png"), std::string::npos);
}

}  // namespace
}  // namespace orcart
