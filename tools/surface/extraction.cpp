// Surface extraction through VTK, in the grid's own axes; the points move to LPS at the end.
#include "tools/surface/extraction.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataConnectivityFilter.h>
#include <vtkSmartPointer.h>
#include <vtkWindowedSincPolyDataFilter.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include "tools/mesh/decimation.hpp"
#include "tools/mesh/mesh_components.hpp"

namespace orcart {

namespace {

using Polygons = vtkSmartPointer<vtkPolyData>;

/// Columns: one step along i, j and k.
Eigen::Matrix3d steps_of(const SoftMask& mask) {
  return Eigen::Map<const Eigen::Matrix3d>(mask.lattice.step_mm[0].data());
}

Polygons cut(const SoftMask& mask) {
  vtkNew<vtkFloatArray> values;
  constexpr int kLent = 1;
  values->SetArray(const_cast<float*>(mask.values.data()), static_cast<vtkIdType>(mask.values.size()), kLent);
  vtkNew<vtkImageData> image;
  image->SetDimensions(mask.lattice.size.data());
  const Eigen::RowVector3d spacing_mm = steps_of(mask).colwise().norm();
  image->SetSpacing(spacing_mm.data());
  image->GetPointData()->SetScalars(values);
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(image);
  edges->SetValue(0, 0.5 + 1e-6);  // no voxel has this value exactly, so no triangle collapses to a point
  edges->ComputeNormalsOff();
  edges->ComputeScalarsOff();
  edges->Update();
  return edges->GetOutput();
}

Polygons largest_piece(const Polygons& surface) {
  vtkNew<vtkPolyDataConnectivityFilter> pieces;
  pieces->SetInputData(surface);
  pieces->SetExtractionModeToLargestRegion();
  pieces->Update();
  return pieces->GetOutput();
}

Polygons smoothed(const Polygons& surface, const Extraction& options) {
  vtkNew<vtkWindowedSincPolyDataFilter> sinc;
  sinc->SetInputData(surface);
  sinc->SetNumberOfIterations(options.smoothing_iterations);
  sinc->SetPassBand(options.pass_band);
  sinc->NormalizeCoordinatesOn();
  sinc->FeatureEdgeSmoothingOff();
  sinc->BoundarySmoothingOff();
  sinc->Update();
  return sinc->GetOutput();
}

/// To LPS, without the points that no triangle uses; turned round where the grid's axes are left-handed.
TriangleMesh mesh_of(vtkPolyData& surface, const SoftMask& mask) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  const Eigen::Matrix3d axes = steps_of(mask).colwise().normalized();
  const bool mirrored = axes.determinant() < 0;
  const Eigen::Vector3d origin_mm(mask.lattice.origin_mm.data());
  TriangleMesh mesh;
  std::vector<std::uint32_t> index_of(static_cast<std::size_t>(surface.GetNumberOfPoints()), kUnused);
  const auto vertex = [&](vtkIdType point) {
    std::uint32_t& index = index_of[static_cast<std::size_t>(point)];
    if (index == kUnused) {
      Eigen::Vector3d place;
      surface.GetPoint(point, place.data());
      index = static_cast<std::uint32_t>(mesh.vertices_mm.size());
      mesh.vertices_mm.push_back((origin_mm + axes * place).cast<float>());
    }
    return index;
  };
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < surface.GetNumberOfCells(); ++cell) {
    surface.GetCellPoints(cell, corners);
    if (corners->GetNumberOfIds() != 3) continue;
    mesh.triangles.push_back(
        {vertex(corners->GetId(0)), vertex(corners->GetId(1)), vertex(corners->GetId(2))});
    if (mirrored) std::swap(mesh.triangles.back()[1], mesh.triangles.back()[2]);
  }
  return mesh;
}

double farthest_move_mm(vtkPolyData& before, vtkPolyData& after) {
  double farthest = 0;
  for (vtkIdType point = 0; point < before.GetNumberOfPoints(); ++point) {
    Eigen::Vector3d a, b;
    before.GetPoint(point, a.data());
    after.GetPoint(point, b.data());
    farthest = std::max(farthest, (a - b).norm());
  }
  return farthest;
}

}  // namespace

Result<ExtractedSurface> extract_surface(const SoftMask& mask, const Extraction& options) {
  using Kind = PieceChoice::Kind;
  Polygons raw = cut(mask);
  if (raw->GetNumberOfCells() == 0)
    return fail("the region vanished under its smoothing; a smaller --smooth or a wider --range is expected");
  if (options.pieces.kind == Kind::largest) raw = largest_piece(raw);
  const Polygons surface = smoothed(raw, options);
  ExtractedSurface made{.smoothing_max_mm = farthest_move_mm(*raw, *surface)};
  TriangleMesh mesh = mesh_of(*surface, mask);
  if (options.pieces.kind == Kind::numbered) {
    const MeshComponents pieces = components_of(mesh);
    const auto wanted = static_cast<std::size_t>(options.pieces.number);
    if (wanted < 1 || wanted > pieces.triangles.size())
      return fail("the surface has " + std::to_string(pieces.triangles.size()) + " pieces and piece " +
                  std::to_string(options.pieces.number) + " was asked for; 1 to " +
                  std::to_string(pieces.triangles.size()) + " are accepted");
    mesh = component(mesh, pieces, wanted - 1);
  }
  made.cut_triangles = mesh.triangles.size();
  made.mesh = decimate(mesh, static_cast<std::size_t>(options.triangles));
  if (made.mesh.triangles.size() < mesh.triangles.size())
    made.thinning = distance_to_mesh(mesh.vertices_mm, made.mesh);
  return made;
}

}  // namespace orcart
