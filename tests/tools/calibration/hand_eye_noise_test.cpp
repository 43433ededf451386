// Hand-eye calibration with noise on each marker of scope and reference: how far the tip is off afterwards,
// against what the tracker's noise alone allows.
#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "realtime/registration/rigid_fit.hpp"
#include "tests/tools/calibration/simulated_board.hpp"
#include "tools/calibration/board_pose.hpp"
#include "tools/calibration/hand_eye.hpp"

namespace orcart {
namespace {

using Markers = std::vector<Eigen::Vector3d>;

const Markers kScope{{0, 0, 0}, {0, 52, 18}, {46, -31, 9}, {-38, -44, 0}};
const Markers kReference{{0, 0, 0}, {0, 62, 0}, {51, -24, 0}, {-33, -47, 0}};
/// 200 mm from the scope's marker to the tip, 150 mm from the reference to the board.
const Pose<S, C> kX_SC{
    .rotation = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(),
    .translation_mm = Eigen::Vector3d(-15, 190, -60).normalized() * 200};
const Pose<R, B> kX_RB{
    .rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(0, 1, 1).normalized()).toRotationMatrix(),
    .translation_mm = Eigen::Vector3d(120, -60, 40).normalized() * 150};
const Pose<T, R> kX_TR{
    .rotation = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 0.2, 0).normalized()).toRotationMatrix(),
    .translation_mm = {40, -60, -1500}};

/// A body as the tracker fits it to its noisy markers, z three times as noisy as x and y.
template <class A, class D>
Pose<A, D> tracked(const Pose<A, D>& X_AD, const Markers& markers, double rms_mm, std::mt19937& random) {
  std::normal_distribution<double> noise(0, rms_mm / std::sqrt(11.0));
  Markers seen;
  for (const Eigen::Vector3d& m : markers)
    seen.push_back((X_AD * Point<D>{m}).mm +
                   Eigen::Vector3d(noise(random), noise(random), 3 * noise(random)));
  const auto fit = rigid_fit({.from_mm = markers, .to_mm = seen});
  return {.rotation = fit->rotation, .translation_mm = fit->translation_mm};
}

/// The scope's body in the reference's, as the cart knows it.
Pose<R, S> measured(const Pose<C, B>& X_CB, double rms_mm, std::mt19937& random) {
  const Pose<R, S> X_RS = kX_RB * X_CB.inverse() * kX_SC.inverse();
  return tracked(kX_TR, kReference, rms_mm, random).inverse() * tracked(kX_TR * X_RS, kScope, rms_mm, random);
}

struct TipErrors {
  double calibrated_mm = 0, floor_mm = 0;  ///< mean distances, with the calibrated and with the true X_SC
};

TipErrors tip_errors(double rms_mm, int setups) {
  const Lens lens = testing::test_lens(LensModel::brown);
  std::vector<Pose<C, B>> truth;
  const auto boards = testing::simulated_views(
      lens, {.views = 20, .noise_px = 0.2, .tilt_rad = 0.7, .roll_rad = 1.5}, &truth);
  TipErrors sum;
  std::mt19937 random(5);
  for (int setup = 0; setup < setups; ++setup) {
    std::vector<HandEyeView> views;
    for (std::size_t v = 0; v < boards.size(); ++v) {
      const Pose<R, S> X_RS = measured(truth[v], rms_mm, random);
      views.push_back({.X_TS = {.rotation = X_RS.rotation, .translation_mm = X_RS.translation_mm},
                       .X_CB = *board_pose(boards[v], lens),
                       .board = boards[v]});
    }
    const TrackerNoise noise{.marker_mm = rms_mm, .body_radius_mm = 45, .poses_in = PosesIn::reference};
    const auto fit = refine_hand_eye(views, lens, {.noise = noise, .role = LensRole::held});
    if (!fit) return {1e9, 1};
    for (const Pose<C, B>& X_CB : truth) {
      const Pose<R, S> X_RS = measured(X_CB, rms_mm, random);
      const Eigen::Vector3d tip = (kX_RB * X_CB.inverse()).translation_mm;
      const double count = 20.0 * setups;
      sum.calibrated_mm += ((X_RS * fit->X_SC).translation_mm - tip).norm() / count;
      sum.floor_mm += ((X_RS * kX_SC).translation_mm - tip).norm() / count;
    }
  }
  return sum;
}

TEST(HandEyeNoise, ATrackerOf012LeavesTheTipWithin040) {
  const TipErrors tip = tip_errors(0.12, 10);
  EXPECT_LE(tip.calibrated_mm, 0.40);
}

TEST(HandEyeNoise, ATrackerOf025StaysWithinATenthOfItsFloor) {
  const TipErrors tip = tip_errors(0.25, 10);
  EXPECT_LE(tip.calibrated_mm, 1.1 * tip.floor_mm);
}

struct Declared {
  double true_mm = 0.12, told_mm = 0.12;
  LensRole role = LensRole::held;
  int views = 8, rooms = 300;
};

/// How many of `rooms` calibrations have the truth within what they say is their 95 %, and the mean square of
/// the focal length's error in its own standard deviations.
struct Honesty {
  double covered = 0, focal2 = 0, misfit = 0;
};

Honesty honesty(const Declared& task) {
  constexpr double kChiSquare95OfSix = 12.591587243743977;
  const Lens lens = testing::test_lens(LensModel::brown);
  std::vector<Pose<C, B>> truth;
  auto boards =
      testing::simulated_views(lens, {.views = task.views, .tilt_rad = 0.7, .roll_rad = 1.5}, &truth);
  for (BoardView& board : boards)
    std::erase_if(board.corners,
                  [](const BoardCorner& c) { return (c.lattice.x() + c.lattice.y()) % 3 != 0; });
  std::mt19937 random(9);
  std::normal_distribution<double> pixel_noise(0, 0.2);
  Honesty sum;
  for (int room = 0; room < task.rooms; ++room) {
    std::vector<HandEyeView> views;
    for (std::size_t v = 0; v < boards.size(); ++v) {
      BoardView board = boards[v];
      for (BoardCorner& c : board.corners)
        c.pixel_px += Eigen::Vector2d(pixel_noise(random), pixel_noise(random));
      const Pose<R, S> X_RS = measured(truth[v], task.true_mm, random);
      views.push_back({.X_TS = {.rotation = X_RS.rotation, .translation_mm = X_RS.translation_mm},
                       .X_CB = *board_pose(board, lens),
                       .board = board});
    }
    const RefineTask refine{
        .noise = {.marker_mm = task.told_mm, .body_radius_mm = 45, .poses_in = PosesIn::reference},
        .role = task.role};
    const auto fit = refine_hand_eye(views, lens, refine);
    const auto spread = fit ? hand_eye_spread(views, *fit, refine) : std::nullopt;
    if (!spread) return {};
    const Eigen::AngleAxisd turn(kX_SC.rotation.transpose() * fit->X_SC.rotation);
    Twist off;
    off << kX_SC.rotation.transpose() * (fit->X_SC.translation_mm - kX_SC.translation_mm),
        turn.angle() * turn.axis();
    sum.covered += off.dot(spread->hand_eye.ldlt().solve(off)) <= kChiSquare95OfSix ? 1.0 / task.rooms : 0;
    sum.misfit += spread->misfit / task.rooms;
    if (spread->lens)
      sum.focal2 += std::pow(fit->lens.fx_px - lens.fx_px, 2) / (*spread->lens)(0, 0) / task.rooms;
  }
  return sum;
}

TEST(HandEyeSpread, HoldsTheTruthAsOftenAsItSaysWhateverNoiseWasDeclared) {
  for (const double told_mm : {0.06, 0.12, 0.3}) {
    const Honesty h = honesty({.told_mm = told_mm});
    ::testing::Test::RecordProperty("covered_told_" + std::to_string(told_mm), std::to_string(h.covered));
    EXPECT_GE(h.covered, 0.90) << told_mm;
    EXPECT_LE(h.covered, 0.99) << told_mm;
    EXPECT_NEAR(std::sqrt(h.misfit) * told_mm / 0.12, 1, 0.35) << told_mm;
  }
}

TEST(HandEyeSpread, OfALensThatMovesAlongIsHonestToo) {
  const Honesty h = honesty({.role = LensRole::refined, .rooms = 100});
  EXPECT_GE(h.covered, 0.88);
  EXPECT_LE(h.covered, 1.0);
  EXPECT_GT(h.focal2, 0.6);
  EXPECT_LT(h.focal2, 1.6);
}

TEST(HandEyeSpread, SaysNothingWhereTheViewsLeaveSomethingOpen) {
  const Lens lens = testing::test_lens(LensModel::brown);
  std::vector<Pose<C, B>> truth;
  const auto boards = testing::simulated_views(lens, {.views = 3}, &truth);
  std::vector<HandEyeView> views;
  HandEyeFit fit{.lens = lens, .corner_sigma_px = 0.2};
  for (std::size_t v = 0; v < boards.size(); ++v) {
    views.push_back({.X_TS = {}, .X_CB = truth[0], .board = boards[0]});  // the scope never moved
    fit.X_CB.push_back(truth[0]);
  }
  EXPECT_FALSE(hand_eye_spread(views, fit, {.role = LensRole::held}));
}

TEST(TrackerNoise, TheCovarianceOfABodyIsWhatFitsToNoisyMarkersScatterBy) {
  std::mt19937 random(3);
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  double radius2 = 0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& m : kScope) middle += m / 4;
  for (const auto& m : kScope) radius2 += (m - middle).squaredNorm() / 4;
  Markers centred;
  for (const auto& m : kScope) centred.emplace_back(m - middle);
  constexpr int kDraws = 3000;
  std::normal_distribution<double> any(0, 1);
  for (int i = 0; i < kDraws; ++i) {
    Pose<T, S> X_TS;
    X_TS.rotation = Eigen::Quaterniond(any(random), any(random), any(random), any(random))
                        .normalized()
                        .toRotationMatrix();
    const Pose<T, S> seen = tracked(X_TS, centred, 0.25, random);
    const Eigen::AngleAxisd turn(seen.rotation * X_TS.rotation.transpose());
    Eigen::Matrix<double, 6, 1> off;
    off << turn.angle() * turn.axis(), seen.translation_mm;
    sum += off * off.transpose() / kDraws;
  }
  const auto told = pose_covariance(
      {.marker_mm = 0.25, .body_radius_mm = std::sqrt(radius2), .depth_ratio = 3}, Eigen::Vector3d::Zero());
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(std::sqrt(sum(i, i)), std::sqrt(told(i, i)), 0.3 * std::sqrt(told(i, i))) << i;
}

}  // namespace
}  // namespace orcart
