// The checks of a surface, each one pass over its triangles.
#include "firmware-host/files/surface_checks.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

namespace orcart::checks {

namespace {

/// One 64-bit lane of the hash: multiply and fold, a word at a time.
std::uint64_t mix(std::uint64_t state, std::uint64_t word) {
  const auto product = static_cast<unsigned __int128>(state ^ word) * 0x9E3779B97F4A7C15U;
  return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64U);
}

using Corners = std::array<std::uint32_t, 3>;

bool repeats_a_vertex(const Corners& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

Eigen::Vector3d normal_of(const TriangleMesh& mesh, const Corners& t) {
  const Eigen::Vector3d a = mesh.vertices_mm[t[0]].cast<double>();
  const Eigen::Vector3d ab = mesh.vertices_mm[t[1]].cast<double>() - a;
  const Eigen::Vector3d ac = mesh.vertices_mm[t[2]].cast<double>() - a;
  return ab.cross(ac);
}

/// The triangle at each side, by its two ends in the triangle's order.
class Sides {
 public:
  explicit Sides(const TriangleMesh& mesh) {
    side_.reserve(3 * mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      if (!repeats_a_vertex(mesh.triangles[t])) add(mesh.triangles[t], t);
  }
  void add(const Corners& corners, std::uint32_t t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [at, fresh] = side_.try_emplace(key(corners[i], corners[(i + 1) % 3]), t);
      if (!fresh) at->second = kSeveral;
    }
  }
  void remove(const Corners& corners) {
    for (std::size_t i = 0; i < 3; ++i) side_.erase(key(corners[i], corners[(i + 1) % 3]));
  }
  bool has(std::uint32_t a, std::uint32_t b) const { return side_.contains(key(a, b)); }
  /// Nothing where there is none or there are several.
  std::optional<std::uint32_t> only(std::uint32_t a, std::uint32_t b) const {
    const auto at = side_.find(key(a, b));
    return at == side_.end() || at->second == kSeveral ? std::nullopt : std::optional{at->second};
  }

 private:
  static constexpr std::uint32_t kSeveral = ~std::uint32_t{0};
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32U | b; }
  std::unordered_map<std::uint64_t, std::uint32_t> side_;
};

/// The triangle p q m, whose m lies between p and q, and its neighbour q p d become m p d and q m d.
bool flip(TriangleMesh& mesh, Sides& sides, std::uint32_t sliver) {
  const Corners t = mesh.triangles[sliver];
  std::size_t longest = 0;
  double longest_mm2 = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length_mm2 =
        static_cast<double>((mesh.vertices_mm[t[(i + 1) % 3]] - mesh.vertices_mm[t[i]]).squaredNorm());
    if (length_mm2 > longest_mm2) longest = i, longest_mm2 = length_mm2;
  }
  const std::uint32_t p = t[longest], q = t[(longest + 1) % 3], m = t[(longest + 2) % 3];
  const auto neighbour = sides.only(q, p);
  if (!neighbour || !sides.only(p, q)) return false;
  const Corners n = mesh.triangles[*neighbour];
  const std::uint32_t d =
      *std::find_if(n.begin(), n.end(), [&](std::uint32_t v) { return v != p && v != q; });
  if (d == m || sides.has(m, d) || sides.has(d, m)) return false;
  const Corners first = {m, p, d}, second = {q, m, d};
  const Eigen::Vector3d facing = normal_of(mesh, n);
  if (!(normal_of(mesh, first).dot(facing) > 0 && normal_of(mesh, second).dot(facing) > 0)) return false;
  sides.remove(t);
  sides.remove(n);
  sides.add(first, sliver);
  sides.add(second, *neighbour);
  mesh.triangles[sliver] = first;
  mesh.triangles[*neighbour] = second;
  return true;
}

}  // namespace

std::size_t flip_slivers(TriangleMesh& mesh) {
  std::vector<std::uint32_t> slivers;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (!repeats_a_vertex(mesh.triangles[t]) && normal_of(mesh, mesh.triangles[t]).squaredNorm() == 0.0)
      slivers.push_back(t);
  if (slivers.empty()) return 0;
  Sides sides(mesh);
  const std::size_t found = slivers.size();
  for (std::size_t before = found + 1;
       !slivers.empty() && slivers.size() < before;) {  // one may wait for another
    before = slivers.size();
    std::erase_if(slivers, [&](std::uint32_t t) { return flip(mesh, sides, t); });
  }
  return found - slivers.size();
}

std::size_t drop_degenerate_triangles(TriangleMesh& mesh) {
  return std::erase_if(mesh.triangles, [&](const Corners& t) {
    return repeats_a_vertex(t) || normal_of(mesh, t).squaredNorm() == 0.0;
  });
}

std::size_t unpaired_edges(const TriangleMesh& mesh) {
  struct Side {
    std::uint64_t edge;  ///< the lower vertex above the higher one
    bool upwards;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (const Corners& t : mesh.triangles)
    for (std::size_t i = 0; i < 3 && !repeats_a_vertex(t); ++i) {
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
