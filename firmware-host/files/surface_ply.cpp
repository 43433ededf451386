// PLY (Turk 1994): ascii and binary of either byte order, any order of properties, unknown ones skipped.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "firmware-host/files/ply_body.hpp"
#include "firmware-host/files/ply_header.hpp"
#include "firmware-host/files/surface_formats.hpp"
#include "firmware-host/files/vertex_merger.hpp"

namespace orcart {

namespace {

std::string plain(double number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.12g", number);
  return text.data();
}

class PlyParser {
 public:
  PlyParser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Result<ParsedSurface> parse() {
    auto header = read_ply_header(text_, name_, surface_);
    if (!header) return tl::unexpected(header.error());
    header_ = *std::move(header);
    PlyBody body(text_.substr(header_.body_at), header_.encoding);
    for (const PlyElement& element : header_.elements) {
      if (auto read = read_element(element, body); !read) return tl::unexpected(read.error());
    }
    if (normals_.size() == surface_.mesh.vertices_mm.size())
      surface_.normals = vote_on_winding(surface_.mesh, normals_);
    if (has_seam_) return joined_along_seam();
    if (is_split_) merge_equal_vertices(surface_.mesh);
    return std::move(surface_);
  }

 private:
  Result<void> read_element(const PlyElement& element, PlyBody& body) {
    const std::size_t least = least_bytes(element, header_.encoding);
    const std::string said =
        "its header says " + std::to_string(element.count) + " of element " + element.name;
    const bool faces = element.name == "face", vertices = element.name == "vertex";
    const std::size_t most = faces ? kLargestTriangleCount : kLargestVertexCount;
    if ((faces || vertices) && element.count > most)
      return fail(name_ + ": " + said + "; up to " + std::to_string(most) + " are accepted");
    has_seam_ = has_seam_ || is_seam(element);
    if (least == 0) return {};
    if (element.count > body.left() / least + 1)
      return fail(name_ + ": " + said + ", but only " + std::to_string(body.left()) +
                  " bytes follow; the file is cut short");
    if (vertices) return read_vertices(element, body);
    if (faces) return read_faces(element, body);
    if (is_seam(element)) return read_seam(element, body);
    return skip(element, body);
  }

  Result<void> cut_short(const PlyElement& element, std::uint64_t record, const PlyBody& body) const {
    if (body.ascii() && body.left() > 0)
      return fail(name_ + ":" + std::to_string(header_.line_count + body.line_number() + 1) + ": " +
                  element.name + " " + std::to_string(record) +
                  " holds a word that is no number; a number is expected");
    return fail(name_ + ": ends within " + element.name + " " + std::to_string(record) + " of " +
                std::to_string(element.count) + "; the file is cut short");
  }

  static bool skip_property(const PlyProperty& property, PlyBody& body) {
    std::uint64_t count = 1;
    if (property.count_type) {
      const auto said = body.next(*property.count_type);
      if (!said || !(*said >= 0) || *said > static_cast<double>(body.left())) return false;
      count = static_cast<std::uint64_t>(*said);
    }
    for (std::uint64_t i = 0; i < count; ++i)
      if (!body.next(property.type)) return false;
    return true;
  }

  Result<void> skip(const PlyElement& element, PlyBody& body) {
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties)
        if (!skip_property(property, body)) return cut_short(element, i, body);
    return {};
  }

  /// Of a painted surface of our own: the vertices at the end repeat others, one record each says which.
  static bool is_seam(const PlyElement& element) {
    return element.name == "seam" && element.properties.size() == 1 &&
           element.properties[0].name == "vertex" && !element.properties[0].count_type;
  }

  Result<void> read_seam(const PlyElement& element, PlyBody& body) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const auto vertex = body.next(element.properties[0].type);
      if (!vertex) return cut_short(element, i, body);
      if (!(*vertex >= 0 && *vertex < static_cast<double>(kLargestVertexCount)))
        return fail(name_ + ": its seam repeats vertex " + plain(*vertex) + ", which is not there");
      repeated_.push_back(static_cast<std::uint32_t>(*vertex));
    }
    return {};
  }

  Result<ParsedSurface> joined_along_seam() {
    TriangleMesh& mesh = surface_.mesh;
    const std::size_t own = mesh.vertices_mm.size() - std::min(mesh.vertices_mm.size(), repeated_.size());
    for (const std::uint32_t vertex : repeated_)
      if (vertex >= own)
        return fail(name_ + ": its seam repeats vertex " + std::to_string(vertex) + " of " +
                    std::to_string(own) + "; it was changed after it was written, so export it again");
    for (auto& triangle : mesh.triangles)
      for (std::uint32_t& corner : triangle)
        if (corner >= own) corner = repeated_[corner - own];
    mesh.vertices_mm.resize(own);
    return std::move(surface_);
  }

  static int normal_axis(const std::string& name) {
    return name == "nx" ? 3 : name == "ny" ? 4 : name == "nz" ? 5 : -1;
  }

  Result<void> read_vertices(const PlyElement& element, PlyBody& body) {
    std::vector<int> axis_of;  // 0 to 2 a place's, 3 to 5 a normal's
    unsigned axes = 0;
    bool has_normals = false;
    for (const PlyProperty& property : element.properties) {
      const int axis = property.count_type || property.name.size() != 1 ? -1 : property.name[0] - 'x';
      const bool known = axis >= 0 && axis < 3;
      axis_of.push_back(known ? axis : property.count_type ? -1 : normal_axis(property.name));
      has_normals = has_normals || axis_of.back() == 3;
      is_split_ = is_split_ || property.name == "texture_u" || property.name == "u" || property.name == "s";
      if (known) axes |= 1U << static_cast<unsigned>(axis);
    }
    if (axes != 7) return fail(name_ + ": its vertices lack x, y or z; all three are expected");
    surface_.mesh.vertices_mm.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      std::array<float, 6> numbers{};
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        if (axis_of[p] < 0) {
          if (!skip_property(property, body)) return cut_short(element, i, body);
          continue;
        }
        const auto value = body.next(property.type);
        if (!value) return cut_short(element, i, body);
        numbers[static_cast<std::size_t>(axis_of[p])] = static_cast<float>(*value);
      }
      surface_.mesh.vertices_mm.emplace_back(numbers[0], numbers[1], numbers[2]);
      if (has_normals) normals_.emplace_back(numbers[3], numbers[4], numbers[5]);
    }
    return {};
  }

  Result<void> read_faces(const PlyElement& element, PlyBody& body) {
    const auto is_corners = [](const PlyProperty& p) {
      return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::none_of(element.properties.begin(), element.properties.end(), is_corners))
      return fail(name_ + ": its faces lack the list vertex_indices; it is expected");
    surface_.mesh.triangles.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        if (!is_corners(property)) {
          if (!skip_property(property, body)) return cut_short(element, i, body);
        } else if (auto read = read_corners(element, i, property, body); !read) {
          return read;
        }
      }
    }
    return {};
  }

  Result<void> read_corners(const PlyElement& element, std::uint64_t face, const PlyProperty& property,
                            PlyBody& body) {
    const auto count = body.next(*property.count_type);
    if (!count) return cut_short(element, face, body);
    if (!(*count >= 3 && *count <= kLargestPolygon))
      return fail(name_ + ": face " + std::to_string(face) + " has " + plain(*count) + " corners; 3 to " +
                  std::to_string(kLargestPolygon) + " are accepted");
    corners_.clear();
    for (int i = 0; i < static_cast<int>(*count); ++i) {
      const auto index = body.next(property.type);
      if (!index) return cut_short(element, face, body);
      const std::size_t vertices = surface_.mesh.vertices_mm.size();
      if (!(*index >= 0 && *index < static_cast<double>(vertices) && std::floor(*index) == *index))
        return fail(name_ + ": face " + std::to_string(face) + " has vertex " + plain(*index) +
                    "; whole numbers below " + std::to_string(vertices) + " are accepted");
      corners_.push_back(static_cast<std::uint32_t>(*index));
    }
    append_polygon(corners_, surface_.mesh.vertices_mm.size(), surface_.mesh);
    if (surface_.mesh.triangles.size() > kLargestTriangleCount)
      return fail(name_ + ": has more than " + std::to_string(kLargestTriangleCount) +
                  " triangles; up to that many are accepted");
    return {};
  }

  static constexpr int kLargestPolygon = 255;
  std::string_view text_;
  const std::string& name_;
  PlyHeader header_;
  ParsedSurface surface_;
  std::vector<std::uint32_t> corners_;
  std::vector<Eigen::Vector3f> normals_;
  std::vector<std::uint32_t> repeated_;
  bool has_seam_ = false;
  bool is_split_ = false;  ///< vertices hold places in a picture, and are repeated along its seams
};

}  // namespace

Result<ParsedSurface> parse_ply(std::span<const std::byte> bytes, const std::string& name) {
  return PlyParser({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name).parse();
}

}  // namespace orcart
