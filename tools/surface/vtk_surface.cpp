// Reads through VTK; the triangles go through the same checks as every surface.
#include "tools/surface/vtk_surface.hpp"

#include <algorithm>
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
#include "tools/mesh/import_command.hpp"

namespace orcart {

namespace {

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
    reader->Update();
    if (reader->GetErrorCode() != 0)
      return fail(name + ": is damaged or cut short; a whole file is expected");
    surface = parsed(*reader->GetOutput(), reader->GetHeader(), name);
  }
  if (!surface) return tl::unexpected(surface.error());
  return finish_surface(*std::move(surface), name, notes, where_unstated);
}

}  // namespace orcart
