// The circle is fitted to where rays from outside first meet light, by random samples; what sticks out of it
// is the notch.
#include "tools/calibration/mask_finder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

namespace orcart {
namespace {

constexpr int kRays = 720;

struct Circle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0;
};

/// The level above which a pixel counts as lit.
double threshold_of(const cv::Mat& lit) {
  std::vector<uchar> values(lit.begin<uchar>(), lit.end<uchar>());
  const auto at = [&values](double part) {
    const auto middle =
        values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), middle, values.end());
    return static_cast<double>(*middle);
  };
  const double dark = at(0.01), bright = at(0.7);
  return dark + std::max(10.0, 0.12 * (bright - dark));
}

/// Where each ray from the picture's border towards `centre` first meets light; rays lit at the border meet
/// no edge. Square pixels.
std::vector<Eigen::Vector2d> edge_points(const cv::Mat& lit, const Eigen::Vector2d& centre, double aspect,
                                         double threshold) {
  std::vector<Eigen::Vector2d> points;
  const double reach = std::hypot(lit.cols, lit.rows / aspect);
  for (int ray = 0; ray < kRays; ++ray) {
    const double angle = 2 * std::numbers::pi * ray / kRays;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    int inside = 0;
    for (double r = reach; r > 0; r -= 0.5) {
      const Eigen::Vector2d p = centre + r * along;
      const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y() * aspect));
      if (x < 2 || y < 2 || x >= lit.cols - 2 || y >= lit.rows - 2) continue;
      ++inside;
      if (lit.at<uchar>(y, x) < threshold) continue;
      if (inside > 6) points.push_back(p);
      break;
    }
  }
  return points;
}

/// Kasa 1976: the circle by linear least squares.
Circle circle_through(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector3d row(p.x(), p.y(), 1);
    a += row * row.transpose();
    b += row * p.squaredNorm();
  }
  const Eigen::Vector3d solved = a.fullPivLu().solve(b);
  const Eigen::Vector2d centre = 0.5 * solved.head<2>();
  return {.centre = centre, .radius = std::sqrt(std::max(0.0, solved.z() + centre.squaredNorm()))};
}

std::vector<Eigen::Vector2d> near(const Circle& circle, const std::vector<Eigen::Vector2d>& points,
                                  double tolerance) {
  std::vector<Eigen::Vector2d> close;
  for (const Eigen::Vector2d& p : points)
    if (std::abs((p - circle.centre).norm() - circle.radius) <= tolerance) close.push_back(p);
  return close;
}

Circle best_circle(const std::vector<Eigen::Vector2d>& points, double largest) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, points.size() - 1);
  Circle best;
  std::size_t most = 0;
  for (int i = 0; i < 400; ++i) {
    const Circle tried = circle_through({points[any(random)], points[any(random)], points[any(random)]});
    if (!(tried.radius > 0.1 * largest) || tried.radius > largest) continue;
    const std::size_t count = near(tried, points, std::max(1.5, 0.008 * tried.radius)).size();
    if (count > most) most = count, best = tried;
  }
  for (int i = 0; i < 5 && most > 10; ++i)
    best = circle_through(near(best, points, std::max(1.5, 0.008 * best.radius)));
  return best;
}

/// The narrow place that sticks out of the circle, or into it, farthest: the middle of the rays around it,
/// each weighed by how far it is off.
std::optional<double> notch_of(const Circle& circle, const std::vector<Eigen::Vector2d>& points) {
  constexpr double kHalfWidth_rad = 0.2;
  const double limit = std::max(2.5, 0.012 * circle.radius);
  double farthest = limit;
  std::optional<double> notch;
  int off = 0;
  const auto angle_of = [&](const Eigen::Vector2d& p) {
    return std::atan2(p.y() - circle.centre.y(), p.x() - circle.centre.x());
  };
  for (const Eigen::Vector2d& p : points) {
    const double deviation = std::abs((p - circle.centre).norm() - circle.radius);
    if (deviation > limit) ++off;
    if (deviation <= farthest) continue;
    farthest = deviation;
    notch = angle_of(p);
  }
  // More than a twelfth of the circle is no notch but a rim that is badly lit.
  if (off < 2 || off > kRays / 12) return std::nullopt;
  double sum = 0, weights = 0;
  for (const Eigen::Vector2d& p : points) {
    const double away = std::remainder(angle_of(p) - *notch, 2 * std::numbers::pi);
    const double weight = std::abs((p - circle.centre).norm() - circle.radius) - 0.5 * limit;
    if (std::abs(away) > kHalfWidth_rad || weight <= 0) continue;
    sum += weight * away, weights += weight;
  }
  return std::remainder(*notch + sum / std::max(weights, 1e-9), 2 * std::numbers::pi);
}

template <class Visit>
void along_edge(const CircularMask& mask, double aspect, const Eigen::Vector2i& size_px, Visit&& visit) {
  for (int i = 0; i < 128; ++i) {
    const double angle = 2 * std::numbers::pi * i / 128;
    visit(Eigen::Vector2d(
        std::clamp(mask.cx_px + mask.radius_px * std::cos(angle), 0.0, size_px.x() - 1.0),
        std::clamp(mask.cy_px + mask.radius_px * std::sin(angle) * aspect, 0.0, size_px.y() - 1.0)));
  }
}

}  // namespace

FoundMask find_mask(const cv::Mat& lit, double aspect) {
  cv::Mat calm;
  cv::GaussianBlur(lit, calm, {}, 1.0);
  const double threshold = threshold_of(calm);
  const Eigen::Vector2d middle(0.5 * (lit.cols - 1), 0.5 * (lit.rows - 1) / aspect);
  const double half_diagonal = std::hypot(0.5 * lit.cols, 0.5 * lit.rows / aspect);
  FoundMask found;
  found.mask = {.cx_px = middle.x(), .cy_px = middle.y() * aspect, .radius_px = half_diagonal};
  const auto points = edge_points(calm, middle, aspect, threshold);
  if (points.size() < kRays / 8) return found;
  const Circle circle = best_circle(points, 1.05 * half_diagonal);
  const auto rim = near(circle, points, std::max(1.5, 0.008 * circle.radius));
  if (2 * rim.size() < points.size() || rim.size() < kRays / 8) return found;
  found.circle = true;
  found.mask = {.cx_px = circle.centre.x(), .cy_px = circle.centre.y() * aspect, .radius_px = circle.radius};
  found.notch_rad = notch_of(circle, edge_points(calm, circle.centre, aspect, threshold));
  return found;
}

double cone_half_angle_rad(const Lens& lens, const CircularMask& mask, const Eigen::Vector2i& size_px) {
  double widest = 0;
  along_edge(mask, lens.fy_px / lens.fx_px, size_px, [&](const Eigen::Vector2d& pixel) {
    if (const auto direction = direction_of(lens, pixel))
      widest = std::max(widest, std::acos(std::min(1.0, direction->z())));
  });
  return std::clamp(widest, 0.02, std::min(1.48, lens.max_angle_rad));
}

bool monotone_to_edge(const Lens& lens, const CircularMask& mask, const Eigen::Vector2i& size_px) {
  bool monotone = true;
  along_edge(mask, lens.fy_px / lens.fx_px, size_px, [&](const Eigen::Vector2d& pixel) {
    monotone = monotone && direction_of(lens, pixel).has_value();
  });
  return monotone;
}

}  // namespace orcart
