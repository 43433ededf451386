// Tries the ways in which a lattice may have taken diagonals for sides, and keeps the one that makes squares.
#include "tools/calibration/lattice_sides.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>

namespace orcart {
namespace {

/// Of the plane's places (columns, rows, 1) to pixels from the picture's middle.
std::optional<Eigen::Matrix3d> homography(const Lattice& lattice, const cv::Size& picture) {
  std::vector<cv::Point2d> places, pixels;
  for (const auto& [place, pixel] : lattice) {
    places.emplace_back(place.first, place.second);
    pixels.emplace_back(pixel.x() - 0.5 * picture.width, pixel.y() - 0.5 * picture.height);
  }
  const cv::Mat found = cv::findHomography(places, pixels);
  if (found.empty()) return std::nullopt;
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(found.ptr<double>());
}

/// How far two steps of the plane are from a square's sides, seen by the best of some cameras: the cosine
/// between them, or the logarithm of their ratio, whichever is larger.
double unsquareness(const Eigen::Vector3d& along_x, const Eigen::Vector3d& along_y, double wide_px) {
  double least = 1e9;
  for (double f_px = 0.3 * wide_px; f_px < 6 * wide_px; f_px *= 1.06) {
    const Eigen::Vector3d camera(1 / f_px, 1 / f_px, 1);
    const Eigen::Vector3d u = along_x.cwiseProduct(camera), v = along_y.cwiseProduct(camera);
    const double cosine = std::abs(u.dot(v)) / (u.norm() * v.norm());
    least = std::min(least, std::max(cosine, std::abs(std::log(u.norm() / v.norm()))));
  }
  return least;
}

}  // namespace

void count_along_sides(Lattice& lattice, const cv::Size& picture) {
  constexpr int kFarthest = 2;     // diagonals of up to so many cells
  constexpr double kBetter = 0.7;  // than what is there, to be preferred
  const auto plane = homography(lattice, picture);
  if (!plane) return;
  const double wide_px = std::max(picture.width, picture.height);
  double least = kBetter * unsquareness(plane->col(0), plane->col(1), wide_px);
  Eigen::Matrix2i sides = Eigen::Matrix2i::Identity();  // columns: the sides, counted as the lattice counts
  for (int a = -kFarthest; a <= kFarthest; ++a)
    for (int b = -kFarthest; b <= kFarthest; ++b)
      for (int c = -kFarthest; c <= kFarthest; ++c)
        for (int d = -kFarthest; d <= kFarthest; ++d) {
          if (a * d - b * c != 1) continue;
          const double cost = unsquareness(a * plane->col(0) + c * plane->col(1),
                                           b * plane->col(0) + d * plane->col(1), wide_px);
          if (cost >= least) continue;
          least = cost;
          sides << a, b, c, d;
        }
  if (sides == Eigen::Matrix2i::Identity()) return;
  Lattice counted;
  for (const auto& [place, pixel] : lattice)
    counted[{sides(1, 1) * place.first - sides(0, 1) * place.second,
             sides(0, 0) * place.second - sides(1, 0) * place.first}] = pixel;
  lattice = std::move(counted);
}

}  // namespace orcart
