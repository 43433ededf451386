// VTK pipelines from its documented API: an implicit cone between two planes, a cell locator, texture maps.
#include "tools/bench/vtk/stock_mapper.hpp"

#include <array>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkClipPolyData.h>
#include <vtkCone.h>
#include <vtkExtractPolyDataGeometry.h>
#include <vtkGenericCell.h>
#include <vtkImplicitBoolean.h>
#include <vtkMath.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProjectedTexture.h>
#include <vtkStaticCellLocator.h>
#include <vtkTextureMapToPlane.h>
#include <vtkTransform.h>

namespace orcart {

struct StockMapper::State {
  vtkNew<vtkPolyData> surface;
  vtkNew<vtkCone> cone;
  vtkNew<vtkPlane> behind, beyond;
  vtkNew<vtkImplicitBoolean> solid;
  vtkNew<vtkTransform> to_cone;
  vtkNew<vtkStaticCellLocator> locator;
  vtkNew<vtkGenericCell> cell;
  vtkNew<vtkExtractPolyDataGeometry> extract;
  vtkNew<vtkClipPolyData> clip;
  vtkNew<vtkTextureMapToPlane> map_extracted, map_clipped;
  vtkNew<vtkProjectedTexture> project;
  FiveDirections directions;
  ConeShape shape;

  void place(const ViewingCone& viewing);
  FiveRays trace(const Pose<M, C>& X_MC);
  void scale(vtkTextureMapToPlane* map, const Pose<M, C>& X_MC);
};

namespace {

void fill(vtkPolyData* surface, const TriangleMesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices_mm.size()));
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i)
    points->SetPoint(static_cast<vtkIdType>(i), mesh.vertices_mm[i].x(), mesh.vertices_mm[i].y(),
                     mesh.vertices_mm[i].z());
  vtkNew<vtkCellArray> triangles;
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<vtkIdType, 3> ids{a, b, c};
    triangles->InsertNextCell(3, ids.data());
  }
  surface->SetPoints(points);
  surface->SetPolys(triangles);
}

}  // namespace

StockMapper::StockMapper(const TriangleMesh& mesh, const FiveDirections& directions, const ConeShape& shape)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.directions = directions;
  s.shape = shape;
  fill(s.surface, mesh);
  s.locator->SetDataSet(s.surface);
  s.locator->BuildLocator();
  // VTK's cone opens along x both ways; the planes keep what lies ahead. Inside is negative.
  s.behind->SetNormal(-1, 0, 0);
  s.beyond->SetNormal(1, 0, 0);
  s.solid->SetOperationTypeToIntersection();
  s.solid->AddFunction(s.cone);
  s.solid->AddFunction(s.behind);
  s.solid->AddFunction(s.beyond);
  s.solid->SetTransform(s.to_cone);
  s.extract->SetInputData(s.surface);
  s.extract->SetImplicitFunction(s.solid);
  s.extract->ExtractInsideOn();
  s.extract->ExtractBoundaryCellsOn();
  s.clip->SetInputData(s.surface);
  s.clip->SetClipFunction(s.solid);
  s.clip->InsideOutOn();
  s.map_extracted->SetInputConnection(s.extract->GetOutputPort());
  s.map_clipped->SetInputConnection(s.clip->GetOutputPort());
  s.project->SetInputData(s.surface);
}

StockMapper::~StockMapper() = default;

/// C's z becomes the cone's x.
void StockMapper::State::place(const ViewingCone& viewing) {
  cone->SetAngle(vtkMath::DegreesFromRadians(std::atan(static_cast<double>(viewing.tangent))));
  beyond->SetOrigin(viewing.far_mm, 0, 0);
  constexpr std::array<Eigen::Index, 3> kRowOfAxis{2, 0, 1};
  vtkNew<vtkMatrix4x4> matrix;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d row = viewing.R_CM.row(kRowOfAxis[static_cast<std::size_t>(axis)]).cast<double>();
    for (int i = 0; i < 3; ++i) matrix->SetElement(axis, i, row[i]);
    matrix->SetElement(axis, 3, -row.dot(viewing.apex_mm.cast<double>()));
  }
  to_cone->SetMatrix(matrix);
}

FiveRays StockMapper::State::trace(const Pose<M, C>& X_MC) {
  FiveRays rays;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Eigen::Vector3d from = X_MC.translation_mm;
    const Eigen::Vector3d along = X_MC.rotation * directions[i];
    const double reach_mm = shape.far_mm / directions[i].z();
    const Eigen::Vector3d to = from + reach_mm * along;
    double t = 0;
    std::array<double, 3> hit{}, weights{};
    int sub_id = 0;
    vtkIdType cell_id = -1;
    const int met = locator->IntersectWithLine(from.data(), to.data(), 1e-9, t, hit.data(), weights.data(),
                                               sub_id, cell_id, cell);
    rays.distance_mm[i] = met != 0 ? static_cast<float>(t * reach_mm) : -1;
    rays.hit_mm[i] = Eigen::Vector3d(hit[0], hit[1], hit[2]).cast<float>();
  }
  return rays;
}

/// The paper's (s, t) is a map to the plane across the view: 0.5 + PV . W / S1, 0.5 + PV . U / T1.
void StockMapper::State::scale(vtkTextureMapToPlane* map, const Pose<M, C>& X_MC) {
  const PaperProjection paper = paper_projection(X_MC, trace(X_MC), shape.half_angle_rad);
  const Eigen::Vector3d side = paper.s_size_mm * paper.side.cast<double>(),
                        up = paper.t_size_mm * paper.up.cast<double>();
  const Eigen::Vector3d origin = X_MC.translation_mm - 0.5 * side - 0.5 * up;
  const Eigen::Vector3d right = origin + side, top = origin + up;
  map->AutomaticPlaneGenerationOff();
  map->SetOrigin(origin.x(), origin.y(), origin.z());
  map->SetPoint1(right.x(), right.y(), right.z());
  map->SetPoint2(top.x(), top.y(), top.z());
}

std::uint32_t StockMapper::extract(const Pose<M, C>& X_MC, const ViewingCone& cone) {
  State& s = *state_;
  s.place(cone);
  s.scale(s.map_extracted, X_MC);
  s.extract->Modified();
  s.map_extracted->Update();
  return static_cast<std::uint32_t>(s.map_extracted->GetOutput()->GetNumberOfCells());
}

std::uint32_t StockMapper::clip(const Pose<M, C>& X_MC, const ViewingCone& cone) {
  State& s = *state_;
  s.place(cone);
  s.scale(s.map_clipped, X_MC);
  s.clip->Modified();
  s.map_clipped->Update();
  return static_cast<std::uint32_t>(s.map_clipped->GetOutput()->GetNumberOfCells());
}

std::uint32_t StockMapper::project(const Pose<M, C>& X_MC) {
  State& s = *state_;
  const Eigen::Vector3d at = X_MC.translation_mm, to = at + X_MC.rotation.col(2), up = -X_MC.rotation.col(1);
  const double width = 2 * std::tan(s.shape.half_angle_rad);
  s.project->SetPosition(at.x(), at.y(), at.z());
  s.project->SetFocalPoint(to.x(), to.y(), to.z());
  s.project->SetUp(up.x(), up.y(), up.z());
  s.project->SetAspectRatio(width, width, 1);
  s.project->Update();
  return static_cast<std::uint32_t>(s.project->GetOutput()->GetNumberOfCells());
}

}  // namespace orcart
