// One cluster's triangles sorted for a view: in the cone or not, to be painted or not.
#pragma once

#include <cstdint>

#include "realtime/mapper/cone_sieve.hpp"

namespace orcart {

/// What a view and its surface ask of a triangle.
struct SortRule {
  ConeNumbers cone;
  SeenFrom seen_from = SeenFrom::outside;
  float cos_max_obliquity = 0;
  bool facing = true;  ///< false: every triangle in the cone counts as front
};

/// A bit a triangle of the cluster.
struct ClusterSorting {
  std::uint64_t in_cone = 0;
  std::uint64_t front = 0;  ///< of those: facing_of says Facing::front
};

/// Real-time. Vector code decides in single precision where that is certain; the rest is asked of facing_of
/// and meets_cone, so the answer is theirs.
ClusterSorting sort_cluster(const ClusterTree& tree, const ClusterVisit& visit, const SortRule& rule,
                            SieveScratch& scratch) noexcept;

/// Asks facing_of about the triangles whose bit is set; returns the front ones.
std::uint64_t front_by_double(const ClusterTree::Arrays& tree, std::uint32_t cluster, const SortRule& rule,
                              std::uint64_t unclear) noexcept;

}  // namespace orcart
