// Views and landmarks by rejection: draw, look, keep what a scope could see.
#include "tools/evaluate/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace orcart {

namespace {

constexpr double kNearestMm = 4, kFarthestMm = 25, kRoomMm = 2;
constexpr double kMaxTiltRad = 25 * std::numbers::pi / 180;
constexpr double kCosMaxObliquity = 0.17364817766693033;  // 80 degrees, the mapper's own limit

Eigen::Vector3d normal_of(const EvaluationScene& scene, std::uint32_t triangle) {
  const auto& t = scene.mesh.triangles[triangle];
  const Eigen::Vector3d a = scene.mesh.vertices_mm[t[0]].cast<double>();
  const Eigen::Vector3d normal = (scene.mesh.vertices_mm[t[1]].cast<double>() - a)
                                     .cross(scene.mesh.vertices_mm[t[2]].cast<double>() - a)
                                     .normalized();
  return scene.seen_from == SeenFrom::inside ? Eigen::Vector3d(-normal) : normal;
}

bool has_room(const EvaluationScene& scene, const Eigen::Vector3d& place) {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Eigen::Vector3f direction =
            Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)).normalized();
        if (scene.rays.nearest(place.cast<float>(), direction, static_cast<float>(kRoomMm))) return false;
      }
  return true;
}

/// z along the view, the rest turned by chance.
Eigen::Matrix3d looking_along(const Eigen::Vector3d& view, RandomStream& random) {
  const Eigen::Vector3d x = view.cross(random.direction()).normalized();
  Eigen::Matrix3d rotation;
  rotation.col(0) = x;
  rotation.col(1) = view.cross(x);
  rotation.col(2) = view;
  return rotation;
}

std::optional<Pose<M, C>> try_view(const EvaluationScene& scene, RandomStream& random) {
  const auto triangle = static_cast<std::uint32_t>(random.next() % scene.mesh.triangles.size());
  const auto& t = scene.mesh.triangles[triangle];
  const Eigen::Vector3d normal = normal_of(scene, triangle);
  const Eigen::Vector3d wall =
      (scene.mesh.vertices_mm[t[0]] + scene.mesh.vertices_mm[t[1]] + scene.mesh.vertices_mm[t[2]])
          .cast<double>() /
      3;
  const auto opposite = scene.rays.nearest((wall + 0.01 * normal).cast<float>(), normal.cast<float>(),
                                           static_cast<float>(2 * kFarthestMm));
  const double room = opposite ? static_cast<double>(opposite->distance_mm) - kRoomMm : kFarthestMm;
  if (room < kNearestMm) return std::nullopt;
  const double distance = random.between(kNearestMm, std::min(room, kFarthestMm));
  const double tilt = kMaxTiltRad * random.uniform();
  const Eigen::Vector3d sideways = normal.cross(random.direction()).normalized();
  const Eigen::Vector3d towards = Eigen::AngleAxisd(tilt, sideways) * normal;
  const Eigen::Vector3d place = wall + distance * towards;
  const auto first =
      scene.rays.nearest(place.cast<float>(), (-towards).cast<float>(), static_cast<float>(2 * kFarthestMm));
  if (!first || std::abs(static_cast<double>(first->distance_mm) - distance) > 0.5) return std::nullopt;
  if (!has_room(scene, place)) return std::nullopt;
  return Pose<M, C>{.rotation = looking_along(-towards, random), .translation_mm = place};
}

}  // namespace

std::optional<Pose<M, C>> view_of_chance(const EvaluationScene& scene, RandomStream& random) {
  constexpr int kTries = 500;
  for (int i = 0; i < kTries; ++i)
    if (const auto view = try_view(scene, random)) return view;
  return std::nullopt;
}

std::optional<Landmark> landmark_at(const EvaluationScene& scene, const Pose<M, C>& X_MC,
                                    const Eigen::Vector2d& pixel) {
  const auto direction_C = direction_of(scene.scope.lens, pixel);
  if (!direction_C || direction_C->z() < std::cos(scene.scope.cone_half_angle_rad)) return std::nullopt;
  const Eigen::Vector3d direction = X_MC.rotation * *direction_C;
  const auto hit = scene.rays.nearest(X_MC.translation_mm.cast<float>(), direction.cast<float>(),
                                      static_cast<float>(scene.scope.far_mm / direction_C->z()));
  if (!hit) return std::nullopt;
  const Eigen::Vector3d normal = normal_of(scene, hit->triangle);
  if (-direction.dot(normal) < kCosMaxObliquity) return std::nullopt;
  return Landmark{.place_mm = X_MC.translation_mm + static_cast<double>(hit->distance_mm) * direction,
                  .normal = normal,
                  .pixel = pixel};
}

std::vector<Landmark> landmarks_of_chance(const EvaluationScene& scene, const Pose<M, C>& X_MC,
                                          std::size_t count, RandomStream& random) {
  std::vector<Landmark> landmarks;
  const CircularMask& mask = scene.scope.mask;
  const double radius_px = mask.radius_px - mask.soft_edge_px;
  for (std::size_t tries = 0; tries < 20 * count && landmarks.size() < count; ++tries) {
    const double radius = radius_px * std::sqrt(random.uniform()),
                 angle = 2 * std::numbers::pi * random.uniform();
    const Eigen::Vector2d pixel(
        mask.cx_px + radius * std::cos(angle),
        mask.cy_px + radius * std::sin(angle) * scene.scope.lens.fy_px / scene.scope.lens.fx_px);
    if (const auto landmark = landmark_at(scene, X_MC, pixel)) landmarks.push_back(*landmark);
  }
  return landmarks;
}

std::vector<Eigen::Vector3d> fiducials_of_chance(const EvaluationScene& scene, int count,
                                                 RandomStream& random) {
  Eigen::Vector3f low = scene.mesh.vertices_mm.front(), high = low;
  for (const auto& vertex : scene.mesh.vertices_mm) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  const Eigen::Vector3d centre = ((low + high) / 2).cast<double>();
  std::vector<Eigen::Vector3d> fiducials;
  for (int i = 0; i < count; ++i) {
    const double around = 2 * std::numbers::pi * (i + random.uniform()) / count,
                 height = random.between(0.1, 0.95), level = std::sqrt(1 - height * height);
    fiducials.push_back(
        centre + Eigen::Vector3d(75 * level * std::cos(around), 95 * level * std::sin(around), 85 * height));
  }
  return fiducials;
}

}  // namespace orcart
