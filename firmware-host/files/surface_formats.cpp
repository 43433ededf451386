// What the surface formats share: the words in comments, and polygons.
#include "firmware-host/files/surface_formats.hpp"

#include <algorithm>
#include <vector>

#include <Eigen/Geometry>

#include "firmware-host/files/text_cursor.hpp"

namespace orcart {

namespace {

constexpr std::size_t kMostClipped = 1000;  ///< corners; each ear takes a pass over all

/// Two axes in the plane that a polygon lies in by its mean normal (Newell; Sutherland et al. 1974),
/// counter-clockwise as the polygon runs.
struct Plane {
  Eigen::Vector3d x = Eigen::Vector3d::Zero(), y = Eigen::Vector3d::Zero();
  Eigen::Vector2d place_of(const Eigen::Vector3f& vertex) const {
    const Eigen::Vector3d v = vertex.cast<double>();
    return {x.dot(v), y.dot(v)};
  }
};

Plane mean_plane(std::span<const std::uint32_t> corners, const TriangleMesh& mesh) {
  const Eigen::Vector3d origin = mesh.vertices_mm[corners[0]].cast<double>();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i)
    normal += (mesh.vertices_mm[corners[i - 1]].cast<double>() - origin)
                  .cross(mesh.vertices_mm[corners[i]].cast<double>() - origin);
  Plane plane;
  if (!(normal.norm() > 0) || !normal.allFinite()) return plane;
  plane.x = normal.unitOrthogonal();
  plane.y = normal.normalized().cross(plane.x);
  return plane;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// By more than rounding.
bool turns_left(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d in = b - a, out = c - b;
  return cross(in, out) > 1e-6 * in.norm() * out.norm();
}

/// Whether a corner lies within a triangle or on its sides; one that stands on a corner of it does not.
bool holds(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
           const Eigen::Vector2d& p) {
  if (p == a || p == b || p == c) return false;
  return cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0;
}

}  // namespace

void take_comment(std::string_view comment, ParsedSurface& surface) {
  constexpr std::string_view kSpace = "SPACE=";
  if (const auto at = comment.find(kSpace); at != std::string_view::npos) {
    const std::string_view rest = comment.substr(at + kSpace.size());
    const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
    const auto end = std::find_if_not(rest.begin(), rest.end(), is_letter);
    surface.space.emplace(rest.begin(), end);
  }
  TextCursor words(comment);
  if (words.word() != "orcart") return;
  const std::string_view key = words.word();
  std::string_view value = comment.substr(words.place());
  value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
  if (key == "hash") surface.stated.hash = value;
  if (key == "series") surface.stated.series = value;
  if (key == "frame_of_reference") surface.stated.frame_of_reference = value;
}

bool append_polygon(std::span<const std::uint32_t> corners, std::size_t vertex_count, TriangleMesh& mesh) {
  if (std::any_of(corners.begin(), corners.end(), [&](std::uint32_t i) { return i >= vertex_count; }))
    return false;
  std::vector<std::uint32_t> left(corners.begin(), corners.end());
  const Plane plane = left.size() > 3 ? mean_plane(left, mesh) : Plane{};
  const auto place = [&](std::size_t i) { return plane.place_of(mesh.vertices_mm[left[i]]); };
  while (left.size() > 3 && left.size() <= kMostClipped) {
    const std::size_t count = left.size();
    bool all_agree = true;
    std::size_t ear = count;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t before = (i + count - 1) % count, after = (i + 1) % count;
      const Eigen::Vector2d a = place(before), b = place(i), c = place(after);
      if (!turns_left(a, b, c)) {
        all_agree = false;
        continue;
      }
      if (ear < count) continue;
      bool empty = true;
      for (std::size_t other = 0; other < count && empty; ++other)
        empty = other == before || other == i || other == after || !holds(a, b, c, place(other));
      if (empty) ear = i;
    }
    if (all_agree || ear == count) break;
    mesh.triangles.push_back({left[(ear + count - 1) % count], left[ear], left[(ear + 1) % count]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  for (std::size_t i = 2; i < left.size(); ++i) mesh.triangles.push_back({left[0], left[i - 1], left[i]});
  return true;
}

}  // namespace orcart
