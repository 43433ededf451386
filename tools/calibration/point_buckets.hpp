// Points of a picture in square buckets, so that the nearest few are found without looking at all.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "tools/calibration/saddle_points.hpp"

namespace orcart {

/// Keeps a reference to the points, which must outlive it.
class PointBuckets {
 public:
  explicit PointBuckets(const std::vector<LatticePoint>& points) : points_(points) {
    for (const LatticePoint& p : points) {
      columns_ = std::max(columns_, bucket_of(p.pixel_px.x()) + 1);
      rows_ = std::max(rows_, bucket_of(p.pixel_px.y()) + 1);
    }
    buckets_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (std::size_t i = 0; i < points.size(); ++i)
      bucket(bucket_of(points[i].pixel_px.x()), bucket_of(points[i].pixel_px.y())).push_back(i);
  }

  /// Up to `count` indices, nearest first; a point at the place itself comes first.
  std::vector<std::size_t> nearest(const Eigen::Vector2d& place_px, std::size_t count) const {
    std::vector<std::pair<double, std::size_t>> found;
    const int x = std::clamp(bucket_of(place_px.x()), 0, std::max(0, columns_ - 1));
    const int y = std::clamp(bucket_of(place_px.y()), 0, std::max(0, rows_ - 1));
    for (int reach = 0; reach <= std::max(columns_, rows_); ++reach) {
      for (int j = y - reach; j <= y + reach; ++j)
        for (int i = x - reach; i <= x + reach; ++i)
          if (std::max(std::abs(i - x), std::abs(j - y)) == reach) collect(i, j, place_px, found);
      const auto inside = std::count_if(found.begin(), found.end(), [reach](const auto& one) {
        return one.first <= std::pow(reach * kSide_px, 2);
      });
      if (static_cast<std::size_t>(inside) >= count) break;
    }
    std::sort(found.begin(), found.end());
    std::vector<std::size_t> indices;
    for (const auto& one : found) {
      if (indices.size() == count) break;
      indices.push_back(one.second);
    }
    return indices;
  }

 private:
  static constexpr double kSide_px = 16;
  static int bucket_of(double px) { return static_cast<int>(std::max(0.0, px) / kSide_px); }
  std::vector<std::size_t>& bucket(int i, int j) {
    return buckets_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(i)];
  }
  void collect(int i, int j, const Eigen::Vector2d& place_px,
               std::vector<std::pair<double, std::size_t>>& found) const {
    if (i < 0 || j < 0 || i >= columns_ || j >= rows_) return;
    const auto at =
        static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i);
    for (const std::size_t index : buckets_[at])
      found.emplace_back((points_[index].pixel_px - place_px).squaredNorm(), index);
  }

  const std::vector<LatticePoint>& points_;
  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<std::size_t>> buckets_;
};

}  // namespace orcart
