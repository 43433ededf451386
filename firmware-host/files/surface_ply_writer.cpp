// Surfaces out: binary little-endian PLY whose comments carry space and identity.
#include <algorithm>
#include <bit>
#include <cstring>

#include "firmware-host/files/surface_checks.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "firmware-host/files/vertex_normals.hpp"
#include "firmware-host/files/whole_file.hpp"

namespace orcart {

static_assert(std::endian::native == std::endian::little, "bytes are written as they lie in memory");

namespace {

std::string comment(const char* key, std::string value) {
  if (value.empty()) return "";
  std::replace_if(
      value.begin(), value.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return std::string("comment orcart ") + key + " " + value + "\n";
}

std::string header_of(const Surface& surface) {
  return "ply\nformat binary_little_endian 1.0\ncomment orcart surface, millimetres\ncomment SPACE=LPS\n" +
         comment("hash", checks::mesh_hash(surface.mesh)) + comment("series", surface.identity.series) +
         comment("frame_of_reference", surface.identity.frame_of_reference) + "element vertex " +
         std::to_string(surface.mesh.vertices_mm.size()) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float "
         "ny\nproperty float nz\nelement face " +
         std::to_string(surface.mesh.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

}  // namespace

Result<void> write_ply(const std::filesystem::path& file, const Surface& surface) {
  constexpr std::size_t kVertexBytes = 24, kPlaceBytes = 12, kFaceBytes = 13;
  const TriangleMesh& mesh = surface.mesh;
  std::string text = header_of(surface);
  std::size_t at = text.size();
  text.resize(at + mesh.vertices_mm.size() * kVertexBytes + mesh.triangles.size() * kFaceBytes);
  const std::vector<Eigen::Vector3f> normals = angle_weighted_normals(mesh);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    std::memcpy(text.data() + at, mesh.vertices_mm[v].data(), kPlaceBytes);
    std::memcpy(text.data() + at + kPlaceBytes, normals[v].data(), kPlaceBytes);
    at += kVertexBytes;
  }
  for (const auto& triangle : mesh.triangles) {
    text[at] = 3;
    std::memcpy(text.data() + at + 1, triangle.data(), kFaceBytes - 1);
    at += kFaceBytes;
  }
  return write_whole_file(file, text);
}

}  // namespace orcart
