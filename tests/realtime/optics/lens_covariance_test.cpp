// What a lens's covariance makes of a pixel: by hand on the axis, by draws beside it.
#include "realtime/optics/lens_covariance.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

namespace orcart {
namespace {

Lens brown() {
  Lens lens{.model = LensModel::brown,
            .fx_px = 400,
            .fy_px = 390,
            .cx_px = 320,
            .cy_px = 240,
            .coefficients = {-0.26, 0.07, 0.0006, -0.0004, 0}};
  lens.max_angle_rad = largest_monotone_angle_rad(lens, 1.3);
  return lens;
}

TEST(LensDeviation, OnTheAxisIsThatOfTheCentre) {
  LensCovariance covariance = LensCovariance::Zero();
  covariance(0, 0) = 4, covariance(2, 2) = 0.09, covariance(3, 3) = 0.16, covariance(4, 4) = 1e-4;
  EXPECT_NEAR(lens_deviation_px(brown(), covariance, 0), std::sqrt((0.09 + 0.16) / 2), 1e-6);
}

TEST(LensDeviation, OfTheFocalLengthGrowsWithTheTangent) {
  LensCovariance covariance = LensCovariance::Zero();
  covariance(0, 0) = covariance(1, 1) = 1;
  Lens pinhole = brown();
  pinhole.coefficients = {};
  // An axis sees x / z, whose square is on the average half the tangent's.
  EXPECT_NEAR(lens_deviation_px(pinhole, covariance, 0.5), std::tan(0.5) / std::sqrt(2.0), 1e-6);
}

TEST(LensDeviation, AgreesWithDrawnLenses) {
  const Lens lens = brown();
  LensCovariance covariance = LensCovariance::Zero();
  covariance.diagonal().head<6>() << 0.5, 0.4, 0.04, 0.05, 1e-5, 1e-5;
  covariance(0, 1) = covariance(1, 0) = 0.4;
  covariance(4, 5) = covariance(5, 4) = -0.9e-5;
  const Eigen::Matrix<double, 6, 6> root = covariance.topLeftCorner<6, 6>().llt().matrixL();
  std::mt19937 random(4);
  std::normal_distribution<double> any(0, 1);
  constexpr double kAngle = 0.45;
  constexpr int kDraws = 20'000;
  double sum2 = 0;
  for (int i = 0; i < kDraws; ++i) {
    LensStep step = LensStep::Zero();
    Eigen::Matrix<double, 6, 1> z;
    for (double& number : z) number = any(random);
    step.head<6>() = root * z;
    const double around = 0.7853981633974483 * (i % 8);
    const Eigen::Vector3d direction(std::sin(kAngle) * std::cos(around), std::sin(kAngle) * std::sin(around),
                                    std::cos(kAngle));
    sum2 += (*project(stepped(lens, step), direction) - *project(lens, direction)).squaredNorm() / 2 / kDraws;
  }
  EXPECT_NEAR(lens_deviation_px(lens, covariance, kAngle) / std::sqrt(sum2), 1, 0.03);
}

}  // namespace
}  // namespace orcart
