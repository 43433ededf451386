// Saddles by the determinant of the Hessian; each is then walked around on a circle, where its sectors must
// alternate.
#include "tools/calibration/saddle_points.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <opencv2/imgproc.hpp>

namespace orcart {
namespace {

constexpr int kSamples = 40;
constexpr std::size_t kMostSaddles = 20'000;

/// A grey value between pixels; -1 outside.
double grey_at(const cv::Mat& picture, double x, double y) {
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  if (x0 < 0 || y0 < 0 || x0 + 1 >= picture.cols || y0 + 1 >= picture.rows) return -1;
  const double u = x - x0, v = y - y0;
  const auto* upper = picture.ptr<float>(y0) + x0;
  const auto* lower = picture.ptr<float>(y0 + 1) + x0;
  return (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
}

struct Crossings {
  std::array<double, 4> angles_rad{};
  int count = 0;
};

/// Where the values on the circle pass zero.
Crossings crossings_of(const std::array<double, kSamples>& values) {
  Crossings found;
  for (int i = 0; i < kSamples; ++i) {
    const double here = values[static_cast<std::size_t>(i)];
    const double next = values[static_cast<std::size_t>((i + 1) % kSamples)];
    if ((here < 0) == (next < 0)) continue;
    if (found.count < 4)
      found.angles_rad[static_cast<std::size_t>(found.count)] =
          2 * std::numbers::pi * (i + here / (here - next)) / kSamples;
    ++found.count;
  }
  return found;
}

/// The middle of two lines that are nearly the same, modulo pi.
double mean_line(double a, double b) {
  const std::complex<double> sum = std::polar(1.0, 2 * a) + std::polar(1.0, 2 * b);
  return 0.5 * std::arg(sum);
}

}  // namespace

std::optional<LatticePoint> sectors_at(const cv::Mat& smoothed, const Eigen::Vector2d& place_px,
                                       double radius_px, double least_contrast) {
  std::array<double, kSamples> values{};
  double mean = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSamples;
    const double value = grey_at(smoothed, place_px.x() + radius_px * std::cos(angle),
                                 place_px.y() + radius_px * std::sin(angle));
    if (value < 0) return std::nullopt;
    values[static_cast<std::size_t>(i)] = value;
    mean += value / kSamples;
  }
  double energy = 0;
  std::complex<double> first{}, second{};
  for (int i = 0; i < kSamples; ++i) {
    double& value = values[static_cast<std::size_t>(i)];
    value -= mean;
    const double angle = 2 * std::numbers::pi * i / kSamples;
    energy += value * value / kSamples;
    first += value * std::polar(1.0, angle) / static_cast<double>(kSamples);
    second += value * std::polar(1.0, 2 * angle) / static_cast<double>(kSamples);
  }
  // A wave of two periods around the circle carries nearly all of a corner's energy; an edge's lies in one
  // period.
  if (std::sqrt(energy) < least_contrast || 2 * std::norm(second) < 0.55 * energy ||
      std::norm(first) > 0.35 * std::norm(second))
    return std::nullopt;
  const Crossings crossings = crossings_of(values);
  if (crossings.count != 4) return std::nullopt;
  LatticePoint point{.pixel_px = place_px, .strength = std::sqrt(energy), .oriented = true};
  point.bright_axis_rad = 0.5 * std::arg(second);
  point.edges_rad = {mean_line(crossings.angles_rad[0], crossings.angles_rad[2]),
                     mean_line(crossings.angles_rad[1], crossings.angles_rad[3])};
  return point;
}

std::vector<LatticePoint> find_saddles(const cv::Mat& grey, const SaddleSearch& search) {
  cv::Mat smoothed, xx, yy, xy;
  cv::GaussianBlur(grey, smoothed, {}, search.sigma_px);
  cv::Sobel(smoothed, xx, CV_32F, 2, 0, 3, 0.25);
  cv::Sobel(smoothed, yy, CV_32F, 0, 2, 3, 0.25);
  cv::Sobel(smoothed, xy, CV_32F, 1, 1, 3, 0.25);
  const cv::Mat response = xy.mul(xy) - xx.mul(yy);
  cv::Mat highest;
  const int reach = std::max(1, static_cast<int>(std::lround(search.sigma_px)));
  cv::dilate(response, highest, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8U));
  const double least = std::pow(search.least_contrast / (8 * search.sigma_px * search.sigma_px), 2);
  std::vector<LatticePoint> saddles;
  for (int y = 4; y < grey.rows - 4; ++y)
    for (int x = 4; x < grey.cols - 4; ++x) {
      const float value = response.at<float>(y, x);
      if (value < least || value < highest.at<float>(y, x)) continue;
      const auto point =
          sectors_at(smoothed, {x, y}, std::max(2.5, 2 * search.sigma_px), search.least_contrast);
      if (point) saddles.push_back(*point);
    }
  std::sort(saddles.begin(), saddles.end(),
            [](const auto& a, const auto& b) { return a.strength > b.strength; });
  if (saddles.size() > kMostSaddles) saddles.resize(kMostSaddles);
  return saddles;
}

}  // namespace orcart
