// Counts grey over small windows about each place.
#include "tools/evaluate/recorded/light_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <opencv2/imgproc.hpp>

namespace orcart {
namespace {

using Histogram = std::array<int, 256>;

double upper_quartile(const Histogram& histogram, int count) {
  int below = 0;
  for (std::size_t grey = 0; grey < histogram.size(); ++grey) {
    below += histogram[grey];
    if (4 * below >= 3 * count) return static_cast<double>(grey);
  }
  return 255;
}

std::vector<cv::Mat> greys_of(const std::vector<FlatPainting>& alone) {
  std::vector<cv::Mat> greys(alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i) cv::cvtColor(alone[i].bgr, greys[i], cv::COLOR_BGR2GRAY);
  return greys;
}

}  // namespace

std::vector<JoinPlace> joins_of(const FlatPainting& together) {
  const int cell = std::max(1, static_cast<int>(std::lround(1 / together.pixel_mm)));
  std::vector<JoinPlace> joins;
  std::map<std::pair<int, int>, std::size_t> taken;  // one a cell
  for (int v = 1; v < together.capture.rows; ++v)
    for (int u = 1; u < together.capture.cols; ++u) {
      const int here = together.capture.at<std::uint16_t>(v, u);
      for (const cv::Point before : {cv::Point{u - 1, v}, {u, v - 1}}) {
        const int there = together.capture.at<std::uint16_t>(before);
        if (here == 0 || there == 0 || here == there) continue;
        if (!taken.try_emplace({u / cell, v / cell}, joins.size()).second) continue;
        joins.push_back({.older = static_cast<std::size_t>(std::min(here, there) - 1),
                         .newer = static_cast<std::size_t>(std::max(here, there) - 1),
                         .pixel = {u, v}});
      }
    }
  return joins;
}

LightStep step_across(const std::string& name, const std::vector<JoinPlace>& joins,
                      const std::vector<FlatPainting>& alone, double reach_mm) {
  constexpr int kFewest = 400;
  constexpr double kWhite = 250;
  const std::vector<cv::Mat> greys = greys_of(alone);
  std::map<std::pair<std::size_t, std::size_t>, std::vector<double>> steps;
  LightStep step{.name = name};
  double percents = 0;
  for (const JoinPlace& join : joins) {
    const FlatPainting &older = alone[join.older], &newer = alone[join.newer];
    const int reach = static_cast<int>(std::lround(reach_mm / older.pixel_mm));
    const cv::Rect window =
        cv::Rect(join.pixel.x - reach, join.pixel.y - reach, 2 * reach + 1, 2 * reach + 1) &
        cv::Rect({0, 0}, older.bgr.size());
    Histogram first{}, second{};
    int count = 0;
    for (int v = window.y; v < window.br().y; ++v)
      for (int u = window.x; u < window.br().x; ++u) {
        if (older.painted.at<std::uint8_t>(v, u) == 0 || newer.painted.at<std::uint8_t>(v, u) == 0) continue;
        ++first[greys[join.older].at<std::uint8_t>(v, u)];
        ++second[greys[join.newer].at<std::uint8_t>(v, u)];
        ++count;
      }
    if (count < kFewest) continue;
    const double a = upper_quartile(first, count), b = upper_quartile(second, count);
    if (std::max(a, b) >= kWhite) {
      ++step.clipped;
      continue;
    }
    steps[{join.older, join.newer}].push_back(std::abs(a - b));
    percents += 100 * std::abs(a - b) / std::max({a, b, 1.0});
  }
  GroupedValues grouped;
  for (const auto& [pair, values] : steps) grouped.add(values);
  step.grey = grouped.statistics();
  step.percent = step.grey.count > 0 ? percents / static_cast<double>(step.grey.count) : 0;
  return step;
}

}  // namespace orcart
