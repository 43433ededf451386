// The cluster tree: holds each triangle once, keeps its bounds, and a cone's walk misses nothing.
#include "realtime/geometry/cluster_tree.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "realtime/geometry/cone_walk.hpp"
#include "tests/realtime/geometry/analytic_meshes.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

Pose<M, C> random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return pose_from_quaternion<M, C>(q, 25 * Eigen::Vector3d(normal(random), normal(random), normal(random)));
}

/// Whether the vertex lies in the cone, by double precision.
bool inside(const Pose<M, C>& X_MC, const ConeShape& shape, const Eigen::Vector3f& v, double slack_mm) {
  const Eigen::Vector3d p = (X_MC.inverse() * Point<M>{v.cast<double>()}).mm;
  return p.z() <= shape.far_mm + slack_mm &&
         p.z() * std::tan(shape.half_angle_rad) - p.head<2>().norm() >= -slack_mm;
}

TEST(ClusterTree, HoldsEachTriangleOnceWithItsCorners) {
  const TriangleMesh mesh = testing::icosphere(40, 4);
  const ClusterTree tree = ClusterTree::create(mesh).value();
  std::vector<int> met(mesh.triangles.size(), 0);
  for (std::uint32_t i = 0; i < tree.cluster_count(); ++i) {
    const ClusterTree::Cluster cluster = tree.cluster(i);
    EXPECT_LE(cluster.corners.size(), ClusterTree::kMaxTriangles);
    for (std::size_t t = 0; t < cluster.corners.size(); ++t) {
      ++met[cluster.triangle_ids[t]];
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint8_t at = cluster.corners[t][c];
        EXPECT_EQ(cluster.vertex_ids[at], mesh.triangles[cluster.triangle_ids[t]][c]);
        EXPECT_EQ(Eigen::Vector3f(cluster.x[at], cluster.y[at], cluster.z[at]),
                  mesh.vertices_mm[cluster.vertex_ids[at]]);
      }
    }
  }
  EXPECT_EQ(std::count(met.begin(), met.end(), 1), static_cast<std::ptrdiff_t>(mesh.triangles.size()));
}

TEST(ClusterTree, FillsItsClusters) {
  const TriangleMesh mesh = testing::icosphere(40, 5);
  const ClusterTree tree = ClusterTree::create(mesh).value();
  EXPECT_LE(tree.cluster_count(), mesh.triangles.size() / ClusterTree::kMaxTriangles + 1);
}

TEST(ClusterTree, TakesAtMost24BytesATriangle) {
  const TriangleMesh mesh = testing::icosphere(40, 5);
  EXPECT_LE(ClusterTree::create(mesh).value().bytes(), 24 * mesh.triangles.size());
}

TEST(ClusterTree, KeepsSubtreesTogetherAndFillsItsLowestNodes) {
  const TriangleMesh mesh = testing::icosphere(40, 5);
  const ClusterTree tree = ClusterTree::create(mesh).value();
  std::size_t lowest = 0;
  for (const ClusterTree::Node& node : tree.nodes()) {
    std::size_t clusters = 0;
    for (std::size_t place = 0; place < ClusterTree::kWidth; ++place) {
      const std::uint32_t first = node.cluster[place], end = node.cluster[place + 1];
      clusters += end - first == 1 ? 1 : 0;
      if (end - first < 2) continue;
      EXPECT_EQ(tree.nodes()[node.child[place]].cluster.front(), first);
      EXPECT_EQ(tree.nodes()[node.child[place]].cluster.back(), end);
    }
    lowest += clusters > 0 ? 1 : 0;
  }
  EXPECT_EQ(lowest, (tree.cluster_count() + ClusterTree::kWidth - 1) / ClusterTree::kWidth);
}

TEST(ClusterTree, StandsTrianglesThatAllLieOnOnePoint) {
  TriangleMesh mesh;
  mesh.vertices_mm = {{1, 2, 3}};
  mesh.triangles.assign(5000, {0, 0, 0});
  const ClusterTree tree = ClusterTree::create(mesh).value();
  EXPECT_EQ(tree.cluster_count(), 105U);
}

TEST(ClusterTree, RefusesWhatIsNoMesh) {
  EXPECT_FALSE(ClusterTree::create({}));
  TriangleMesh mesh = testing::plane_grid(10, 2, 0);
  mesh.vertices_mm[4].x() = NAN;
  EXPECT_FALSE(ClusterTree::create(mesh));
  mesh = testing::plane_grid(10, 2, 0);
  mesh.triangles[1][2] = 99;
  EXPECT_FALSE(ClusterTree::create(mesh));
}

TEST(ConeWalk, MissesNoVertexInTheConeAndCallsNoneInsideThatIsNot) {
  const TriangleMesh mesh = testing::icosphere(40, 5);
  const ClusterTree tree = ClusterTree::create(mesh).value();
  const ConeShape shape{.half_angle_rad = 0.6, .far_mm = 45};
  std::mt19937 random(11);
  std::size_t called_inside = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose<M, C> X_MC = random_pose(random);
    const ViewingCone cone = viewing_cone(X_MC, shape);
    std::vector<char> visited(mesh.triangles.size(), 0);
    ConeWalk walk;
    walk.begin(tree, cone);
    ClusterVisit visit;
    while (walk.next(tree, visit))
      for (const std::uint32_t t : tree.cluster(visit.cluster).triangle_ids) {
        EXPECT_EQ(visited[t]++, 0);
        for (const std::uint32_t v : mesh.triangles[t])
          EXPECT_TRUE(!visit.inside || inside(X_MC, shape, mesh.vertices_mm[v], 1e-4));
        called_inside += visit.inside ? 1 : 0;
      }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t v : mesh.triangles[t])
        EXPECT_TRUE(visited[t] == 1 || !inside(X_MC, shape, mesh.vertices_mm[v], -1e-4));
  }
  EXPECT_GT(called_inside, 10000U);
}

TEST(ConeWalk, FindsTheSameClustersInRunsAsOneByOne) {
  const TriangleMesh mesh = testing::icosphere(40, 5);
  const ClusterTree tree = ClusterTree::create(mesh).value();
  std::mt19937 random(12);
  for (int i = 0; i < 100; ++i) {
    const ViewingCone cone = viewing_cone(random_pose(random), {.half_angle_rad = 0.6, .far_mm = 45});
    std::vector<int> in_visits(tree.cluster_count(), 0), in_runs = in_visits;
    ConeWalk walk;
    walk.begin(tree, cone);
    ClusterVisit visit;
    while (walk.next(tree, visit)) in_visits[visit.cluster] += visit.inside ? 2 : 1;
    walk.begin(tree, cone);
    ClusterRun run;
    std::uint32_t end = 0;
    while (walk.next(tree, run)) {
      EXPECT_GE(run.first, end);
      end = run.end;
      for (std::uint32_t c = run.first; c < run.end; ++c) in_runs[c] += run.inside ? 2 : 1;
    }
    EXPECT_EQ(in_visits, in_runs);
  }
}

TEST(ConeWalk, VisitsNothingForAPoseThatIsNotANumber) {
  const ClusterTree tree = ClusterTree::create(testing::icosphere(40, 3)).value();
  Pose<M, C> X_MC;
  X_MC.translation_mm.x() = NAN;
  ConeWalk walk;
  walk.begin(tree, viewing_cone(X_MC, {.half_angle_rad = 0.6, .far_mm = 60}));
  ClusterVisit visit;
  EXPECT_FALSE(walk.next(tree, visit));
}

TEST(ConeWalk, AllocatesNothing) {
  const ClusterTree tree = ClusterTree::create(testing::icosphere(40, 4)).value();
  const ViewingCone cone = viewing_cone({}, {.half_angle_rad = 0.6, .far_mm = 60});
  ConeWalk walk;
  ClusterVisit visit;
  EXPECT_TRUE(testing::zero_allocation([&] {
    walk.begin(tree, cone);
    while (walk.next(tree, visit)) {
    }
  }));
}

}  // namespace
}  // namespace orcart
