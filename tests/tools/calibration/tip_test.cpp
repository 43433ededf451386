// The window's place comes out of known distances; what cannot tell it is refused in words.
#include "tools/calibration/tip.hpp"

#include <gtest/gtest.h>

#include "tests/tools/calibration/simulated_board.hpp"

namespace orcart {
namespace {

std::vector<TipView> views(double window_mm, double scale, const std::vector<double>& errors_mm) {
  std::vector<TipView> made;
  for (std::size_t i = 0; i < errors_mm.size(); ++i) {
    const double known = 10 + 5 * static_cast<double>(i);
    made.push_back({.name = "view" + std::to_string(i),
                    .known_mm = known,
                    .camera_mm = scale * known + window_mm + errors_mm[i]});
  }
  return made;
}

std::string refusal(const std::vector<TipView>& made) {
  const auto fit = fit_tip(made);
  return fit ? "" : fit.error().message;
}

TEST(Tip, WindowAndErrorsFollowFromTheDistances) {
  const auto fit = fit_tip(views(1.5, 1, {0.2, -0.2, 0, 0.2, -0.2}));
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_NEAR(fit->window_mm, 1.5, 1e-12);
  EXPECT_NEAR(fit->errors_mm[0], 0.25, 1e-12);  // 0.2 against the mean of the four others, -0.05
  EXPECT_NEAR(fit->mean_mm, 0.2, 1e-12);
  EXPECT_NEAR(fit->worst_mm, 0.25, 1e-12);
  EXPECT_NEAR(fit->deviation_mm, std::sqrt(0.16 / 4 / 5), 1e-12);
  EXPECT_TRUE(fit->notes.empty());
}

TEST(Tip, RefusesWhatCannotTellIt) {
  EXPECT_NE(refusal(views(1, 1, {0, 0})).find("too few views"), std::string::npos);
  EXPECT_NE(refusal(views(1, 1.5, {0, 0, 0, 0, 0})).find("1.500 times as fast"), std::string::npos);
  auto alike = views(1, 1, {0, 0, 0});
  for (TipView& view : alike) view.known_mm = 20;
  EXPECT_NE(refusal(alike).find("alike"), std::string::npos);
  auto metres = views(1, 1, {0, 0, 0});
  for (TipView& view : metres) view.known_mm *= 1e-3;
  EXPECT_NE(refusal(metres).find("metres"), std::string::npos);
  auto behind = views(1, 1, {0, 0, 0});
  behind[1].known_mm = -5;
  EXPECT_NE(refusal(behind).find("view1"), std::string::npos);
}

TEST(Tip, TheAxisMeetsATiltedBoardWhereItIs) {
  const Pose<C, B> X_CB =
      testing::board_before(30, {0.4, -0.3, 0.2});  // its middle lies on the axis at 30 mm
  const auto distance = axis_distance_mm(X_CB);
  ASSERT_TRUE(distance);
  EXPECT_NEAR(*distance, 30, 1e-9);
  EXPECT_FALSE(axis_distance_mm(testing::board_before(30, {1.5, 0, 0})));
}

}  // namespace
}  // namespace orcart
