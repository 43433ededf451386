// Registration from points: order, outliers, shapes, and the predicted error against simulation.
#include "tools/registration/register_points.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "realtime/registration/rigid_fit.hpp"

namespace orcart {
namespace {

const std::vector<NamedPoint> kFiducials{
    {.name = "1", .mm = {0, 0, 0}},     {.name = "2", .mm = {90, 5, 0}},
    {.name = "3", .mm = {10, 110, 8}},  {.name = "4", .mm = {70, 60, 75}},
    {.name = "5", .mm = {-40, 50, 40}}, {.name = "6", .mm = {20, -30, 60}}};
const Eigen::Matrix3d kTurn =
    Eigen::AngleAxisd(2.2, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
const Eigen::Vector3d kShift(100, -300, 40);

std::vector<NamedPoint> measured(const std::vector<NamedPoint>& points) {
  std::vector<NamedPoint> moved = points;
  for (NamedPoint& p : moved) p.mm = kTurn.transpose() * (p.mm - kShift);
  return moved;
}

TEST(RegisterPoints, FindsAKnownPose) {
  const auto r = register_points({.fixed = kFiducials, .moving = measured(kFiducials)});
  ASSERT_TRUE(r);
  EXPECT_TRUE(r->X_MR.rotation.isApprox(kTurn, 1e-12));
  EXPECT_LT((r->X_MR.translation_mm - kShift).norm(), 1e-9);
  EXPECT_LT(r->fre_mm, 1e-9);
}

TEST(RegisterPoints, AFiducialThatWasNotTouchedIsLeftOutAndTold) {
  auto moving = measured(kFiducials);
  moving.erase(moving.begin() + 1);
  const auto r = register_points({.fixed = kFiducials, .moving = moving});
  ASSERT_TRUE(r) << r.error().message;
  EXPECT_EQ(r->points.size(), 5U);
  EXPECT_LT(r->fre_mm, 1e-9);
  EXPECT_NE(r->notes.at(0).find("\"2\" was not measured"), std::string::npos);
}

TEST(RegisterPoints, RefusesPointsInMetres) {
  auto moving = measured(kFiducials);
  for (NamedPoint& p : moving) p.mm /= 1000;
  const auto r = register_points({.fixed = kFiducials, .moving = moving});
  ASSERT_FALSE(r);
  EXPECT_NE(r.error().message.find("lie 0.001 times as far apart"), std::string::npos);
}

TEST(RegisterPoints, FindsTheOrderAndLeavesStrayPointsAlone) {
  auto moving = measured(kFiducials);
  std::swap(moving[0], moving[4]);
  std::swap(moving[2], moving[5]);
  moving.insert(moving.begin() + 1, NamedPoint{.name = "stray", .mm = {500, 0, 0}});
  for (std::size_t i = 0; i < moving.size(); ++i) moving[i].name = "p" + std::to_string(i);
  const auto r = register_points({.fixed = kFiducials, .moving = moving, .pairing = Pairing::unknown});
  ASSERT_TRUE(r) << r.error().message;
  EXPECT_LT(r->fre_mm, 1e-9);
  EXPECT_EQ(r->points[0].moving, "p5");
}

TEST(RegisterPoints, RefusesAnOrderThatCannotBeTold) {
  const std::vector<NamedPoint> square{{.name = "a", .mm = {50, 50, 0}},
                                       {.name = "b", .mm = {-50, 50, 0}},
                                       {.name = "c", .mm = {-50, -50, 0}},
                                       {.name = "d", .mm = {50, -50, 0}}};
  const auto r = register_points({.fixed = square, .moving = measured(square), .pairing = Pairing::unknown});
  ASSERT_FALSE(r);
  EXPECT_NE(r.error().message.find("fit equally well"), std::string::npos);
}

TEST(RegisterPoints, NamesOneOutlierAndLeavesItOut) {
  auto moving = measured(kFiducials);
  moving[3].mm += Eigen::Vector3d(0, 12, 0);
  const auto r = register_points({.fixed = kFiducials, .moving = moving});
  ASSERT_TRUE(r);
  EXPECT_EQ(r->outlier, "4");
  EXPECT_NEAR(r->outlier_mm, 12, 1e-6);
  EXPECT_LT(r->fre_mm, 1e-9);
}

TEST(RegisterPoints, RefusesExchangedNames) {
  auto moving = measured(kFiducials);
  std::swap(moving[0].name, moving[3].name);
  const auto r = register_points({.fixed = kFiducials, .moving = moving});
  ASSERT_FALSE(r);
  EXPECT_NE(r.error().message.find("over ten times the declared error of 0.50 mm"), std::string::npos);
}

TEST(RegisterPoints, TellsALargeErrorThatNoOnePointExplains) {
  auto moving = measured(kFiducials);
  moving[1].mm += Eigen::Vector3d(0, 4, 0);
  moving[3].mm += Eigen::Vector3d(0, 0, 4);
  const auto r = register_points({.fixed = kFiducials, .moving = moving});
  ASSERT_TRUE(r) << r.error().message;
  EXPECT_TRUE(r->outlier.empty());
  ASSERT_EQ(r->notes.size(), 1U);
  EXPECT_NE(r->notes[0].find("no one point explains it"), std::string::npos);
}

TEST(RegisterPoints, OneMisspeltNameIsRefusedAndNamed) {
  auto moving = measured(kFiducials);
  std::rotate(moving.begin(), moving.begin() + 2, moving.end());
  moving[1].name = "nasoin";
  const auto r = register_points({.fixed = kFiducials, .moving = moving});
  ASSERT_FALSE(r);
  EXPECT_NE(r.error().message.find("fiducials \"4\", measured \"nasoin\""), std::string::npos);
}

TEST(RegisterPoints, NamesOfWhichNoneIsAlikeLeaveTheOrderAndAreTold) {
  auto moving = measured(kFiducials);
  for (NamedPoint& p : moving) p.name = "touch " + p.name;
  const auto r = register_points({.fixed = kFiducials, .moving = moving});
  ASSERT_TRUE(r) << r.error().message;
  EXPECT_LT(r->fre_mm, 1e-9);
  EXPECT_NE(r->notes.at(0).find("in the order given"), std::string::npos);
}

TEST(RegisterPoints, NumbersOfUnnamedPointsAreNoNames) {
  auto fixed = kFiducials, moving = measured(kFiducials);
  for (auto* points : {&fixed, &moving})
    for (NamedPoint& p : *points) p.numbered = true;
  EXPECT_LT(register_points({.fixed = fixed, .moving = moving}).value().fre_mm, 1e-9);
  moving.pop_back();
  const auto r = register_points({.fixed = fixed, .moving = moving});
  ASSERT_FALSE(r);
  EXPECT_NE(r.error().message.find("6 fiducials and 5 measured points"), std::string::npos);
}

TEST(RegisterPoints, SaysThatFourPointsCannotNameAnOutlier) {
  std::vector<NamedPoint> four(kFiducials.begin(), kFiducials.begin() + 4);
  auto moving = measured(four);
  moving[1].mm += Eigen::Vector3d(0, 0, 10);
  const auto r = register_points({.fixed = four, .moving = moving});
  ASSERT_TRUE(r);
  EXPECT_TRUE(r->outlier.empty());
  ASSERT_FALSE(r->notes.empty());
  EXPECT_NE(r->notes[0].find("cannot be told"), std::string::npos);
}

TEST(RegisterPoints, TellsFlatAndNarrowSets) {
  const std::vector<NamedPoint> flat{{.name = "a", .mm = {0, 0, 0}},
                                     {.name = "b", .mm = {80, 0, 0}},
                                     {.name = "c", .mm = {0, 70, 0}},
                                     {.name = "d", .mm = {60, 60, 1}}};
  EXPECT_NE(register_points({.fixed = flat, .moving = measured(flat)})->notes.at(0).find("one plane"),
            std::string::npos);
  const std::vector<NamedPoint> narrow{
      {.name = "a", .mm = {0, 0, 0}}, {.name = "b", .mm = {50, 3, 0}}, {.name = "c", .mm = {100, 0, 2}}};
  EXPECT_NE(register_points({.fixed = narrow, .moving = measured(narrow)})->notes.at(0).find("one line"),
            std::string::npos);
  const std::vector<NamedPoint> line{
      {.name = "a", .mm = {0, 0, 0}}, {.name = "b", .mm = {50, 0, 0}}, {.name = "c", .mm = {100, 0, 0}}};
  EXPECT_FALSE(register_points({.fixed = line, .moving = measured(line)}));
}

TEST(RegisterPoints, PredictsTheErrorThatSimulationShows) {
  // 4000 registrations with isotropic noise of 0.5 mm RMS on the measured side; the targets' errors against
  // the formula.
  constexpr double kFle_mm = 0.5;
  constexpr int kTrials = 4000;
  const auto exact = measured(kFiducials);
  const auto r = register_points({.fixed = kFiducials, .moving = exact, .fle_mm = kFle_mm});
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, kFle_mm / std::sqrt(3.0));
  std::vector<Eigen::Vector3d> fixed;
  for (const NamedPoint& p : kFiducials) fixed.push_back(p.mm);
  for (const Eigen::Vector3d& target : {Eigen::Vector3d(25, 33, 30), Eigen::Vector3d(25, 33, 180)}) {
    double sum2 = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      std::vector<Eigen::Vector3d> noisy;
      for (const NamedPoint& p : exact)
        noisy.push_back(p.mm + Eigen::Vector3d(noise(random), noise(random), noise(random)));
      const auto fit = rigid_fit({.from_mm = noisy, .to_mm = fixed});
      sum2 += (fit->rotation * (kTurn.transpose() * (target - kShift)) + fit->translation_mm - target)
                  .squaredNorm();
    }
    EXPECT_NEAR(std::sqrt(sum2 / kTrials), predicted_tre_mm(*r, target), 0.04 * predicted_tre_mm(*r, target));
  }
}

}  // namespace
}  // namespace orcart
