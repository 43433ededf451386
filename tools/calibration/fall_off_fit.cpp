// A line through logarithms: brightness against the cosine of the angle, views of unknown exposure.
#include "tools/calibration/fall_off_fit.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <opencv2/imgproc.hpp>

namespace orcart {

std::vector<PaperPatch> paper_patches(const cv::Mat& picture, const BoardView& view, const ViewFit& fit,
                                      const Lens& lens, std::size_t number) {
  cv::Mat grey;
  if (picture.channels() == 3) {
    cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  } else {
    grey = picture;
  }
  std::map<std::pair<int, int>, const BoardCorner*> at;
  for (const BoardCorner& c : view.corners) at[{c.lattice.x(), c.lattice.y()}] = &c;
  struct Square {
    double brightness;
    Eigen::Vector3d board_mm;
  };
  std::map<std::pair<int, int>, Square> squares;
  for (const auto& [place, corner] : at) {
    const auto across = at.find({place.first + 1, place.second + 1});
    if (across == at.end()) continue;
    const Eigen::Vector2d middle = 0.5 * (corner->pixel_px + across->second->pixel_px);
    const int reach =
        std::max(1, static_cast<int>(0.12 * (corner->pixel_px - across->second->pixel_px).norm()));
    const cv::Rect box = cv::Rect(static_cast<int>(middle.x()) - reach, static_cast<int>(middle.y()) - reach,
                                  2 * reach + 1, 2 * reach + 1) &
                         cv::Rect(0, 0, grey.cols, grey.rows);
    if (box.area() < 4) continue;
    squares[place] = {cv::mean(grey(box))[0], 0.5 * (corner->board_mm + across->second->board_mm)};
  }
  std::vector<PaperPatch> patches;
  for (const auto& [place, square] : squares) {
    double around = 0;
    int neighbours = 0;
    for (const auto& step : {std::pair{1, 0}, {0, 1}, {-1, 0}, {0, -1}})
      if (const auto next = squares.find({place.first + step.first, place.second + step.second});
          next != squares.end())
        around += next->second.brightness, ++neighbours;
    if (neighbours < 2 || square.brightness < 1.3 * around / neighbours)
      continue;  // a dark square, or a glossy one
    if (square.brightness < 20 || square.brightness > 245) continue;
    const Eigen::Vector3d p = (fit.X_CB * Point<B>{square.board_mm}).mm;
    const double distance = p.norm(), cosine = p.z() / distance;
    const double slant = std::abs(fit.X_CB.rotation.col(2).dot(p)) / distance;
    if (cosine < 0.1 || slant < 0.2 || std::acos(cosine) > lens.max_angle_rad) continue;
    patches.push_back(
        {.view = number,
         .log_brightness = 2.2 * std::log(square.brightness) + 2 * std::log(distance) - std::log(slant),
         .log_cosine = std::log(cosine)});
  }
  return patches;
}

std::optional<double> vignetting_power(const std::vector<PaperPatch>& patches, std::size_t views) {
  constexpr std::size_t kFewest = 30;
  if (patches.size() < kFewest) return std::nullopt;
  std::vector<double> weights(patches.size(), 1.0);
  double power = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<double> sum(views, 0), sum_x(views, 0), sum_y(views, 0);
    for (std::size_t i = 0; i < patches.size(); ++i) {
      sum[patches[i].view] += weights[i];
      sum_x[patches[i].view] += weights[i] * patches[i].log_cosine;
      sum_y[patches[i].view] += weights[i] * patches[i].log_brightness;
    }
    double xx = 0, xy = 0, all = 0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      const std::size_t v = patches[i].view;
      const double x = patches[i].log_cosine - sum_x[v] / sum[v],
                   y = patches[i].log_brightness - sum_y[v] / sum[v];
      xx += weights[i] * x * x, xy += weights[i] * x * y, all += weights[i];
    }
    if (xx < 1e-4 * all) return std::nullopt;
    power = xy / xx;
    for (std::size_t i = 0; i < patches.size(); ++i) {
      const std::size_t v = patches[i].view;
      const double off =
          patches[i].log_brightness - sum_y[v] / sum[v] - power * (patches[i].log_cosine - sum_x[v] / sum[v]);
      weights[i] = 1 / std::max(1.0, std::abs(off) / 0.1);
    }
  }
  return std::clamp(power, 0.0, 16.0);
}

}  // namespace orcart
