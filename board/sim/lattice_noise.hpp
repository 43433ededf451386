// Noise in space, pure in the point and a seed: the raw material of simulated tissue and of the sensor's
// noise.
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace orcart {

/// A 32-bit hash whose bits are all worth using (the finaliser of MurmurHash3, Appleby 2011).
constexpr std::uint32_t hash32(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x85ebca6bU;
  x ^= x >> 13;
  x *= 0xc2b2ae35U;
  return x ^ (x >> 16);
}

/// Gradient noise (Perlin 2002) on the integer lattice: smooth, mean 0, within -1..1, features about one unit
/// wide.
float gradient_noise(const Eigen::Vector3f& point, std::uint32_t seed);

/// Sum of octaves, each of twice the frequency and half the height; within -1..1.
float fractal_noise(const Eigen::Vector3f& point, std::uint32_t seed, int octaves);

/// The nearest wall between the Voronoi cells of one jittered site per unit cube (Worley 1996; walls as
/// bisectors).
struct CellWall {
  float distance = 0;      ///< in lattice units, across the wall
  std::uint32_t name = 0;  ///< the same for all points beside the same wall
};
CellWall nearest_cell_wall(const Eigen::Vector3f& point, std::uint32_t seed);

}  // namespace orcart
