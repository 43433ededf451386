// Gauss-Newton over six numbers; nearest points come from triangles near each point.
#include "tools/registration/surface_refine.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kReach_mm = 12;  ///< triangles that a point may move to
constexpr double kFarthest_mm = 15;
constexpr std::size_t kFewest = 6;

/// Ericson 2004, section 5.1.5.
Eigen::Vector3d nearest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                    const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  const double sum = va + vb + vc;
  return a + vb / sum * ab + vc / sum * ac;
}

struct Touch {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Vector3d away = Eigen::Vector3d::UnitZ();  ///< unit, from the surface to the point, or its normal
  double distance_mm = 1e9;
};

class NearSurface {
 public:
  explicit NearSurface(const TriangleMesh& mesh) : mesh_(mesh) {}

  std::array<Eigen::Vector3d, 3> corners(std::size_t triangle) const {
    const auto& t = mesh_.triangles[triangle];
    return {mesh_.vertices_mm[t[0]].cast<double>(), mesh_.vertices_mm[t[1]].cast<double>(),
            mesh_.vertices_mm[t[2]].cast<double>()};
  }
  Touch touch(const Eigen::Vector3d& p, const std::vector<std::size_t>* among) const {
    Touch best;
    std::size_t at = 0;
    const std::size_t count = among != nullptr ? among->size() : mesh_.triangles.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t triangle = among != nullptr ? (*among)[i] : i;
      const auto [a, b, c] = corners(triangle);
      const Eigen::Vector3d place = nearest_on_triangle(p, a, b, c);
      const double distance = (p - place).norm();
      if (distance < best.distance_mm) best.distance_mm = distance, best.place = place, at = triangle;
    }
    const auto [a, b, c] = corners(at);
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    best.away = best.distance_mm > 1e-6 ? Eigen::Vector3d((p - best.place) / best.distance_mm)
                                        : Eigen::Vector3d(normal.normalized());
    return best;
  }
  std::vector<std::size_t> around(const Eigen::Vector3d& p, double reach_mm) const {
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const auto [a, b, c] = corners(i);
      if ((nearest_on_triangle(p, a, b, c) - p).norm() < reach_mm) near.push_back(i);
    }
    return near;
  }

 private:
  const TriangleMesh& mesh_;
};

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::Matrix<double, 3, 6> motion_of(const Eigen::Vector3d& from_centre) {
  Eigen::Matrix<double, 3, 6> m = Eigen::Matrix<double, 3, 6>::Zero();
  m(0, 1) = from_centre.z(), m(0, 2) = -from_centre.y();
  m(1, 0) = -from_centre.z(), m(1, 2) = from_centre.x();
  m(2, 0) = from_centre.y(), m(2, 1) = -from_centre.x();
  m.rightCols<3>().setIdentity();
  return m;
}

/// Normal equations at one pose.
struct Normal {
  Matrix6 left = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  double surface2 = 0;
  std::size_t used = 0;
};

class Refiner {
 public:
  Refiner(const Registration& registration, const TriangleMesh& mesh, const SurfaceTask& task)
      : registration_(registration), surface_(mesh), task_(task), pose_(registration.X_MR) {}

  Result<void> begin() {
    std::vector<double> distances;
    for (const auto& p : task_.points_R_mm)
      distances.push_back(surface_.touch(place(p), nullptr).distance_mm);
    if (const double middle = median_of(distances); middle > kFarthest_mm)
      return fail(
          json::format("half of the surface points lie %.0f mm and more off the surface; up to %.0f mm is "
                       "accepted: are they in the reference's space, as the fiducials are?",
                       middle, kFarthest_mm));
    for (std::size_t i = 0; i < distances.size(); ++i)
      near_.push_back(surface_.around(place(task_.points_R_mm[i]), distances[i] + kReach_mm));
    return {};
  }

  Normal equations() const {
    Normal n;
    const double sigma = registration_.fle_mm / std::sqrt(3.0);
    for (const RegisteredPoint& f : registration_.points) {
      const Eigen::Vector3d p = place(f.moving_mm);
      const auto j = motion_of(p - registration_.centroid_mm);
      n.left += j.transpose() * j / (sigma * sigma);
      n.right -= j.transpose() * (p - f.fixed_mm) / (sigma * sigma);
    }
    std::vector<Touch> touches;
    std::vector<double> distances;
    for (std::size_t i = 0; i < near_.size(); ++i) {
      touches.push_back(surface_.touch(place(task_.points_R_mm[i]), &near_[i]));
      distances.push_back(touches.back().distance_mm);
    }
    const double limit = std::max(3 * task_.error_mm, 3 * 1.48 * median_of(distances));
    for (std::size_t i = 0; i < near_.size(); ++i) {
      if (distances[i] > limit) continue;
      const Eigen::Vector3d p = place(task_.points_R_mm[i]);
      const Vector6 j = motion_of(p - registration_.centroid_mm).transpose() * touches[i].away;
      const double sigma2 = task_.error_mm * task_.error_mm;
      n.left += j * j.transpose() / sigma2;
      n.right -= j * distances[i] / sigma2;
      n.surface2 += distances[i] * distances[i];
      ++n.used;
    }
    return n;
  }

  void move(const Vector6& step) {
    const Eigen::Vector3d turn = step.head<3>();
    const double angle = turn.norm();
    const Eigen::Matrix3d rotation = angle > 1e-15 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix()
                                                   : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    const Eigen::Vector3d& c = registration_.centroid_mm;
    pose_ = {.rotation = rotation * pose_.rotation,
             .translation_mm = rotation * (pose_.translation_mm - c) + c + step.tail<3>()};
  }
  const Pose<M, R>& pose() const { return pose_; }
  Eigen::Vector3d place(const Eigen::Vector3d& p_R) const { return (pose_ * Point<R>{p_R}).mm; }

 private:
  const Registration& registration_;
  NearSurface surface_;
  const SurfaceTask& task_;
  Pose<M, R> pose_;
  std::vector<std::vector<std::size_t>> near_;
};

double rms_mm(const Normal& n) {
  return n.used > 0 ? std::sqrt(n.surface2 / static_cast<double>(n.used)) : 0;
}

}  // namespace

Result<SurfaceRefinement> refine_on_surface(Registration& registration, const TriangleMesh& mesh,
                                            const SurfaceTask& task) {
  constexpr int kSteps = 40;
  if (task.points_R_mm.size() < kFewest)
    return fail("too few surface points: " + std::to_string(task.points_R_mm.size()) +
                "; six or more, spread over the surface, are accepted");
  Refiner refiner(registration, mesh, task);
  if (auto begun = refiner.begin(); !begun) return tl::unexpected(begun.error());
  Normal normal = refiner.equations();
  SurfaceRefinement result{.before_mm = rms_mm(normal)};
  for (int i = 0; i < kSteps; ++i) {
    const Vector6 step = normal.left.ldlt().solve(normal.right);
    refiner.move(step);
    normal = refiner.equations();
    if (step.norm() < 1e-7) break;
  }
  result.after_mm = rms_mm(normal);
  result.used = normal.used, result.left_out = task.points_R_mm.size() - normal.used;
  if (result.used < kFewest)
    return fail("only " + std::to_string(result.used) +
                " surface points agree with the surface; six or more are accepted");
  const Eigen::Vector3d middle_R = (registration.X_MR.inverse() * Point<M>{registration.centroid_mm}).mm;
  result.moved_mm = (refiner.place(middle_R) - registration.centroid_mm).norm();
  registration.X_MR = refiner.pose();
  double sum2 = 0;
  for (RegisteredPoint& p : registration.points) {
    p.error_mm = (refiner.place(p.moving_mm) - p.fixed_mm).norm();
    sum2 += p.error_mm * p.error_mm;
  }
  registration.fre_mm = std::sqrt(sum2 / static_cast<double>(registration.points.size()));
  registration.pose_covariance = normal.left.inverse();
  tell_shape(registration);
  return result;
}

SurfaceTre tre_over_surface(const Registration& registration, const TriangleMesh& mesh) {
  SurfaceTre tre;
  std::vector<double> all;
  all.reserve(mesh.vertices_mm.size());
  for (const auto& vertex : mesh.vertices_mm) {
    all.push_back(predicted_tre_mm(registration, vertex.cast<double>()));
    tre.mean_mm += all.back() / static_cast<double>(mesh.vertices_mm.size());
    if (all.back() > tre.worst_mm) tre.worst_mm = all.back(), tre.worst_at_mm = vertex.cast<double>();
  }
  if (all.empty()) return tre;
  const auto p95 = all.begin() + static_cast<std::ptrdiff_t>(95 * (all.size() - 1) / 100);
  std::nth_element(all.begin(), p95, all.end());
  tre.p95_mm = *p95;
  return tre;
}

}  // namespace orcart
