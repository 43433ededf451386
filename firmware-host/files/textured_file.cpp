// Painted surfaces out: all files of a set are made in a folder beside, then renamed into place.
#include "firmware-host/files/textured_file.hpp"

#include <unistd.h>

#include <bit>
#include <charconv>
#include <string>
#include <vector>

#include "firmware-host/files/picture_file.hpp"
#include "firmware-host/files/surface_checks.hpp"
#include "firmware-host/files/textured_glb.hpp"
#include "firmware-host/files/textured_split.hpp"
#include "firmware-host/files/vertex_normals.hpp"
#include "firmware-host/files/whole_file.hpp"

namespace orcart {

static_assert(std::endian::native == std::endian::little, "bytes are written as they lie in memory");

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestLinkedBytes = std::uintmax_t{2} << 30U;

/// Files that appear together. What was staged and not published goes with it.
class FileSet {
 public:
  explicit FileSet(const fs::path& leader) : target_(leader.parent_path()) {
    staging_ = target_ / ("." + leader.filename().string() + ".part-" + std::to_string(::getpid()));
  }
  ~FileSet() {
    std::error_code ignored;
    fs::remove_all(staging_, ignored);
  }
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  Result<void> begin() const {
    std::error_code error;
    fs::create_directory(staging_, error);
    if (error) return fail(staging_.string() + ": cannot be made: " + error.message());
    return {};
  }
  /// Where a file is to be written; it will be renamed in the order of these calls.
  fs::path add(const std::string& name) {
    names_.push_back(name);
    return scratch(name);
  }
  /// Where a file is to be written that only helps to make the others.
  fs::path scratch(const std::string& name) const { return staging_ / name; }
  Result<void> publish() const {
    for (const std::string& name : names_) {
      if (fs::is_directory(target_ / name))
        return fail((target_ / name).string() + ": is a folder; a file's name is expected");
      if (fs::exists(target_ / name) && !fs::is_regular_file(target_ / name))
        return fail((target_ / name).string() + ": is a device or a pipe; a file's name is expected");
    }
    for (const std::string& name : names_) {
      std::error_code error;
      if (fs::is_symlink(target_ / name)) {  // it may lead to another file system, which no rename reaches
        const auto bytes = read_whole_file(staging_ / name, kLargestLinkedBytes);
        if (!bytes) return tl::unexpected(bytes.error());
        if (auto written = write_whole_file(target_ / name, *bytes); !written) return written;
        continue;
      }
      fs::rename(staging_ / name, target_ / name, error);
      if (error) return fail((target_ / name).string() + ": cannot be written: " + error.message());
    }
    return {};
  }

 private:
  fs::path target_, staging_;
  std::vector<std::string> names_;
};

void append(std::string& text, float value) {
  char digits[24];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void append(std::string& text, std::uint32_t value) {
  char digits[12];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// A line of comment, without what would end it early.
std::string comment(const char* start, std::string words) {
  for (char& c : words)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return words.empty() ? "" : start + words + "\n";
}

std::string identity_comments(const std::string& start, const Surface& surface) {
  return start + "orcart painted surface, millimetres\n" + start + "SPACE=LPS\n" +
         comment((start + "orcart hash ").c_str(), checks::mesh_hash(surface.mesh)) +
         comment((start + "orcart series ").c_str(), surface.identity.series) +
         comment((start + "orcart frame_of_reference ").c_str(), surface.identity.frame_of_reference);
}

std::string obj_text(const TexturedSurface& textured, const std::string& mtl_name) {
  std::string text = identity_comments("# ", textured.surface) + "mtllib " + mtl_name + "\n";
  for (const Eigen::Vector3f& vertex : textured.surface.mesh.vertices_mm) {
    text += 'v';
    for (const float coordinate : vertex) append(text += ' ', coordinate);
    text += '\n';
  }
  for (const Eigen::Vector3f& normal : angle_weighted_normals(textured.surface.mesh)) {
    text += "vn";
    for (const float coordinate : normal) append(text += ' ', coordinate);
    text += '\n';
  }
  for (const auto& corners : textured.corners_uv)
    for (const Eigen::Vector2f& uv : corners) {
      append(text += "vt ", uv.x());
      append(text += ' ', uv.y());
      text += '\n';
    }
  text += "usemtl painted\n";
  std::uint32_t place = 0;
  for (const auto& triangle : textured.surface.mesh.triangles) {
    text += 'f';
    for (const std::uint32_t vertex : triangle) {
      append(text += ' ', vertex + 1);
      append(text += '/', ++place);
      append(text += '/', vertex + 1);
    }
    text += '\n';
  }
  return text;
}

std::string mtl_text(const std::string& png_name) {
  return "# orcart painted surface\nnewmtl painted\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd " +
         png_name + "\n";
}

template <class Value>
void append_bytes(std::string& text, const Value* values, std::size_t count) {
  text.append(reinterpret_cast<const char*>(values), count * sizeof(Value));
}

std::string ply_bytes(const TexturedSurface& textured, const std::string& png_name) {
  const SplitSurface split = split_along_seams(textured);
  std::string text =
      "ply\nformat binary_little_endian 1.0\n" + identity_comments("comment ", textured.surface) +
      "comment TextureFile " + png_name + "\nelement vertex " + std::to_string(split.vertex_of.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property float texture_u\nproperty float texture_v\nelement face " +
      std::to_string(split.indices.size() / 3) + "\nproperty list uchar int vertex_indices\nelement seam " +
      std::to_string(split.vertex_of.size() - textured.surface.mesh.vertices_mm.size()) +
      "\nproperty int vertex\nend_header\n";
  const std::vector<Eigen::Vector3f> normals = angle_weighted_normals(textured.surface.mesh);
  for (std::size_t v = 0; v < split.vertex_of.size(); ++v) {
    append_bytes(text, textured.surface.mesh.vertices_mm[split.vertex_of[v]].data(), 3);
    append_bytes(text, normals[split.vertex_of[v]].data(), 3);
    append_bytes(text, split.places[v].data(), 2);
  }
  for (std::size_t i = 0; i < split.indices.size(); i += 3) {
    text += '\3';
    append_bytes(text, &split.indices[i], 3);
  }
  for (std::size_t v = textured.surface.mesh.vertices_mm.size(); v < split.vertex_of.size(); ++v)
    append_bytes(text, &split.vertex_of[v], 1);
  return text;
}

/// The paint over grey, so that viewers that know no alpha show bare tissue where nothing was painted.
std::vector<std::uint8_t> over_grey(std::span<const std::uint8_t> rgba) {
  constexpr unsigned kGrey = 150;
  std::vector<std::uint8_t> opaque(rgba.begin(), rgba.end());
  for (std::size_t i = 0; i < opaque.size(); i += 4) {
    const unsigned alpha = rgba[i + 3];
    for (std::size_t c = 0; c < 3; ++c)
      opaque[i + c] = static_cast<std::uint8_t>((rgba[i + c] * alpha + kGrey * (255 - alpha) + 127) / 255);
    opaque[i + 3] = 255;
  }
  return opaque;
}

constexpr std::uintmax_t kLargestPictureBytes = 1U << 30;

bool is_writable(const std::string& extension) {
  return extension == ".obj" || extension == ".ply" || extension == ".glb";
}

/// The set's files but the picture, which is there already as `png`.
Result<void> write_set(FileSet& set, const fs::path& file, const TexturedSurface& textured,
                       const fs::path& png) {
  const std::string extension = file.extension().string(), name = file.filename().string();
  if (extension == ".glb") {
    const auto picture = read_whole_file(png, kLargestPictureBytes);
    if (!picture) return tl::unexpected(picture.error());
    const std::string_view bytes(reinterpret_cast<const char*>(picture->data()), picture->size());
    return write_whole_file(set.add(name), glb_bytes(textured, bytes));
  }
  if (extension == ".ply")
    return write_whole_file(set.add(name), ply_bytes(textured, png.filename().string()));
  const std::string mtl = file.stem().string() + ".mtl";
  if (auto written = write_whole_file(set.add(mtl), mtl_text(png.filename().string())); !written)
    return written;
  return write_whole_file(set.add(name), obj_text(textured, mtl));
}

}  // namespace

Result<void> write_textured(const fs::path& file, const TexturedSurface& textured) {
  const std::string extension = file.extension().string();
  if (!is_writable(extension))
    return fail(file.string() + ": a painted surface is written as .obj, .ply or .glb");
  if (textured.corners_uv.size() != textured.surface.mesh.triangles.size())
    return fail(file.string() + ": is not written: " + std::to_string(textured.corners_uv.size()) +
                " triangles have places in the picture, " +
                std::to_string(textured.surface.mesh.triangles.size()) + " are needed");
  const std::size_t texels =
      static_cast<std::size_t>(textured.width_texels) * static_cast<std::size_t>(textured.height_texels);
  if (textured.rgba.size() != 4 * texels)
    return fail(file.string() + ": is not written: its picture has " + std::to_string(textured.rgba.size()) +
                " bytes, " + std::to_string(4 * texels) + " are needed");
  FileSet set(file);
  if (auto begun = set.begin(); !begun) return begun;
  const std::string name = file.stem().string() + ".png";
  const fs::path png = extension == ".glb" ? set.scratch(name) : set.add(name);
  if (auto written = write_png(png, textured.width_texels, textured.height_texels, over_grey(textured.rgba));
      !written)
    return written;
  if (auto written = write_set(set, file, textured, png); !written) return written;
  return set.publish();
}

std::vector<fs::path> textured_files(const fs::path& file) {
  std::vector<fs::path> files = {file};
  const std::vector<std::string> beside = file.extension() == ".obj"
                                              ? std::vector<std::string>{".mtl", ".png"}
                                          : file.extension() == ".ply" ? std::vector<std::string>{".png"}
                                                                       : std::vector<std::string>{};
  for (const std::string& extension : beside) files.push_back(fs::path(file).replace_extension(extension));
  return files;
}

}  // namespace orcart
