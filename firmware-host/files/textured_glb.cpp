// One buffer: positions, normals, places in the picture, indices, the picture.
#include "firmware-host/files/textured_glb.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "firmware-host/files/surface_checks.hpp"
#include "firmware-host/files/textured_split.hpp"
#include "firmware-host/files/vertex_normals.hpp"

namespace orcart {
namespace {

constexpr int kFloat = 5126, kUnsignedInt = 5125, kVertices = 34962, kIndices = 34963;

struct GlbMesh {
  std::vector<Eigen::Vector3f> positions_mm, normals;
  std::vector<Eigen::Vector2f> places;  ///< origin top left
  std::vector<std::uint32_t> indices;
};

GlbMesh glb_mesh(const TexturedSurface& textured) {
  const TriangleMesh& mesh = textured.surface.mesh;
  SplitSurface split = split_along_seams(textured);
  const std::vector<Eigen::Vector3f> normals = angle_weighted_normals(mesh);
  GlbMesh out;
  for (const std::uint32_t vertex : split.vertex_of) {
    out.positions_mm.push_back(mesh.vertices_mm[vertex]);
    out.normals.push_back(normals[vertex]);
  }
  for (const Eigen::Vector2f& place : split.places) out.places.emplace_back(place.x(), 1 - place.y());
  out.indices = std::move(split.indices);
  return out;
}

/// The binary chunk, and what the text says of its parts.
class Chunk {
 public:
  void add(std::string_view bytes, int target = 0) {
    if (!views_.empty()) views_ += ',';
    views_ += R"({"buffer":0,"byteOffset":)" + std::to_string(bytes_.size()) + R"(,"byteLength":)" +
              std::to_string(bytes.size());
    if (target != 0) views_ += R"(,"target":)" + std::to_string(target);
    views_ += '}';
    bytes_ += bytes;
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
  }
  template <class Value>
  void add_array(const std::vector<Value>& values, int target) {
    add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)}, target);
  }
  const std::string& bytes() const { return bytes_; }
  const std::string& views() const { return views_; }

 private:
  std::string bytes_, views_;
};

std::string json_text(std::string_view words) {
  std::string out = "\"";
  for (const char c : words) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return out + '"';
}

std::string json_point(const Eigen::Vector3f& p) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "[%.9g,%.9g,%.9g]", static_cast<double>(p.x()),
                static_cast<double>(p.y()), static_cast<double>(p.z()));
  return text.data();
}

std::string accessor(int view, int component, std::size_t count, const char* type,
                     const std::string& more = "") {
  return R"({"bufferView":)" + std::to_string(view) + R"(,"componentType":)" + std::to_string(component) +
         R"(,"count":)" + std::to_string(count) + R"(,"type":")" + type + '"' + more + '}';
}

std::string description(const TexturedSurface& textured, const GlbMesh& mesh, const Chunk& chunk) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : mesh.positions_mm) box.extend(p);
  const SurfaceIdentity& identity = textured.surface.identity;
  const std::size_t vertices = mesh.positions_mm.size();
  return R"({"asset":{"version":"2.0","generator":"orcart","extras":{"vertices":"millimetres, LPS","hash":)" +
         json_text(checks::mesh_hash(textured.surface.mesh)) + R"(,"series":)" + json_text(identity.series) +
         R"(,"frame_of_reference":)" + json_text(identity.frame_of_reference) +
         R"(}},"scene":0,"scenes":[{"nodes":[0]}],)"
         R"("nodes":[{"name":"painted surface","mesh":0,"scale":[0.001,0.001,0.001],)"
         R"("rotation":[-0.70710678118654752,0,0,0.70710678118654752]}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2},"indices":3,"material":0}]}],)"
         R"("materials":[{"name":"painted","doubleSided":true,"pbrMetallicRoughness":{"baseColorTexture":{"index":0},)"
         R"("metallicFactor":0,"roughnessFactor":1}}],)"
         R"("textures":[{"source":0,"sampler":0}],"images":[{"bufferView":4,"mimeType":"image/png"}],)"
         R"("samplers":[{"magFilter":9729,"minFilter":9729,"wrapS":33071,"wrapT":33071}],"accessors":[)" +
         accessor(0, kFloat, vertices, "VEC3",
                  R"(,"min":)" + json_point(box.min()) + R"(,"max":)" + json_point(box.max())) +
         ',' + accessor(1, kFloat, vertices, "VEC3") + ',' + accessor(2, kFloat, vertices, "VEC2") + ',' +
         accessor(3, kUnsignedInt, mesh.indices.size(), "SCALAR") + R"(],"bufferViews":[)" + chunk.views() +
         R"(],"buffers":[{"byteLength":)" + std::to_string(chunk.bytes().size()) + "}]}";
}

void append_word(std::string& bytes, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  std::array<char, 4> raw{};
  std::memcpy(raw.data(), &word, raw.size());
  bytes.append(raw.data(), raw.size());
}

}  // namespace

std::string glb_bytes(const TexturedSurface& textured, std::string_view png) {
  const GlbMesh mesh = glb_mesh(textured);
  Chunk chunk;
  chunk.add_array(mesh.positions_mm, kVertices);
  chunk.add_array(mesh.normals, kVertices);
  chunk.add_array(mesh.places, kVertices);
  chunk.add_array(mesh.indices, kIndices);
  chunk.add(png);
  std::string text = description(textured, mesh, chunk);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  append_word(bytes, 2);
  append_word(bytes, 12 + 8 + text.size() + 8 + chunk.bytes().size());
  append_word(bytes, text.size());
  bytes += "JSON" + text;
  append_word(bytes, chunk.bytes().size());
  bytes.append("BIN\0", 4);
  return bytes + chunk.bytes();
}

}  // namespace orcart
