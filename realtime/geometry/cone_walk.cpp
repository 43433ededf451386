// Sends the walk to the code for this processor.
#include "realtime/geometry/cone_walk.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "realtime/geometry/cone_walk.cpp"
#include <hwy/foreach_target.h>

#include "realtime/geometry/cone_walk_simd.hpp"

HWY_BEFORE_NAMESPACE();
namespace orcart::HWY_NAMESPACE {

void walk_enter(const ClusterTree::Node* nodes, const ConeNumbers& cone, ConeWalkFrames& walk) {
  enter_node<true>(nodes, 0, cone, false, walk);
}

bool walk_visit(const ClusterTree::Node* nodes, const ConeNumbers& cone, ConeWalkFrames& walk,
                ClusterVisit& visit) {
  return next_visit(nodes, cone, walk, visit);
}

bool walk_run(const ClusterTree::Node* nodes, const ConeNumbers& cone, ConeWalkFrames& walk,
              ClusterRun& run) {
  return next_run(nodes, cone, walk, run);
}

}  // namespace orcart::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orcart {

HWY_EXPORT(walk_enter);
HWY_EXPORT(walk_visit);
HWY_EXPORT(walk_run);

ConeNumbers numbers_of(const ViewingCone& cone) noexcept {
  ConeNumbers numbers{
      .tangent = cone.tangent, .sine = cone.sine, .cosine = cone.cosine, .far_mm = cone.far_mm};
  for (Eigen::Index row = 0; row < 3; ++row) {
    numbers.apex_mm[static_cast<std::size_t>(row)] = cone.apex_mm[row];
    for (Eigen::Index column = 0; column < 3; ++column)
      numbers.R_CM[static_cast<std::size_t>(3 * row + column)] = cone.R_CM(row, column);
  }
  return numbers;
}

void ConeWalk::begin(const ClusterTree& tree, const ViewingCone& cone) noexcept {
  cone_ = numbers_of(cone);
  frames_.size = 0;
  if (!tree.nodes().empty()) HWY_DYNAMIC_DISPATCH(walk_enter)(tree.nodes().data(), cone_, frames_);
}

bool ConeWalk::next(const ClusterTree& tree, ClusterVisit& visit) noexcept {
  return HWY_DYNAMIC_DISPATCH(walk_visit)(tree.nodes().data(), cone_, frames_, visit);
}

bool ConeWalk::next(const ClusterTree& tree, ClusterRun& run) noexcept {
  return HWY_DYNAMIC_DISPATCH(walk_run)(tree.nodes().data(), cone_, frames_, run);
}

}  // namespace orcart
#endif
