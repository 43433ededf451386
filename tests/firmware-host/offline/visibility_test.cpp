// Paint against eyesight in double precision, triangle by triangle without a tree: all that is painted is
// seen, and of what is seen within the limits nearly all is painted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware-host/offline/offline_painter.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

constexpr std::size_t kEveryTexel = 23;  // of the atlas; a prime, so that no row is favoured
constexpr double kMaxObliquity_rad = 1.3963;

/// Every triangle asked (Moeller and Trumbore 1997), both sides.
class Eyesight {
 public:
  Eyesight(const TriangleMesh& mesh, const Eigen::Vector3d& eye) : eye_(eye) {
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3d a = mesh.vertices_mm[t[0]].cast<double>();
      triangles_.push_back(
          {a, mesh.vertices_mm[t[1]].cast<double>() - a, mesh.vertices_mm[t[2]].cast<double>() - a});
    }
  }
  /// Along a unit direction; infinite where nothing is met.
  double nearest_mm(const Eigen::Vector3d& direction) const {
    double nearest = INFINITY;
    for (const auto& [a, ab, ac] : triangles_) {
      const Eigen::Vector3d p = direction.cross(ac);
      const double determinant = ab.dot(p);
      if (std::abs(determinant) < 1e-14) continue;
      const Eigen::Vector3d s = eye_ - a, q = s.cross(ab);
      const double u = s.dot(p) / determinant, v = direction.dot(q) / determinant;
      if (u < -1e-12 || v < -1e-12 || u + v > 1 + 1e-12) continue;
      const double distance = ac.dot(q) / determinant;
      if (distance > 1e-9) nearest = std::min(nearest, distance);
    }
    return nearest;
  }

 private:
  struct Triangle {
    Eigen::Vector3d a, ab, ac;
  };
  Eigen::Vector3d eye_;
  std::vector<Triangle> triangles_;
};

struct Judged {
  std::size_t painted = 0, painted_unseen = 0;
  std::size_t clearly_seen = 0, clearly_seen_unpainted = 0;
};

class Judge {
 public:
  Judge(const Surface& surface, const ScopeModel& scope, const Pose<M, C>& X_MC, SeenFrom seen_from)
      : surface_(surface),
        scope_(scope),
        X_CM_(X_MC.inverse()),
        X_MC_(X_MC),
        side_(seen_from == SeenFrom::outside ? 1 : -1),
        sight_(surface.mesh, X_MC.translation_mm) {}

  void judge(const Eigen::Vector3d& p, std::uint32_t triangle, bool painted, Judged& judged) const {
    const Eigen::Vector3d ray = p - X_MC_.translation_mm, direction = ray.normalized();
    const double distance_mm = ray.norm();
    const double obstructed_mm = distance_mm - sight_.nearest_mm(direction);
    // The painter's own tolerance, and half of it again for its depth texture.
    const bool seen = obstructed_mm < 1.5 * (0.04 + 0.002 * distance_mm);
    if (painted) {
      ++judged.painted;
      judged.painted_unseen += seen && cos_angle(direction, triangle) > 0 ? 0 : 1;
    }
    if (!within_limits(p, direction, distance_mm, triangle) || obstructed_mm > 0.01) return;
    if (beside_an_edge(p, triangle)) return;
    ++judged.clearly_seen;
    judged.clearly_seen_unpainted += painted ? 0 : 1;
  }

 private:
  Eigen::Vector3d normal_of(std::uint32_t triangle) const {
    const auto& t = surface_.mesh.triangles[triangle];
    const Eigen::Vector3d a = surface_.mesh.vertices_mm[t[0]].cast<double>(),
                          b = surface_.mesh.vertices_mm[t[1]].cast<double>(),
                          c = surface_.mesh.vertices_mm[t[2]].cast<double>();
    return side_ * (b - a).cross(c - a).normalized();
  }
  double cos_angle(const Eigen::Vector3d& direction, std::uint32_t triangle) const {
    return -normal_of(triangle).dot(direction);
  }

  bool within_limits(const Eigen::Vector3d& p, const Eigen::Vector3d& direction, double distance_mm,
                     std::uint32_t triangle) const {
    constexpr double kAngleMargin_rad = 0.004;  // normals are kept to 0.06 degrees
    const Eigen::Vector3d p_C = (X_CM_ * Point<M>{p}).mm;
    const auto pixel = project(scope_.lens, p_C);
    if (!pixel || distance_mm > scope_.far_mm - 0.01 ||
        p_C.z() / distance_mm < std::cos(scope_.cone_half_angle_rad - 1e-4))
      return false;
    const Eigen::Vector2d from_centre(
        pixel->x() - scope_.mask.cx_px,
        (pixel->y() - scope_.mask.cy_px) * scope_.lens.fx_px / scope_.lens.fy_px);
    return from_centre.norm() < scope_.mask.radius_px - 0.1 &&
           cos_angle(direction, triangle) > std::cos(kMaxObliquity_rad - kAngleMargin_rad);
  }

  /// Within 2.6 pixels (the painter's 1.5, and its depth texture's) something else is seen than the texel's
  /// own plane.
  bool beside_an_edge(const Eigen::Vector3d& p, std::uint32_t triangle) const {
    const Eigen::Vector3d p_C = (X_CM_ * Point<M>{p}).mm, normal_C = X_CM_.rotation * normal_of(triangle);
    const double slope2 = p_C.head<2>().squaredNorm() / (p_C.z() * p_C.z());
    const double margin_mm = 0.8 * (0.25 + 0.015 * p_C.z());
    for (int ring = 1; ring <= 2; ++ring)
      for (int k = 0; k < 12; ++k) {
        const double angle = 2 * std::numbers::pi * k / 12,
                     reach = 1.3 * ring / scope_.lens.fx_px * (1 + slope2);
        Eigen::Vector3d beside(p_C.x() / p_C.z() + reach * std::cos(angle),
                               p_C.y() / p_C.z() + reach * std::sin(angle), 1);
        const double own_z = normal_C.dot(p_C) / normal_C.dot(beside);
        const double seen_z = sight_.nearest_mm(X_MC_.rotation * beside.normalized()) / beside.norm();
        if (!(own_z > 0) || seen_z - own_z > margin_mm ||
            std::min(own_z, p_C.z() + margin_mm) - seen_z > margin_mm)
          return true;
      }
    return false;
  }

  const Surface& surface_;
  ScopeModel scope_;
  Pose<C, M> X_CM_;
  Pose<M, C> X_MC_;
  double side_;
  Eyesight sight_;
};

Judged judged(const Surface& surface, const ScopeModel& scope, const std::vector<Pose<M, C>>& poses,
              SeenFrom seen_from) {
  auto painter = OfflinePainter::create(surface, scope, {.seen_from = seen_from, .texel_mm = 0.2});
  EXPECT_TRUE(painter) << painter.error().message;
  auto white = scenes::flat(scope, 200, 200, 200);
  Judged all;
  for (const Pose<M, C>& X_MC : poses) {
    painter->painter().clear();
    EXPECT_TRUE(painter->paint(white.descriptor(), X_MC));
    const AtlasPicture picture = painter->painter().read_back();
    const Judge judge(surface, scope, X_MC, seen_from);
    const AtlasLayout& layout = painter->layout();
    for (std::size_t i = 0; i < layout.owners.size(); i += kEveryTexel) {
      if (layout.inside[i] == 0) continue;
      const Eigen::Vector3d p = scenes::point_of(surface, layout, i);
      if ((p - X_MC.translation_mm).norm() > scope.far_mm + 1) continue;
      const bool painted = picture.rgba[4 * i + 3] > 0;
      const Eigen::Vector3d p_C = (X_MC.inverse() * Point<M>{p}).mm;
      if (!painted && p_C.z() < 0) continue;
      judge.judge(p, layout.owners[i].triangle, painted, all);
    }
  }
  return all;
}

TEST(Visibility, OfAFoldedSurfaceFromOutside) {
  const ScopeModel scope = scenes::scope();
  Surface bumps = scenes::plane(25, 40, 80);
  for (Eigen::Vector3f& v : bumps.mesh.vertices_mm)
    v.z() += 4 * std::sin(v.x() * 0.9F) * std::cos(v.y() * 0.7F) + 1.5F * std::sin(v.x() * 2.3F + v.y());
  Pose<M, C> from_the_side;
  from_the_side.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()).toRotationMatrix();
  from_the_side.translation_mm = {-16, 2, 4};
  const Judged found = judged(bumps, scope, {Pose<M, C>{}, from_the_side}, SeenFrom::outside);
  RecordProperty("painted", std::to_string(found.painted));
  RecordProperty("clearly_seen", std::to_string(found.clearly_seen));
  EXPECT_GT(found.painted, 1'000U);
  EXPECT_EQ(found.painted_unseen, 0U) << "of " << found.painted;
  EXPECT_GT(found.clearly_seen, 1'000U);
  EXPECT_LE(found.clearly_seen_unpainted, found.clearly_seen / 1000) << "of " << found.clearly_seen;
}

}  // namespace
}  // namespace orcart
