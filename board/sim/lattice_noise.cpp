// Gradient noise and Voronoi walls on a hashed integer lattice; the same on every machine.
#include "board/sim/lattice_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace orcart {
namespace {

std::uint32_t hash_cell(const Eigen::Vector3i& cell, std::uint32_t seed) {
  return hash32(static_cast<std::uint32_t>(cell.x()) * 0x8da6b343U +
                static_cast<std::uint32_t>(cell.y()) * 0xd8163841U +
                static_cast<std::uint32_t>(cell.z()) * 0xcb1ab31fU + seed * 0x9e3779b9U);
}

/// One of the twelve edge directions of a cube, times the offset.
float lean(std::uint32_t hash, const Eigen::Vector3f& offset) {
  const std::uint32_t h = hash & 15U;
  const float u = h < 8 ? offset.x() : offset.y();
  const float v = h < 4 ? offset.y() : (h == 12 || h == 14 ? offset.x() : offset.z());
  return ((h & 1U) != 0 ? -u : u) + ((h & 2U) != 0 ? -v : v);
}

float fade(float t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

Eigen::Vector3i cell_of(const Eigen::Vector3f& point) {
  return point.array().floor().cast<int>();
}

Eigen::Vector3f site_in(const Eigen::Vector3i& cell, std::uint32_t seed) {
  const std::uint32_t h = hash_cell(cell, seed), g = hash32(h ^ 0x68bc21ebU);
  const Eigen::Vector3f jitter(static_cast<float>(h & 0xffffU), static_cast<float>(h >> 16),
                               static_cast<float>(g & 0xffffU));
  return cell.cast<float>() + jitter / 65536.0F;
}

struct Site {
  Eigen::Vector3f at;
  Eigen::Vector3i cell;
};

}  // namespace

float gradient_noise(const Eigen::Vector3f& point, std::uint32_t seed) {
  const Eigen::Vector3i cell = cell_of(point);
  const Eigen::Vector3f f = point - cell.cast<float>();
  const Eigen::Vector3f w(fade(f.x()), fade(f.y()), fade(f.z()));
  float corner[2][2][2];
  for (int x = 0; x < 2; ++x)
    for (int y = 0; y < 2; ++y)
      for (int z = 0; z < 2; ++z) {
        const Eigen::Vector3i step(x, y, z);
        corner[x][y][z] = lean(hash_cell(cell + step, seed), f - step.cast<float>());
      }
  float across[2];
  for (int x = 0; x < 2; ++x) {
    const float low = std::lerp(corner[x][0][0], corner[x][0][1], w.z());
    across[x] = std::lerp(low, std::lerp(corner[x][1][0], corner[x][1][1], w.z()), w.y());
  }
  return std::lerp(across[0], across[1], w.x());
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
  std::size_t nearest = 0;
  float best = 1e9F;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const int n = static_cast<int>(i);
    const Eigen::Vector3i cell = home + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    sites[i] = {.at = site_in(cell, seed), .cell = cell};
    const float distance = (sites[i].at - point).squaredNorm();
    if (distance < best) {
      best = distance;
      nearest = i;
    }
  }
  CellWall wall{.distance = 1e9F};
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (i == nearest) continue;
    const Eigen::Vector3f across = sites[i].at - sites[nearest].at;
    const float distance = (0.5F * (sites[i].at + sites[nearest].at) - point).dot(across.normalized());
    if (distance >= wall.distance) continue;
    wall.distance = distance;
    wall.name = hash_cell(sites[i].cell, seed) ^ hash_cell(sites[nearest].cell, seed);
  }
  return wall;
}

}  // namespace orcart
