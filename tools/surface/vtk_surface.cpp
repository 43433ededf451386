// Reads through VTK; the triangles go through the same checks as every surface.
#include "tools/surface/vtk_surface.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTriangleFilter.h>
#include <vtkXMLPolyDataReader.h>

#include "firmware-host/files/surface_formats.hpp"
#include "firmware-host/files/text_cursor.hpp"
#include "firmware-host/files/whole_file.hpp"
#include "tools/mesh/import_command.hpp"

namespace orcart {

namespace {

constexpr std::uintmax_t kLargestFileBytes = std::uintmax_t{2} << 30U;

/// What the header line and the field data say of the space.
void take_space(vtkPolyData& data, const char* header, ParsedSurface& surface) {
  if (header != nullptr) take_comment(header, surface);
  vtkAbstractArray* field = data.GetFieldData()->GetAbstractArray("SPACE");
  auto* words = vtkStringArray::SafeDownCast(field);
  if (words != nullptr && words->GetNumberOfValues() > 0) surface.space = words->GetValue(0);
}

Result<ParsedSurface> parsed(vtkPolyData& data, const char* header, const std::string& name) {
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(&data);
  triangles->PassLinesOff();
  triangles->PassVertsOff();
  triangles->Update();
  vtkPolyData& whole = *triangles->GetOutput();
  if (static_cast<std::size_t>(whole.GetNumberOfPolys()) > kLargestTriangleCount)
    return fail(name + ": has " + std::to_string(whole.GetNumberOfPolys()) + " triangles; up to " +
                std::to_string(kLargestTriangleCount) + " are accepted");
  ParsedSurface surface;
  take_space(data, header, surface);
  for (vtkIdType point = 0; point < whole.GetNumberOfPoints(); ++point) {
    Eigen::Vector3d place;
    whole.GetPoint(point, place.data());
    surface.mesh.vertices_mm.push_back(place.cast<float>());
  }
  auto corners = vtk::TakeSmartPointer(whole.GetPolys()->NewIterator());
  for (corners->GoToFirstCell(); !corners->IsDoneWithTraversal(); corners->GoToNextCell()) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    corners->GetCurrentCell(count, ids);
    std::vector<std::uint32_t> polygon;
    for (vtkIdType i = 0; i < count; ++i) polygon.push_back(static_cast<std::uint32_t>(ids[i]));
    if (!append_polygon(polygon, surface.mesh.vertices_mm.size(), surface.mesh))
      return fail(name + ": a triangle names a vertex that is not there; the file is damaged");
  }
  return surface;
}

std::string lower(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::size_t bytes_of(const std::string& type) {
  if (type == "double" || type.ends_with("int64") || type.ends_with("long")) return 8;
  return type.ends_with("char") ? 1 : type.ends_with("short") ? 2 : 4;  // vtkIdType is written as an int
}

/// Walks over the blocks of a file of the old format as far as they tell whether it holds the points and
/// cells that it announces: VTK reads beyond what is there, and crashes or makes triangles up.
class BlockWalk {
 public:
  explicit BlockWalk(std::string_view text) : size_(text.size()) {
    TextCursor cursor(text);
    offsets_ = cursor.line().find("Version 5") != std::string_view::npos;
    cursor.line();
    binary_ = cursor.word() == "BINARY";
    rest_ = text.substr(cursor.place());
  }

  bool is_whole() {
    bool points = false, cells = false;
    for (;;) {
      TextCursor words(rest_);
      const std::string key = lower(words.word());
      if (key == "dataset") {
        words.word();
        rest_.remove_prefix(words.place());
      } else if (key == "metadata") {
        skip_metadata();
      } else if (key == "field") {
        if (!skip_field(words)) return false;
      } else if (key == "points") {
        if (!skip_points(words)) return false;
        points = true;
      } else if (key == "vertices" || key == "lines" || key == "polygons" || key == "triangle_strips") {
        if (!skip_cells(words)) return false;
        cells = true;
      } else {
        return points && cells;  // the end, or what belongs to points and cells
      }
    }
  }

 private:
  /// `count` numbers of so many bytes; a string's bytes are not known before.
  bool skip(std::uint64_t count, std::size_t bytes) {
    if (count > size_) return false;
    if (binary_) return to_next_line() && skip_bytes(count * bytes);
    TextCursor numbers(rest_);
    for (std::uint64_t i = 0; i < count; ++i)
      if (!numbers.number<double>()) return false;
    rest_.remove_prefix(numbers.place());
    return true;
  }

  bool to_next_line() {
    const auto end = rest_.find('\n');
    if (end == std::string_view::npos) return false;
    rest_.remove_prefix(end + 1);
    return true;
  }

  bool skip_bytes(std::uint64_t count) {
    if (rest_.size() < count) return false;
    rest_.remove_prefix(count);
    return true;
  }

  /// Each with its length before it, in 1, 2, 4 or 8 bytes as the first two bits say; as text a line each.
  bool skip_strings(std::uint64_t count) {
    if (count > size_ || !to_next_line()) return false;
    for (std::uint64_t i = 0; i < count; ++i) {
      if (!binary_) {
        if (!to_next_line()) return false;
        continue;
      }
      if (rest_.empty()) return false;
      const auto first = static_cast<unsigned char>(rest_.front());
      const std::size_t bytes = std::size_t{8} >> (first >> 6U);
      if (rest_.size() < bytes) return false;
      std::uint64_t length = first & 0x3FU;
      for (std::size_t b = 1; b < bytes; ++b) length = length << 8U | static_cast<unsigned char>(rest_[b]);
      rest_.remove_prefix(bytes);
      if (!skip_bytes(length)) return false;
    }
    return true;
  }

  /// Up to the empty line at its end.
  void skip_metadata() {
    TextCursor words(rest_);
    words.word();
    words.line();
    while (!words.at_end() && !words.line().empty()) continue;
    rest_.remove_prefix(words.place());
  }

  bool skip_field(TextCursor& words) {
    words.word();
    const auto arrays = words.number<std::uint64_t>();
    if (!arrays) return false;
    rest_.remove_prefix(words.place());
    for (std::uint64_t i = 0; i < *arrays; ++i) {
      TextCursor head(rest_);
      std::string_view name = head.word();
      if (name == "METADATA") {
        skip_metadata();
        head = TextCursor(rest_);
        name = head.word();
      }
      if (name == "NULL_ARRAY") {
        rest_.remove_prefix(head.place());
        continue;
      }
      const auto components = head.number<std::uint64_t>(), tuples = head.number<std::uint64_t>();
      const std::string type = lower(head.word());
      if (!components || !tuples || type.empty()) return false;
      rest_.remove_prefix(head.place());
      if (*components > size_ || *tuples > size_) return false;
      const std::uint64_t values = *components * *tuples;
      const bool bits = type == "bit" && binary_;
      if (!(type == "string" ? skip_strings(values)
                             : skip(bits ? (values + 7) / 8 : values, bits ? 1 : bytes_of(type))))
        return false;
    }
    return true;
  }

  bool skip_points(TextCursor& words) {
    const auto count = words.number<std::uint64_t>();
    const std::size_t bytes = bytes_of(lower(words.word()));
    rest_.remove_prefix(words.place());
    return count && *count <= size_ && skip(3 * *count, bytes);
  }

  bool skip_cells(TextCursor& words) {
    const auto cells = words.number<std::uint64_t>(), size = words.number<std::uint64_t>();
    if (!cells || !size) return false;
    rest_.remove_prefix(words.place());
    if (!offsets_) return skip(*size, 4);
    for (const std::uint64_t count : {*cells, *size}) {
      TextCursor block(rest_);
      block.word();
      const std::size_t bytes = bytes_of(lower(block.word()));
      rest_.remove_prefix(block.place());
      if (!skip(count, bytes)) return false;
    }
    return true;
  }

  std::string_view rest_;
  std::size_t size_;
  bool binary_ = false, offsets_ = false;
};

}  // namespace

Result<Surface> read_vtk_surface(const std::filesystem::path& file, SurfaceNotes* notes,
                                 std::optional<Space> where_unstated) {
  const std::string name = file.string();
  if (!std::filesystem::is_regular_file(file))
    return fail(name + ": is not there; a surface file is expected");
  vtkObject::GlobalWarningDisplayOff();
  Result<ParsedSurface> surface = fail(name + ": is no VTK file with a surface (polydata); one is expected");
  if (ending_of(file) == ".vtp") {
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(name.c_str());
    if (reader->CanReadFile(name.c_str()) == 0) return tl::unexpected(surface.error());
    reader->Update();
    if (reader->GetErrorCode() != 0)
      return fail(name + ": is damaged or cut short; a whole file is expected");
    surface = parsed(*reader->GetOutput(), nullptr, name);
  } else {
    vtkNew<vtkPolyDataReader> reader;
    reader->SetFileName(name.c_str());
    if (reader->IsFilePolyData() == 0) return tl::unexpected(surface.error());
    const auto bytes = read_whole_file(file, kLargestFileBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    const bool whole = BlockWalk({reinterpret_cast<const char*>(bytes->data()), bytes->size()}).is_whole();
    if (whole) reader->Update();
    if (!whole || reader->GetErrorCode() != 0)
      return fail(name + ": is damaged or cut short; a whole file is expected");
    surface = parsed(*reader->GetOutput(), reader->GetHeader(), name);
  }
  if (!surface) return tl::unexpected(surface.error());
  return finish_surface(*std::move(surface), name, notes, where_unstated);
}

}  // namespace orcart
