// A viewing cone's walk through the cluster tree: stops at each find and can be taken up later.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "realtime/geometry/cluster_tree.hpp"
#include "realtime/geometry/viewing_cone.hpp"

namespace orcart {

/// A cluster that the cone may meet.
struct ClusterVisit {
  std::uint32_t cluster = 0;
  bool inside = false;  ///< all of it lies inside the cone: its triangles need no test
};

/// Neighbouring clusters that the cone may meet.
struct ClusterRun {
  std::uint32_t first = 0, end = 0;  ///< clusters [first, end)
  bool inside = false;               ///< all of them lie inside the cone; else it is one cluster
};

/// The cone as bare numbers, for vector code.
struct ConeNumbers {
  std::array<float, 3> apex_mm{};  ///< in M
  std::array<float, 9> R_CM{};     ///< row by row
  float tangent = 1, sine = 0, cosine = 1, far_mm = 0;
};
ConeNumbers numbers_of(const ViewingCone& cone) noexcept;

/// The way down the tree, one frame a level; 12 at most (ClusterTree::kMaxLevels).
struct ConeWalkFrames {
  struct Frame {
    std::uint32_t node = 0;
    std::uint32_t hit = 0, inside = 0;  ///< a bit a place: still to visit; wholly inside the cone
    std::array<float, ClusterTree::kWidth> depth_mm{};
  };
  std::array<Frame, ClusterTree::kMaxLevels> frame{};
  std::size_t size = 0;
};

/// Real-time: allocates nothing, visits each node at most once, keeps its stack in itself. The same tree and
/// cone until the walk ends. Vector code for the processor it runs on (Highway).
class ConeWalk {
 public:
  void begin(const ClusterTree& tree, const ViewingCone& cone) noexcept;
  /// The next cluster, or false when there are no more. Of a node's children the nearest comes first: what
  /// hides tends to come before what it hides.
  bool next(const ClusterTree& tree, ClusterVisit& visit) noexcept;
  /// The next run in the tree's order, or false. A subtree wholly inside the cone is one run: not entered.
  bool next(const ClusterTree& tree, ClusterRun& run) noexcept;

  const ConeNumbers& cone() const noexcept { return cone_; }
  ConeWalkFrames& frames() noexcept { return frames_; }

 private:
  ConeNumbers cone_;
  ConeWalkFrames frames_;
};

}  // namespace orcart
