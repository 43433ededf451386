// Reads through VTK; the triangles go through the same checks as every surface.
#include "tools/surface/vtk_surface.hpp"

#include <algorithm>
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

std::size_t bytes_of(std::string_view type) {
  if (type == "double" || type == "vtktypeint64" || type == "long" || type == "vtkIdType") return 8;
  return type.ends_with("char") ? 1 : type.ends_with("short") ? 2 : 4;
}

/// Whether a file of the old format holds the points and cells that it announces, as far as a walk over its
/// blocks tells: VTK reads beyond what is there, and crashes or makes triangles up.
bool is_whole(std::string_view text) {
  TextCursor cursor(text);
  const std::string_view first = cursor.line();
  cursor.line();
  const bool binary = cursor.word() == "BINARY", offsets = first.find("Version 5") != std::string_view::npos;
  std::string_view rest = text.substr(cursor.place());
  const auto skip = [&](std::uint64_t count, std::size_t bytes) {
    if (count > text.size()) return false;
    if (binary) {
      const auto end = rest.find('\n');
      if (end == std::string_view::npos || rest.size() - end - 1 < count * bytes) return false;
      rest.remove_prefix(end + 1 + count * bytes);
      return true;
    }
    TextCursor numbers(rest);
    for (std::uint64_t i = 0; i < count; ++i)
      if (!numbers.number<double>()) return false;
    rest.remove_prefix(numbers.place());
    return true;
  };
  for (;;) {
    TextCursor words(rest);
    const std::string_view key = words.word();
    if (key == "DATASET") {
      words.word();
    } else if (key == "METADATA") {
      while (!words.at_end() && !words.line().empty()) continue;
      while (!words.at_end() && !words.line().empty()) continue;
    } else if (key == "POINTS") {
      const auto count = words.number<std::uint64_t>();
      const std::size_t bytes = bytes_of(words.word());
      rest.remove_prefix(words.place());
      if (!count || *count > text.size() || !skip(3 * *count, bytes)) return false;
      continue;
    } else if (key == "VERTICES" || key == "LINES" || key == "POLYGONS" || key == "TRIANGLE_STRIPS") {
      const auto cells = words.number<std::uint64_t>(), size = words.number<std::uint64_t>();
      if (!cells || !size) return false;
      rest.remove_prefix(words.place());
      if (!offsets) {
        if (!skip(*size, 4)) return false;
        continue;
      }
      for (const std::uint64_t count : {*cells, *size}) {
        TextCursor block(rest);
        block.word();
        const std::size_t bytes = bytes_of(block.word());
        rest.remove_prefix(block.place());
        if (!skip(count, bytes)) return false;
      }
      continue;
    } else {
      return true;  // the end, or what belongs to points and cells
    }
    rest.remove_prefix(words.place());
  }
}

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
    const bool whole = is_whole({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    if (whole) reader->Update();
    if (!whole || reader->GetErrorCode() != 0)
      return fail(name + ": is damaged or cut short; a whole file is expected");
    surface = parsed(*reader->GetOutput(), reader->GetHeader(), name);
  }
  if (!surface) return tl::unexpected(surface.error());
  return finish_surface(*std::move(surface), name, notes, where_unstated);
}

}  // namespace orcart
