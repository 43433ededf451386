// Points on the surface make a registration better, and the predicted error says by how much.
#include "tools/registration/surface_refine.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

const Pose<M, R> kTruth{
    .rotation = Eigen::AngleAxisd(1.3, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix(),
    .translation_mm = {100, -300, 40}};

/// Axes of three lengths, so that nothing slides on it.
Eigen::Vector3d on_ellipsoid(double u, double v) {
  return {60 * std::cos(u) * std::cos(v), 45 * std::sin(u) * std::cos(v), 80 * std::sin(v)};
}

TriangleMesh ellipsoid() {
  constexpr std::uint32_t kAround = 64, kUp = 32;
  TriangleMesh mesh;
  for (std::uint32_t j = 0; j <= kUp; ++j)
    for (std::uint32_t i = 0; i < kAround; ++i)
      mesh.vertices_mm.push_back(
          on_ellipsoid(2 * std::numbers::pi * i / kAround, std::numbers::pi * (1.0 * j / kUp - 0.5))
              .cast<float>());
  for (std::uint32_t j = 0; j < kUp; ++j)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const std::uint32_t a = j * kAround + i, b = j * kAround + (i + 1) % kAround;
      mesh.triangles.push_back({a, b, b + kAround});
      mesh.triangles.push_back({a, b + kAround, a + kAround});
    }
  return mesh;
}

struct Scene {
  RegistrationTask fiducials{.fle_mm = 2};
  SurfaceTask surface{.error_mm = 0.3};
};

/// Four fiducials low on one side, 40 points all over.
Scene scene(std::mt19937& random) {
  std::normal_distribution<double> noise(0, 1);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto shaken = [&](double sigma) -> Eigen::Vector3d {
    return sigma * Eigen::Vector3d(noise(random), noise(random), noise(random));
  };
  Scene made;
  int number = 0;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(70, 0, -40), Eigen::Vector3d(30, 50, -60),
                                   Eigen::Vector3d(40, -45, -50), Eigen::Vector3d(65, 20, -10)}) {
    const std::string name = std::to_string(++number);
    made.fiducials.fixed.push_back({.name = name, .mm = p});
    made.fiducials.moving.push_back(
        {.name = name,
         .mm = (kTruth.inverse() * Point<M>{p}).mm + shaken(made.fiducials.fle_mm / std::sqrt(3.0))});
  }
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d p = on_ellipsoid(std::numbers::pi * any(random), 1.4 * any(random));
    made.surface.points_R_mm.push_back((kTruth.inverse() * Point<M>{p}).mm + shaken(0.2));
  }
  return made;
}

TEST(SurfaceRefine, BringsAFarTargetNearerAndPredictsByHowMuch) {
  std::mt19937 random(2);
  const TriangleMesh mesh = ellipsoid();
  const Eigen::Vector3d target(-50, 10, 60);
  double before2 = 0, after2 = 0, predicted2 = 0;
  constexpr int kDraws = 12;
  for (int i = 0; i < kDraws; ++i) {
    Scene s = scene(random);
    auto registration = register_points(s.fiducials);
    ASSERT_TRUE(registration);
    const Eigen::Vector3d target_R = (kTruth.inverse() * Point<M>{target}).mm;
    before2 += ((registration->X_MR * Point<R>{target_R}).mm - target).squaredNorm() / kDraws;
    const auto refined = refine_on_surface(*registration, mesh, s.surface);
    ASSERT_TRUE(refined) << refined.error().message;
    EXPECT_GE(refined->used, 36U);
    EXPECT_LT(refined->after_mm, 0.5);
    after2 += ((registration->X_MR * Point<R>{target_R}).mm - target).squaredNorm() / kDraws;
    predicted2 += std::pow(predicted_tre_mm(*registration, target), 2) / kDraws;
  }
  EXPECT_LT(std::sqrt(after2), 0.5 * std::sqrt(before2));
  EXPECT_LT(std::sqrt(after2), 1.5 * std::sqrt(predicted2));
  EXPECT_GT(std::sqrt(after2), 0.4 * std::sqrt(predicted2));
}

TEST(SurfaceRefine, LeavesOutPointsThatWereNotOnTheSurface) {
  std::mt19937 random(3);
  Scene s = scene(random);
  s.surface.points_R_mm[5] += Eigen::Vector3d(9, 9, -9);
  auto registration = register_points(s.fiducials);
  ASSERT_TRUE(registration);
  const auto refined = refine_on_surface(*registration, ellipsoid(), s.surface);
  ASSERT_TRUE(refined);
  EXPECT_GE(refined->left_out, 1U);
  EXPECT_LT(refined->after_mm, 0.5);
}

TEST(SurfaceRefine, RefusesFewPointsAndPointsOfAnotherSpace) {
  std::mt19937 random(4);
  Scene s = scene(random);
  auto registration = register_points(s.fiducials);
  ASSERT_TRUE(registration);
  SurfaceTask few{.points_R_mm = {s.surface.points_R_mm[0]}};
  EXPECT_NE(refine_on_surface(*registration, ellipsoid(), few).error().message.find("six or more"),
            std::string::npos);
  for (auto& p : s.surface.points_R_mm) p = -p;
  EXPECT_NE(
      refine_on_surface(*registration, ellipsoid(), s.surface).error().message.find("reference's space"),
      std::string::npos);
}

TEST(SurfaceRefine, TellsAnewWhatANarrowSetMeans) {
  std::mt19937 random(6);
  Scene s = scene(random);
  for (auto* side : {&s.fiducials.fixed, &s.fiducials.moving}) side->resize(3);
  const std::vector<Eigen::Vector3d> line{{60, 0, -60}, {60, 3, 0}, {60, 0, 60}};
  for (std::size_t i = 0; i < line.size(); ++i) {
    s.fiducials.fixed[i].mm = line[i];
    s.fiducials.moving[i].mm = (kTruth.inverse() * Point<M>{line[i]}).mm;
  }
  auto registration = register_points(s.fiducials);
  ASSERT_TRUE(registration) << registration.error().message;
  const std::vector<std::string> before = registration->notes;
  ASSERT_EQ(before.size(), 1U);
  ASSERT_TRUE(refine_on_surface(*registration, ellipsoid(), s.surface));
  ASSERT_EQ(registration->notes.size(), 1U);
  EXPECT_NE(registration->notes[0], before[0]);
  const Eigen::Vector3d beside = registration->centroid_mm + 50 * registration->axes.col(1);
  EXPECT_NE(registration->notes[0].find(
                json::format("the expected error is %.1f mm", predicted_tre_mm(*registration, beside))),
            std::string::npos)
      << registration->notes[0];
}

TEST(SurfaceTre, IsLeastAmidTheFiducialsAndMostFarFromThem) {
  std::mt19937 random(5);
  const auto registration = register_points(scene(random).fiducials);
  ASSERT_TRUE(registration);
  const SurfaceTre tre = tre_over_surface(*registration, ellipsoid());
  EXPECT_GT(tre.worst_mm, tre.p95_mm);
  EXPECT_GT(tre.p95_mm, tre.mean_mm);
  EXPECT_LT(tre.worst_at_mm.x(), 0);  // the side away from them
  EXPECT_NEAR(predicted_tre_mm(*registration, tre.worst_at_mm), tre.worst_mm, 1e-12);
}

}  // namespace
}  // namespace orcart
