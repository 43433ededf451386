// Triangle counts on the bench surfaces against those of a stock VTK cutout (whole triangles, cone of 35
// degrees, far plane at 60 mm). VTK's rule takes a triangle with at least one corner in the cone; the cart's
// takes every triangle that meets it, so it lists a few more.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "firmware-host/files/surface_file.hpp"
#include "tests/realtime/mapper/mapper_fixture.hpp"
#include "tools/bench/mapper_bench.hpp"

namespace orcart {
namespace {

struct Counts {
  std::uint32_t median = 0, max = 0;
};

struct Published {
  const char* file;
  Counts corner_rule;
};

std::filesystem::path bench_folder() {
  const char* told = std::getenv("ORCART_BENCH");
  const char* source = std::getenv("ORCART_SOURCE_DIR");
  if (told != nullptr) return told;
  return std::filesystem::path(source == nullptr ? "." : source) / "../shared/bench";
}

Counts summary(std::vector<std::uint32_t> counts) {
  std::sort(counts.begin(), counts.end());
  return {counts[counts.size() / 2], counts.back()};
}

/// Double precision, from the definition.
bool corner_inside(const ScopeModel& scope, const Eigen::Vector3d& p_C_mm) {
  return p_C_mm.z() <= scope.far_mm &&
         p_C_mm.head<2>().norm() <= p_C_mm.z() * std::tan(scope.cone_half_angle_rad);
}

class BrainCounts : public ::testing::TestWithParam<Published> {};

TEST_P(BrainCounts, AreVtksByItsRuleAndFewMoreByTheExactOne) {
  const auto file = bench_folder() / GetParam().file;
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << file << " is absent; set ORCART_BENCH to the bench surfaces";
  const Surface surface = read_surface(file, nullptr, Space::lps).value();
  const auto poses = read_bench_poses(bench_folder() / "poses200.csv").value();
  ASSERT_EQ(poses.size(), 200U);
  const ScopeModel scope = bench_scope({});
  Mapper mapper = Mapper::create(surface, SeenFrom::outside, scope).value();
  std::vector<std::uint32_t> by_corner, exact;
  std::vector<char> inside(surface.mesh.vertices_mm.size());
  for (const auto& X_MC : poses) {
    const Pose<C, M> X_CM = X_MC.inverse();
    for (std::size_t v = 0; v < inside.size(); ++v)
      inside[v] =
          corner_inside(scope, (X_CM * Point<M>{surface.mesh.vertices_mm[v].cast<double>()}).mm) ? 1 : 0;
    const testing::WholeView view = testing::whole_view(mapper, X_MC);
    std::uint32_t count = 0;
    for (std::uint32_t t = 0; t < surface.mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = surface.mesh.triangles[t];
      if (inside[a] + inside[b] + inside[c] == 0) continue;
      ++count;
      ASSERT_TRUE(std::binary_search(view.painted.begin(), view.painted.end(), t) ||
                  std::binary_search(view.occluders.begin(), view.occluders.end(), t));
    }
    by_corner.push_back(count);
    exact.push_back(static_cast<std::uint32_t>(view.in_cone()));
  }
  EXPECT_EQ(summary(by_corner).median, GetParam().corner_rule.median);
  EXPECT_EQ(summary(by_corner).max, GetParam().corner_rule.max);
  EXPECT_LE(summary(exact).median, GetParam().corner_rule.median * 1.02);
  EXPECT_LE(summary(exact).max, GetParam().corner_rule.max * 1.02);
}

INSTANTIATE_TEST_SUITE_P(Vtk, BrainCounts,
                         ::testing::Values(Published{"brain_5k.ply", {.median = 334, .max = 425}},
                                           Published{"brain_50k.ply", {.median = 2877, .max = 3880}}),
                         [](const auto& each) { return each.index == 0 ? "brain_5k" : "brain_50k"; });

}  // namespace
}  // namespace orcart
