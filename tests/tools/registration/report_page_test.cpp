// Charts hold what is drawn, whatever it is; pages carry the answer and need no other file.
#include "tools/registration/report_page.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tools/registration/pivot.hpp"
#include "tools/registration/register_points.hpp"

namespace orcart {
namespace {

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

bool whole(const std::string& svg) {
  return count(svg, "<svg") == count(svg, "</svg>") && svg.find("nan") == std::string::npos &&
         svg.find("inf") == std::string::npos;
}

TEST(ReportPage, DrawsEveryPointThatIsOne) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = svg_chart({.title = "a < b & c",
                                     .x_label = "x",
                                     .y_label = "y",
                                     .series = {{.name = "dots",
                                                 .colour = "#c22",
                                                 .form = SeriesForm::dots,
                                                 .points = {{1, 2}, {nan, 3}, {2, 5}, {3, nan}}}}});
  EXPECT_EQ(count(svg, "<circle"), 2U);
  EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
  EXPECT_TRUE(whole(svg));
}

TEST(ReportPage, StandsWhereThereIsNothingOrOneValueOnly) {
  EXPECT_TRUE(whole(svg_chart({})));
  for (const SeriesForm form : {SeriesForm::dots, SeriesForm::line, SeriesForm::bars})
    EXPECT_TRUE(whole(svg_chart(
        {.series = {{.name = "", .colour = "#c22", .form = form, .points = {{0, 0}, {1, 0}, {2, 0}}}}})));
}

TEST(ReportPage, BarsStandOnZero) {
  const std::string svg = svg_chart(
      {.series = {{.name = "", .colour = "#123", .form = SeriesForm::bars, .points = {{0, 4}, {1, -2}}}}});
  EXPECT_EQ(count(svg, "fill='#123'"), 2U);
}

TEST(ReportPage, PicturesAreInThePage) {
  const auto bytes = [](std::string_view text) { return std::as_bytes(std::span(text)); };
  EXPECT_EQ(picture_data_url("png", bytes("Man")), "data:image/png;base64,TWFu");  // RFC 4648
  EXPECT_EQ(picture_data_url("png", bytes("Ma")), "data:image/png;base64,TWE=");
  EXPECT_EQ(picture_data_url("png", bytes("M")), "data:image/png;base64,TQ==");
}

TEST(ReportPage, OfAPivotTellsPosesLeftOutFromThoseThatAgree) {
  std::vector<NamedPose> poses;
  const Eigen::Vector3d tip(0, 0, 150);
  for (int i = 0; i < 24; ++i) {
    NamedPose pose{.name = std::to_string(i)};
    pose.X_TS.rotation =
        Eigen::AngleAxisd(0.5, Eigen::Vector3d(std::cos(0.26 * i), std::sin(0.26 * i), 0)).toRotationMatrix();
    pose.X_TS.translation_mm = Eigen::Vector3d(10, 20, -900) - pose.X_TS.rotation * tip +
                               0.1 * Eigen::Vector3d(std::sin(5.0 * i), std::cos(3.0 * i), std::sin(2.0 * i));
    if (i == 7) pose.X_TS.translation_mm.x() += 20;
    poses.push_back(pose);
  }
  const auto fit = fit_pivot(poses);
  ASSERT_TRUE(fit) << fit.error().message;
  const std::string page = pivot_page(poses, *fit, "the <answer>");
  EXPECT_EQ(count(page, "fill='#c22'"), 2U);  // the pose left out, and the legend
  EXPECT_NE(page.find("the &lt;answer>"), std::string::npos);
  EXPECT_TRUE(whole(page));
}

TEST(ReportPage, OfARegistrationNamesEveryFiducial) {
  RegistrationTask task;
  const Eigen::Vector3d places[] = {{0, 0, 0}, {80, 0, 10}, {0, 90, 0}, {20, 30, 70}};
  for (int i = 0; i < 4; ++i) {
    task.fixed.push_back({.name = "F" + std::to_string(i), .mm = places[i]});
    task.moving.push_back(
        {.name = "F" + std::to_string(i), .mm = places[i] + Eigen::Vector3d(5, 0.3 * (i % 2), -2)});
  }
  const auto registration = register_points(task);
  ASSERT_TRUE(registration) << registration.error().message;
  const std::string page = register_page(*registration, "answer", "<p>more</p>");
  for (const char* name : {">F0<", ">F1<", ">F2<", ">F3<", "<p>more</p>"})
    EXPECT_NE(page.find(name), std::string::npos) << name;
  EXPECT_TRUE(whole(page));
}

}  // namespace
}  // namespace orcart
