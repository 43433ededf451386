// ChArUco boards: markers say which corner is which, local homographies where it should be, the saddle where
// it is.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "tools/calibration/find_board.hpp"

namespace orcart {
namespace {

constexpr std::array<std::pair<const char*, int>, 17> kDictionaries{
    {{"4X4_50", cv::aruco::DICT_4X4_50},
     {"4X4_100", cv::aruco::DICT_4X4_100},
     {"4X4_250", cv::aruco::DICT_4X4_250},
     {"4X4_1000", cv::aruco::DICT_4X4_1000},
     {"5X5_50", cv::aruco::DICT_5X5_50},
     {"5X5_100", cv::aruco::DICT_5X5_100},
     {"5X5_250", cv::aruco::DICT_5X5_250},
     {"5X5_1000", cv::aruco::DICT_5X5_1000},
     {"6X6_50", cv::aruco::DICT_6X6_50},
     {"6X6_100", cv::aruco::DICT_6X6_100},
     {"6X6_250", cv::aruco::DICT_6X6_250},
     {"6X6_1000", cv::aruco::DICT_6X6_1000},
     {"7X7_50", cv::aruco::DICT_7X7_50},
     {"7X7_100", cv::aruco::DICT_7X7_100},
     {"7X7_250", cv::aruco::DICT_7X7_250},
     {"7X7_1000", cv::aruco::DICT_7X7_1000},
     {"ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL}}};

struct Marker {
  Eigen::Vector2i square;            ///< column and row of its square
  std::array<cv::Point2f, 4> board;  ///< its corners in units of squares, from the upper left clockwise
  std::array<cv::Point2f, 4> pixel_px;
};

/// Since OpenCV 4.6 the upper left square is dark; before, the lower left one of the row count's parity was.
bool holds_marker(int column, int row, int rows, bool legacy) {
  const bool swapped = legacy && rows % 2 == 0;
  return ((column + row) % 2 == 1) != swapped;
}

/// Gives each detected marker its square; markers that the board does not have are left out.
std::vector<Marker> placed(const Pattern& pattern, bool legacy, const std::vector<int>& ids,
                           const std::vector<std::vector<cv::Point2f>>& corners) {
  std::map<int, Eigen::Vector2i> squares;
  int next = 0;
  for (int row = 0; row < pattern.rows; ++row)
    for (int column = 0; column < pattern.columns; ++column)
      if (holds_marker(column, row, pattern.rows, legacy)) squares[next++] = {column, row};
  const auto margin = static_cast<float>(0.5 * (1 - pattern.marker_mm / pattern.spacing_mm));
  std::vector<Marker> markers;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto square = squares.find(ids[i]);
    if (square == squares.end()) continue;
    const auto x = static_cast<float>(square->second.x()), y = static_cast<float>(square->second.y());
    markers.push_back({.square = square->second,
                       .board = {{{x + margin, y + margin},
                                  {x + 1 - margin, y + margin},
                                  {x + 1 - margin, y + 1 - margin},
                                  {x + margin, y + 1 - margin}}},
                       .pixel_px = {corners[i][0], corners[i][1], corners[i][2], corners[i][3]}});
  }
  return markers;
}

/// A homography from the markers nearest to a place of the board; and how well it fits them, px.
struct LocalMap {
  cv::Mat homography;
  double worst_px = 1e9;
};

LocalMap local_map(std::vector<const Marker*> markers, const Eigen::Vector2d& place, std::size_t most) {
  std::sort(markers.begin(), markers.end(), [&place](const Marker* a, const Marker* b) {
    const auto distance = [&place](const Marker* m) {
      return (m->square.cast<double>() + Eigen::Vector2d(0.5, 0.5) - place).squaredNorm();
    };
    return distance(a) < distance(b);
  });
  markers.resize(std::min(markers.size(), most));
  std::vector<cv::Point2f> from, to, mapped;
  for (const Marker* marker : markers) {
    from.insert(from.end(), marker->board.begin(), marker->board.end());
    to.insert(to.end(), marker->pixel_px.begin(), marker->pixel_px.end());
  }
  LocalMap map;
  map.homography = cv::findHomography(from, to);
  if (map.homography.empty()) return map;
  cv::perspectiveTransform(from, mapped, map.homography);
  map.worst_px = 0;
  for (std::size_t i = 0; i < to.size(); ++i)
    map.worst_px = std::max(map.worst_px, cv::norm(mapped[i] - to[i]));
  return map;
}

/// The median misfit of each marker with its nearest neighbours: large where the layout is the wrong one.
double misfit_px(const std::vector<Marker>& markers) {
  std::vector<const Marker*> all;
  std::vector<double> misfits;
  all.reserve(markers.size());
  misfits.reserve(markers.size());
  for (const Marker& m : markers) all.push_back(&m);
  for (const Marker& m : markers)
    misfits.push_back(local_map(all, m.square.cast<double>() + Eigen::Vector2d(0.5, 0.5), 4).worst_px);
  if (misfits.empty()) return 1e9;
  std::nth_element(misfits.begin(), misfits.begin() + static_cast<std::ptrdiff_t>(misfits.size() / 2),
                   misfits.end());
  return misfits[misfits.size() / 2];
}

/// The inner corners that touch a found marker.
Lattice corners_beside(const std::vector<Marker>& markers, const Pattern& pattern, const cv::Mat& grey) {
  cv::Mat grey8, smoothed;
  grey.convertTo(grey8, CV_8U);
  cv::GaussianBlur(grey, smoothed, {}, 1.0);
  std::vector<const Marker*> all;
  std::set<std::pair<int, int>> wanted;
  for (const Marker& m : markers) {
    all.push_back(&m);
    for (const int dx : {0, 1})
      for (const int dy : {0, 1}) wanted.insert({m.square.x() + dx, m.square.y() + dy});
  }
  Lattice lattice;
  for (const auto& corner : wanted) {
    const int x = corner.first, y = corner.second;
    if (x < 1 || y < 1 || x >= pattern.columns || y >= pattern.rows) continue;
    const LocalMap map = local_map(all, Eigen::Vector2d(x, y), 4);
    if (map.homography.empty()) continue;
    std::vector<cv::Point2f> point{{static_cast<float>(x), static_cast<float>(y)}},
        beside{{static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F}}, mapped, middle;
    cv::perspectiveTransform(point, mapped, map.homography);
    cv::perspectiveTransform(beside, middle, map.homography);
    const double square_px = 1.41 * cv::norm(middle[0] - mapped[0]);
    const double gap_px = square_px * (1 - pattern.marker_mm / pattern.spacing_mm) / 2;
    if (!cv::Rect(4, 4, grey8.cols - 8, grey8.rows - 8).contains(cv::Point(mapped[0])) || square_px < 4)
      continue;
    const Eigen::Vector2d expected(mapped[0].x, mapped[0].y);
    // The window stays between the corner and the markers' black rims.
    const int window = std::clamp(static_cast<int>(std::max(0.9 * gap_px, 2.0)), 2, 11);
    cv::cornerSubPix(grey8, mapped, {window, window}, {-1, -1},
                     {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 60, 1e-4});
    const Eigen::Vector2d found(mapped[0].x, mapped[0].y);
    if ((found - expected).norm() > std::max(2.0, 0.15 * square_px)) continue;
    lattice[{x - 1, y - 1}] = found;
  }
  return lattice;
}

int dictionary_of(const std::string& name) {
  for (const auto& [known, number] : kDictionaries)
    if (name == known) return number;
  return -1;
}

}  // namespace

BoardView find_charuco(const cv::Mat& picture, const Pattern& pattern) {
  BoardView view;
  const int dictionary = dictionary_of(pattern.dictionary);
  if (dictionary < 0) {
    view.remark = "the dictionary " + pattern.dictionary +
                  " is not known; 4X4_50 to 7X7_1000 and ARUCO_ORIGINAL are accepted";
    return view;
  }
  const cv::Mat grey = grey_of(picture);
  cv::Mat grey8;
  grey.convertTo(grey8, CV_8U);
  const auto parameters = cv::aruco::DetectorParameters::create();
  parameters->adaptiveThreshWinSizeMax = 53;
  parameters->adaptiveThreshWinSizeStep = 10;
  parameters->minMarkerPerimeterRate = 0.012;
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
  cv::aruco::detectMarkers(grey8, cv::aruco::getPredefinedDictionary(dictionary), corners, ids, parameters);
  if (ids.size() < 4) {
    view.remark = std::to_string(ids.size()) + " markers of the dictionary " + pattern.dictionary +
                  " are seen; four or more are accepted";
    return view;
  }
  auto markers = placed(pattern, pattern.legacy_first, ids, corners);
  auto others = placed(pattern, !pattern.legacy_first, ids, corners);
  const double misfit = misfit_px(markers), other_misfit = misfit_px(others);
  if (pattern.rows % 2 == 0 && other_misfit < 0.5 * misfit) {
    markers = std::move(others);
    view.remark =
        pattern.legacy_first ? "laid out as since OpenCV 4.6" : "laid out as before OpenCV 4.6 (legacy)";
  }
  if (std::min(misfit, other_misfit) > 0.02 * std::hypot(picture.cols, picture.rows)) {
    view.remark = "the markers do not lie where " + text_of(pattern) + " has them";
    return view;
  }
  Lattice lattice = corners_beside(markers, pattern, grey);
  prune(lattice);
  if (lattice.size() < 6) {
    view.remark = "fewer than six corners of the board are seen";
    return view;
  }
  const LatticeSize size = size_of(lattice);
  view.columns = size.columns, view.rows = size.rows;
  view.anchor = Anchor::sure;
  view.corners = corners_of(lattice, pattern);
  return view;
}

}  // namespace orcart
