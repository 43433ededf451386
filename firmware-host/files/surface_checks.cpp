// The checks of a surface, each one pass over its triangles.
#include "firmware-host/files/surface_checks.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <span>

#include <Eigen/Geometry>

namespace orcart::checks {

namespace {

/// One 64-bit lane of the hash: multiply and fold, a word at a time.
std::uint64_t mix(std::uint64_t state, std::uint64_t word) {
  const auto product = static_cast<unsigned __int128>(state ^ word) * 0x9E3779B97F4A7C15U;
  return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64U);
}

}  // namespace

std::size_t drop_degenerate_triangles(TriangleMesh& mesh) {
  return std::erase_if(mesh.triangles, [&](const std::array<std::uint32_t, 3>& t) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
    const Eigen::Vector3d a = mesh.vertices_mm[t[0]].cast<double>();
    const Eigen::Vector3d ab = mesh.vertices_mm[t[1]].cast<double>() - a;
    const Eigen::Vector3d ac = mesh.vertices_mm[t[2]].cast<double>() - a;
    return ab.cross(ac).squaredNorm() == 0.0;
  });
}

std::size_t unpaired_edges(const TriangleMesh& mesh) {
  struct Side {
    std::uint64_t edge;  ///< the lower vertex above the higher one
    bool upwards;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint64_t a = t[i], b = t[(i + 1) % 3];
      sides.push_back({.edge = std::min(a, b) << 32U | std::max(a, b), .upwards = a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.edge < b.edge; });
  std::size_t unpaired = 0;
  for (std::size_t i = 0, next = 0; i < sides.size(); i = next) {
    while (next < sides.size() && sides[next].edge == sides[i].edge) ++next;
    const bool pair = next == i + 2 && sides[i].upwards != sides[i + 1].upwards;
    unpaired += pair ? 0 : 1;
  }
  return unpaired;
}

bool is_closed(const TriangleMesh& mesh) {
  return unpaired_edges(mesh) == 0;
}

double signed_volume_mm3(const TriangleMesh& mesh) {
  double six_volumes = 0;
  for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices_mm[t[0]].cast<double>(),
                          b = mesh.vertices_mm[t[1]].cast<double>();
    six_volumes += a.dot(b.cross(mesh.vertices_mm[t[2]].cast<double>()));
  }
  return six_volumes / 6;
}

std::string mesh_hash(const TriangleMesh& mesh) {
  std::uint64_t low = mesh.vertices_mm.size(), high = ~static_cast<std::uint64_t>(mesh.triangles.size());
  const auto take = [&](const void* words) {
    std::array<std::uint32_t, 3> three{};
    std::memcpy(three.data(), words, sizeof three);
    for (const std::uint32_t word : three) {
      low = mix(low, word);
      high = mix(high, word + 0xD1B54A32D192ED03U);
    }
  };
  for (const auto& vertex : mesh.vertices_mm) take(vertex.data());
  for (const auto& triangle : mesh.triangles) take(triangle.data());
  std::array<char, 33> hex{};
  std::snprintf(hex.data(), hex.size(), "%016llx%016llx", static_cast<unsigned long long>(high),
                static_cast<unsigned long long>(low));
  return hex.data();
}

}  // namespace orcart::checks
