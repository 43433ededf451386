// Angled scopes in simulation: centre and axis come back, and a point is then seen where it is, at any turn.
#include "tools/calibration/turning.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "realtime/optics/scope_turn.hpp"
#include "tests/tools/calibration/simulated_board.hpp"

namespace orcart {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kPi = std::numbers::pi;

/// The scope as it really is: a shaft with optics that look `view_deg` off it, in a head that turns about the
/// shaft; a sensor on which everything goes round a centre. Written down without optics_at().
struct RealScope {
  ScopeModel passport;  ///< as calibrated at turn 0, without [turning]
  Eigen::Vector2d centre_px{317, 244};
  Eigen::Vector3d axis, foot_mm;
  TurnMarker marker = TurnMarker::shaft;

  Eigen::Vector2d seen(const Eigen::Vector3d& p_C_at_zero, double turn) const {
    const Eigen::Vector2d at_zero = project(passport.lens, p_C_at_zero).value();
    const double aspect = passport.lens.fy_px / passport.lens.fx_px;
    const double dx = at_zero.x() - centre_px.x(), dy = (at_zero.y() - centre_px.y()) / aspect;
    return {centre_px.x() + std::cos(turn) * dx - std::sin(turn) * dy,
            centre_px.y() + aspect * (std::sin(turn) * dx + std::cos(turn) * dy)};
  }
  /// The marker for a scope that stands with C at X_TC.
  Pose<T, S> marker_at(const Pose<T, C>& X_TC, double turn) const {
    const Pose<T, S> X_TS = X_TC * passport.X_SC.inverse();
    if (marker == TurnMarker::shaft) return X_TS;
    const Eigen::Matrix3d swing = Eigen::AngleAxisd(turn, axis).toRotationMatrix();
    const Pose<S, S> swung{.rotation = swing, .translation_mm = foot_mm - swing * foot_mm};
    return X_TS * swung.inverse();
  }
};

RealScope real_scope(double view_deg, TurnMarker marker) {
  RealScope real{.marker = marker};
  real.axis = Eigen::Vector3d(0.02, -0.03, 1).normalized();
  real.foot_mm = {5, -46, 0};
  real.passport = {.name = "angled", .width_px = 640, .height_px = 480};
  real.passport.lens = testing::test_lens(LensModel::brown);
  real.passport.mask = {.cx_px = 320, .cy_px = 246, .radius_px = 222};
  const Eigen::Quaterniond along = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), real.axis);
  real.passport.X_SC.rotation =
      along.toRotationMatrix() *
      Eigen::AngleAxisd(view_deg * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
  real.passport.X_SC.translation_mm = real.foot_mm + 260 * real.axis + Eigen::Vector3d(0.3, 0.4, 0);
  return real;
}

Pose<T, C> clamped() {
  Pose<T, C> X_TC;
  X_TC.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  X_TC.translation_mm = {80, -40, -1400};
  return X_TC;
}

struct Noise {
  double pixel_px = 0, marker_mm = 0, marker_rad = 0;
};

std::vector<TurnSight> sights_of(const RealScope& real, const std::vector<double>& turns_deg,
                                 const Noise& noise,
                                 const Eigen::Vector3d& scope_slips_mm = Eigen::Vector3d::Zero()) {
  std::mt19937 random(5);
  std::normal_distribution<double> any(0, 1);
  std::vector<TurnSight> sights;
  for (const double turn_deg : turns_deg) {
    const double turn = turn_deg * kDegree;
    TurnSight sight{.name = "turn" + std::to_string(static_cast<int>(turn_deg))};
    const Pose<C, B> X_CB = testing::board_before(45, {0.2, -0.3, 0.1});
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 14; ++i) {
        const Eigen::Vector3d p =
            (X_CB * Point<B>{{2.0 * i, 2.0 * j, 0}}).mm + scope_slips_mm * static_cast<double>(sights.size());
        sight.corners.push_back(
            {.lattice = {i, j},
             .pixel_px = real.seen(p, turn) + noise.pixel_px * Eigen::Vector2d(any(random), any(random))});
      }
    if (real.marker == TurnMarker::head) {
      Pose<T, S> X_TS = real.marker_at(clamped(), turn);
      const Eigen::Vector3d off(any(random), any(random), any(random));
      X_TS.translation_mm += noise.marker_mm * off;
      const Eigen::Vector3d tilt = noise.marker_rad * Eigen::Vector3d(any(random), any(random), any(random));
      if (tilt.norm() > 0)
        X_TS.rotation *= Eigen::AngleAxisd(tilt.norm(), tilt.normalized()).toRotationMatrix();
      sight.X_TS = X_TS;
    }
    sights.push_back(std::move(sight));
  }
  return sights;
}

TurningTask task_for(const RealScope& real, double view_deg) {
  return {.aspect = real.passport.lens.fy_px / real.passport.lens.fx_px,
          .view_angle_rad = view_deg * kDegree,
          .marker = real.marker,
          .view_S = real.passport.X_SC.rotation.col(2)};
}

/// Distance, px, of where the calibrated passport sees points near the circle's edge from where they are
/// seen. `told_rad` is what the angle's input says of the true turn. RMS round the circle.
double edge_error_px(const RealScope& real, const ScopeModel& calibrated, double turn, double told_rad,
                     double* worst = nullptr) {
  const TurnedOptics at = optics_at(calibrated, told_rad);
  double squares = 0;
  constexpr int kRound = 24;
  for (int i = 0; i < kRound; ++i) {
    const double angle = 2 * kPi * i / kRound;
    const Eigen::Vector2d edge(320 + 215 * std::cos(angle), 246 + 0.915 * 215 * std::sin(angle));
    const Eigen::Vector3d p = 25 * direction_of(real.passport.lens, edge).value();  // of C at turn 0
    const Point<T> there = clamped() * Point<C>{p};
    const Pose<T, C> believed = real.marker_at(clamped(), turn) * at.X_SC;
    const auto pixel = project(at.lens, (believed.inverse() * there).mm);
    if (!pixel) return 1e9;
    const double off = (*pixel - real.seen(p, turn)).norm();
    squares += off * off / kRound;
    if (worst != nullptr) *worst = std::max(*worst, off);
  }
  return std::sqrt(squares);
}

class EveryAngle : public ::testing::TestWithParam<std::tuple<double, TurnMarker>> {};

TEST_P(EveryAngle, IsSeenThroughToAFifthOfAPixelWithoutNoise) {
  const auto [view_deg, marker] = GetParam();
  const RealScope real = real_scope(view_deg, marker);
  const auto fit = fit_turning(sights_of(real, {0, 50, 110, 170, -125, -60}, {}), task_for(real, view_deg));
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_LT((fit->turning.centre_px - real.centre_px).norm(), 1e-3);
  EXPECT_NEAR(fit->turns_rad[3], 170 * kDegree, 1e-6);
  EXPECT_NEAR(fit->turns_rad[4], -125 * kDegree, 1e-6);
  ScopeModel calibrated = real.passport;
  calibrated.turning = fit->turning;
  double worst = 0;
  for (int turn_deg = -180; turn_deg < 180; turn_deg += 15)
    edge_error_px(real, calibrated, turn_deg * kDegree, turn_deg * kDegree, &worst);
  EXPECT_LE(worst, 0.2);
  RecordProperty("worst_npx", static_cast<int>(1e9 * worst));
}

TEST_P(EveryAngle, IsSeenThroughToTwoPixelsAtTheEdgeWithAFifthOfADegreeOfAngleNoise) {
  const auto [view_deg, marker] = GetParam();
  const RealScope real = real_scope(view_deg, marker);
  std::vector<double> all_round;
  for (int turn_deg = 0; turn_deg < 360; turn_deg += 30) all_round.push_back(turn_deg);
  const auto fit =
      fit_turning(sights_of(real, all_round, {.pixel_px = 0.15, .marker_mm = 0.05, .marker_rad = 0.0005}),
                  task_for(real, view_deg));
  ASSERT_TRUE(fit) << fit.error().message;
  ScopeModel calibrated = real.passport;
  calibrated.turning = fit->turning;
  std::mt19937 random(7);
  std::normal_distribution<double> angle_noise(0, 0.2 * kDegree);
  std::uniform_real_distribution<double> any(-kPi, kPi);
  double squares = 0;
  constexpr int kDraws = 400;
  for (int i = 0; i < kDraws; ++i) {
    const double turn = any(random);
    squares += std::pow(edge_error_px(real, calibrated, turn, turn + angle_noise(random)), 2) / kDraws;
  }
  RecordProperty("edge_rms_mpx", static_cast<int>(1000 * std::sqrt(squares)));
  EXPECT_LE(std::sqrt(squares), 2);
}

INSTANTIATE_TEST_SUITE_P(Turning, EveryAngle,
                         ::testing::Combine(::testing::Values(0.0, 30.0, 45.0, 70.0, 110.0),
                                            ::testing::Values(TurnMarker::shaft, TurnMarker::head)));

TEST(Turning, IsRefusedWhereItCannotBeTold) {
  const RealScope real = real_scope(30, TurnMarker::shaft), head = real_scope(30, TurnMarker::head);
  const auto why = [](const Result<TurningFit>& fit) { return fit ? "accepted" : fit.error().message; };
  EXPECT_NE(why(fit_turning(sights_of(real, {0, 90}, {}), task_for(real, 30))).find("too few pictures"),
            std::string::npos);
  EXPECT_NE(why(fit_turning(sights_of(real, {0, 10, 25}, {}), task_for(real, 30))).find("25 degrees only"),
            std::string::npos);
  EXPECT_NE(why(fit_turning(sights_of(real, {0, 60, 120, 200}, {}, {0.5, 0, 0}), task_for(real, 30)))
                .find("do not go round one centre"),
            std::string::npos);
  auto shuffled = sights_of(head, {0, 60, 120, 200}, {});
  std::swap(shuffled[1].X_TS, shuffled[2].X_TS);
  EXPECT_NE(why(fit_turning(shuffled, task_for(head, 30))).find("the marker turns otherwise"),
            std::string::npos);
}

TEST(Turning, IsToldByTheNotchToATenthOfADegree) {
  RealScope real = real_scope(30, TurnMarker::shaft);
  real.passport.turning = Turning{.centre_px = real.centre_px};
  const auto drawn = [&](double turn) {
    cv::Mat picture(480, 640, CV_8UC3, cv::Scalar::all(5));
    const auto spot = [&](const Eigen::Vector2d& p) { return cv::Point2d(p.x(), p.y()); };
    ScopeModel model = real.passport;
    model.lens.fy_px = model.lens.fx_px;  // square pixels
    const TurnedOptics at = optics_at(model, turn);
    const Eigen::Vector2d middle(at.mask.cx_px, at.mask.cy_px);
    cv::circle(picture, spot(middle), 200, cv::Scalar::all(150), cv::FILLED, cv::LINE_AA);
    const double notch = 0.6 + turn;
    constexpr std::array<std::pair<double, double>, 3> kTooth{{{185.0, -0.05}, {218.0, 0.0}, {185.0, 0.05}}};
    std::vector<cv::Point> tooth;
    tooth.reserve(kTooth.size());
    for (const auto& [r, side] : kTooth)
      tooth.push_back(spot(middle + r * Eigen::Vector2d(std::cos(notch + side), std::sin(notch + side))));
    cv::fillConvexPoly(picture, tooth, cv::Scalar::all(150), cv::LINE_AA);
    return picture;
  };
  ScopeModel passport = real.passport;
  passport.lens.fy_px = passport.lens.fx_px;
  cv::Mat grey;
  cv::cvtColor(drawn(0), grey, cv::COLOR_BGR2GRAY);
  passport.notch_rad = find_mask(grey, 1).notch_rad;
  ASSERT_TRUE(passport.notch_rad);
  double squares = 0;
  for (int turn_deg = -170; turn_deg <= 170; turn_deg += 20) {
    const auto turn = turn_by_notch(drawn(turn_deg * kDegree), passport);
    ASSERT_TRUE(turn) << turn_deg << ": " << turn.error().message;
    const double off = std::remainder(*turn - turn_deg * kDegree, 2 * kPi) / kDegree;
    EXPECT_NEAR(off, 0, 0.3) << turn_deg;
    squares += off * off / 18;
  }
  EXPECT_LE(std::sqrt(squares), 0.15);
  RecordProperty("notch_rms_mdeg", static_cast<int>(1000 * std::sqrt(squares)));
  EXPECT_FALSE(turn_by_notch(cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(120)), passport));
}

TEST(Turning, ByTheNotchIsKnownByThePicturesScatterAsFarAsTheyAreMany) {
  const RealScope real = real_scope(30, TurnMarker::shaft);
  const std::vector<double> turns{0, 90, 180, -90};
  auto sights = sights_of(real, turns, {});
  constexpr std::array<double, 4> kOff_rad{0.002, -0.002, 0.002, -0.002};
  for (std::size_t k = 0; k < turns.size(); ++k)
    sights[k].notch_rad = std::remainder(0.6 + turns[k] * kDegree + kOff_rad[k], 2 * kPi);
  const auto fit = fit_turning(sights, task_for(real, 30));
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_NEAR(fit->notch_rms_rad, 0.002, 1e-6);
  // Of four about their mean: 0.002 sqrt(4/3); Student's 95 % with three degrees of freedom is 3.182.
  EXPECT_NEAR(fit->turning.notch_deviation_rad.value(), 0.002 * std::sqrt(4.0 / 3) * 3.182 / 1.96, 1e-6);

  for (TurnSight& sight : sights) sight.notch_rad.reset();
  const auto without = fit_turning(sights, task_for(real, 30));
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_FALSE(without->turning.notch_deviation_rad);
  sights.pop_back();
  sights[0].notch_rad = 0.6, sights[1].notch_rad = 0.6 + kPi / 2;
  const auto two = fit_turning(sights, task_for(real, 30));
  ASSERT_TRUE(two) << two.error().message;
  EXPECT_FALSE(two->turning.notch_deviation_rad) << "two notches hardly scatter";
}

/// The same sights with a second marker on the other side of the coupler: R_SL says where it is at turn 0.
std::vector<TurnSight> with_second(std::vector<TurnSight> sights, const RealScope& real,
                                   const std::vector<double>& turns_deg, const Eigen::Matrix3d& R_SL) {
  for (std::size_t k = 0; k < sights.size(); ++k) {
    if (!sights[k].X_TS) sights[k].X_TS = real.marker_at(clamped(), turns_deg[k] * kDegree);
    const double about_axis = (real.marker == TurnMarker::head ? 1 : -1) * turns_deg[k] * kDegree;
    Pose<T, L> X_TL;
    X_TL.rotation =
        sights[k].X_TS->rotation * Eigen::AngleAxisd(about_axis, real.axis).toRotationMatrix() * R_SL;
    sights[k].X_TL = X_TL;
  }
  return sights;
}

class EveryMarker : public ::testing::TestWithParam<std::tuple<TurnMarker, double>> {};

TEST_P(EveryMarker, WithASecondOneTellsTheTurnThatThePicturesTell) {
  const auto [marker, view_deg] = GetParam();
  const RealScope real = real_scope(view_deg, marker);
  const std::vector<double> turns{0, 50, 110, 170, -125, -60};
  const Eigen::Matrix3d R_SL =
      Eigen::AngleAxisd(2.2, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const auto sights = with_second(sights_of(real, turns, {}), real, turns, R_SL);
  const auto fit = fit_turning(sights, task_for(real, view_deg));
  ASSERT_TRUE(fit) << fit.error().message;
  ASSERT_TRUE(fit->turning.R_SL);
  EXPECT_TRUE(fit->turning.R_SL->isApprox(R_SL, 1e-6));
  EXPECT_LT((fit->turning.axis - real.axis).norm(), 1e-6);
  EXPECT_LT(fit->second_rms_rad, 1e-6);
  for (const double turn_deg : {-140.0, 25.0, 77.0}) {
    const auto now = with_second(sights_of(real, {turn_deg}, {}), real, {turn_deg}, R_SL).front();
    const MarkedTurn told = turn_of(fit->turning, now.X_TS->rotation.transpose() * now.X_TL->rotation);
    EXPECT_NEAR(told.turn_rad, turn_deg * kDegree, 1e-6);
  }
}

TEST_P(EveryMarker, WithASecondOneThatDoesNotTurnIsRefused) {
  const auto [marker, view_deg] = GetParam();
  const RealScope real = real_scope(view_deg, marker);
  const std::vector<double> turns{0, 50, 110, 170};
  auto sights = with_second(sights_of(real, turns, {}), real, turns, Eigen::Matrix3d::Identity());
  for (TurnSight& sight : sights) sight.X_TL->rotation = sight.X_TS->rotation;
  const auto fit = fit_turning(sights, task_for(real, view_deg));
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message.find("the second marker turns otherwise"), std::string::npos)
      << fit.error().message;
}
INSTANTIATE_TEST_SUITE_P(Turning, EveryMarker,
                         ::testing::Combine(::testing::Values(TurnMarker::shaft, TurnMarker::head),
                                            ::testing::Values(30.0, 110.0)));

TEST(TurningCommand, RefusesAMarkerWhosePosesAreMissingOrUseless) {
  TurningCommand command{.marker = TurnMarker::head};
  const auto why = [&] { return calibrate_turning(command, {}, {}).error().message; };
  EXPECT_NE(why().find("--poses is wanted too"), std::string::npos);
  command.marker = TurnMarker::shaft;
  command.poses = "poses.csv";
  EXPECT_NE(why().find("tell no turn"), std::string::npos);
  command.poses.clear();
  command.second_poses = "second.csv";
  EXPECT_NE(why().find("stand alone"), std::string::npos);
}

TEST(TurningCommand, SaysWhereTheMarkerSits) {
  TurningCalibration calibration;
  EXPECT_NE(turning_text(calibration).find("marker on the shaft"), std::string::npos);
  calibration.fit.turning.marker = TurnMarker::head;
  EXPECT_NE(turning_text(calibration).find("marker on the head"), std::string::npos);
}

}  // namespace
}  // namespace orcart
