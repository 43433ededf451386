// The cutout as one would do it with VTK's stock filters: what the cart's is measured against.
#pragma once

#include <cstdint>
#include <memory>

#include "realtime/geometry/triangle_mesh.hpp"
#include "realtime/geometry/viewing_cone.hpp"
#include "realtime/mapper/five_rays.hpp"

namespace orcart {

/// Filters are built once and only their parameters change from view to view, which is VTK's fastest use.
class StockMapper {
 public:
  StockMapper(const TriangleMesh& mesh, const FiveDirections& directions, const ConeShape& shape);
  StockMapper(const StockMapper&) = delete;
  StockMapper& operator=(const StockMapper&) = delete;
  ~StockMapper();

  /// Each runs one view and returns how many triangles came out. `cone` is what viewing_cone() gave for the
  /// pose, so that both sides cut with the very same numbers.
  /// vtkExtractPolyDataGeometry with boundary cells by cone and planes, five rays by vtkStaticCellLocator,
  /// vtkTextureMapToPlane over what came out.
  std::uint32_t extract(const Pose<M, C>& X_MC, const ViewingCone& cone);
  /// The same with vtkClipPolyData in place of the extraction.
  std::uint32_t clip(const Pose<M, C>& X_MC, const ViewingCone& cone);
  /// vtkProjectedTexture over the whole mesh: no cutout, no rays.
  std::uint32_t project(const Pose<M, C>& X_MC);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace orcart
