// Gradient noise and Voronoi walls on a hashed integer lattice; the same on every machine.
#include "board/sim/lattice_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace orcart {
namespace {

constexpr std::uint32_t kStepX = 0x8da6b343U, kStepY = 0xd8163841U, kStepZ = 0xcb1ab31fU;

/// Sums that name a cell: neighbours differ by the steps above, which spares most of the multiplications.
std::uint32_t cell_sum(const Eigen::Vector3i& cell, std::uint32_t seed) {
  return static_cast<std::uint32_t>(cell.x()) * kStepX + static_cast<std::uint32_t>(cell.y()) * kStepY +
         static_cast<std::uint32_t>(cell.z()) * kStepZ + seed * 0x9e3779b9U;
}

/// The twelve edge directions of a cube, four of them twice.
constexpr std::int8_t kEdges[16][3] = {
    {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
    {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}, {1, 1, 0}, {0, -1, 1}, {-1, 1, 0}, {0, -1, -1}};

float lean(std::uint32_t sum, float x, float y, float z) {
  const auto& edge = kEdges[hash32(sum) & 15U];
  return edge[0] * x + edge[1] * y + edge[2] * z;
}

float fade(float t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

Eigen::Vector3i cell_of(const Eigen::Vector3f& point) {
  return point.array().floor().cast<int>();
}

struct Site {
  Eigen::Vector3f at;
  std::uint32_t hash = 0;
};

Site site_in(const Eigen::Vector3i& cell, std::uint32_t seed) {
  const std::uint32_t h = hash32(cell_sum(cell, seed)), g = hash32(h ^ 0x68bc21ebU);
  const Eigen::Vector3f jitter(static_cast<float>(h & 0xffffU), static_cast<float>(h >> 16),
                               static_cast<float>(g & 0xffffU));
  return {.at = cell.cast<float>() + jitter / 65536.0F, .hash = h};
}

}  // namespace

float gradient_noise(const Eigen::Vector3f& point, std::uint32_t seed) {
  const Eigen::Vector3i cell = cell_of(point);
  const Eigen::Vector3f f = point - cell.cast<float>();
  const std::uint32_t sum = cell_sum(cell, seed);
  const float u = fade(f.x()), v = fade(f.y()), w = fade(f.z());
  const auto along_z = [&](std::uint32_t at, float x, float y) {
    const float low = lean(at, x, y, f.z()), high = lean(at + kStepZ, x, y, f.z() - 1);
    return low + w * (high - low);
  };
  const auto along_y = [&](std::uint32_t at, float x) {
    const float low = along_z(at, x, f.y()), high = along_z(at + kStepY, x, f.y() - 1);
    return low + v * (high - low);
  };
  const float low = along_y(sum, f.x()), high = along_y(sum + kStepX, f.x() - 1);
  return low + u * (high - low);
}

float fractal_noise(const Eigen::Vector3f& point, std::uint32_t seed, int octaves) {
  float sum = 0, height = 0.5F, scale = 1;
  for (int i = 0; i < octaves; ++i, height *= 0.5F, scale *= 2)
    sum += height * gradient_noise(point * scale, seed + static_cast<std::uint32_t>(i));
  return sum;
}

CellWall nearest_cell_wall(const Eigen::Vector3f& point, std::uint32_t seed) {
  const Eigen::Vector3i home = cell_of(point);
  std::array<Site, 27> sites;
  std::array<float, 27> distances;
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const int n = static_cast<int>(i);
    const Eigen::Vector3i cell = home + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    sites[i] = site_in(cell, seed);
    distances[i] = (sites[i].at - point).norm();
    if (distances[i] < distances[nearest]) nearest = i;
  }
  CellWall wall{.distance = 1e9F};
  for (std::size_t i = 0; i < sites.size(); ++i) {
    // The bisector is at least half the difference of the distances away.
    if (i == nearest || 0.5F * (distances[i] - distances[nearest]) >= wall.distance) continue;
    const Eigen::Vector3f across = sites[i].at - sites[nearest].at;
    const float distance = (0.5F * (sites[i].at + sites[nearest].at) - point).dot(across.normalized());
    if (distance >= wall.distance) continue;
    wall.distance = distance;
    wall.name = sites[i].hash ^ sites[nearest].hash;
  }
  return wall;
}

}  // namespace orcart
