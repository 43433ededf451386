// Making planes and spheres out of triangles.
#include "tests/render/support/test_surfaces.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <numbers>
#include <sstream>

namespace orcart::testing {

Surface plane_facing_origin(double size_mm, double z_mm, int cells) {
  Surface surface;
  const auto number = [cells](int x, int y) { return static_cast<std::uint32_t>(y * (cells + 1) + x); };
  for (int y = 0; y <= cells; ++y) {
    for (int x = 0; x <= cells; ++x) {
      const Eigen::Vector3d p(size_mm * (x / static_cast<double>(cells) - 0.5),
                              size_mm * (y / static_cast<double>(cells) - 0.5), z_mm);
      surface.mesh.vertices_mm.push_back(p.cast<float>());
    }
  }
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      surface.mesh.triangles.push_back({number(x, y), number(x, y + 1), number(x + 1, y)});
      surface.mesh.triangles.push_back({number(x + 1, y), number(x, y + 1), number(x + 1, y + 1)});
    }
  }
  return surface;
}

Surface sphere(double radius_mm, int rings, int segments) {
  Surface surface;
  surface.closed = true;
  auto& vertices = surface.mesh.vertices_mm;
  const auto on_sphere = [radius_mm](double polar, double azimuth) {
    return Eigen::Vector3d(radius_mm * std::sin(polar) * std::cos(azimuth),
                           radius_mm * std::sin(polar) * std::sin(azimuth), radius_mm * std::cos(polar))
        .cast<float>();
  };
  vertices.emplace_back(on_sphere(0, 0));
  for (int r = 1; r < rings; ++r)
    for (int s = 0; s < segments; ++s)
      vertices.emplace_back(on_sphere(std::numbers::pi * r / rings, 2 * std::numbers::pi * s / segments));
  vertices.emplace_back(on_sphere(std::numbers::pi, 0));
  const auto number = [segments](int r, int s) {
    return static_cast<std::uint32_t>(1 + (r - 1) * segments + s % segments);
  };
  const auto south = static_cast<std::uint32_t>(vertices.size() - 1);
  for (int s = 0; s < segments; ++s) {
    surface.mesh.triangles.push_back({0, number(1, s), number(1, s + 1)});
    for (int r = 1; r + 1 < rings; ++r) {
      surface.mesh.triangles.push_back({number(r, s), number(r + 1, s), number(r, s + 1)});
      surface.mesh.triangles.push_back({number(r, s + 1), number(r + 1, s), number(r + 1, s + 1)});
    }
    surface.mesh.triangles.push_back({number(rings - 1, s), south, number(rings - 1, s + 1)});
  }
  return surface;
}

Surface joined(const Surface& a, const Surface& b) {
  Surface both = a;
  const auto shift = static_cast<std::uint32_t>(a.mesh.vertices_mm.size());
  both.mesh.vertices_mm.insert(both.mesh.vertices_mm.end(), b.mesh.vertices_mm.begin(),
                               b.mesh.vertices_mm.end());
  for (const auto& t : b.mesh.triangles)
    both.mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return both;
}

Surface bench_surface(const std::string& path) {
  Surface surface;
  std::ifstream file(path, std::ios::binary);
  std::size_t vertices = 0, triangles = 0;
  for (std::string line; std::getline(file, line) && line != "end_header";) {
    std::istringstream words(line);
    std::string element, kind;
    std::size_t count = 0;
    words >> element >> kind >> count;
    if (element == "element") (kind == "vertex" ? vertices : triangles) = count;
  }
  surface.mesh.vertices_mm.resize(vertices);
  file.read(reinterpret_cast<char*>(surface.mesh.vertices_mm.data()),
            static_cast<std::streamsize>(vertices * 12));
  for (std::size_t i = 0; i < triangles && file; ++i) {
    char record[13];
    if (!file.read(record, sizeof record)) break;
    std::memcpy(surface.mesh.triangles.emplace_back().data(), record + 1, 12);
  }
  surface.closed = true;
  return surface;
}

}  // namespace orcart::testing
