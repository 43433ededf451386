// Growth by prediction: a corner's neighbour is expected where its own neighbours' steps lead, and must be
// near there.
#include "tools/calibration/lattice.hpp"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <numbers>
#include <optional>
#include <queue>
#include <set>

#include <Eigen/QR>

#include "tools/calibration/point_buckets.hpp"

namespace orcart {
namespace {

using Place = std::pair<int, int>;
constexpr std::array<Place, 4> kSteps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

Place plus(Place a, Place b) {
  return {a.first + b.first, a.second + b.second};
}
Place minus(Place a, Place b) {
  return {a.first - b.first, a.second - b.second};
}

/// Between two lines, 0..pi/2.
double line_angle(double a, double b) {
  const double turn = std::fmod(std::abs(a - b), std::numbers::pi);
  return std::min(turn, std::numbers::pi - turn);
}

double angle_of(const Eigen::Vector2d& v) {
  return std::atan2(v.y(), v.x());
}

class Growth {
 public:
  explicit Growth(const std::vector<LatticePoint>& points) : points_(points), buckets_(points) {}

  Lattice from(std::size_t seed) {
    taken_.clear();
    chosen_.clear();
    lattice_.clear();
    take({0, 0}, seed);
    if (!first_ring(seed)) return {};
    spread();
    return lattice_;
  }

 private:
  void take(Place place, std::size_t index) {
    lattice_[place] = points_[index].pixel_px;
    chosen_[place] = index;
    taken_.insert(index);
    queue_.push(place);
  }

  /// On a chessboard bright sectors swap with dark ones from corner to corner.
  bool may_neighbour(std::size_t a, std::size_t b) const {
    if (!points_[a].oriented) return true;
    return line_angle(points_[a].bright_axis_rad, points_[b].bright_axis_rad) > 0.6;
  }

  /// The nearest point in a direction, within `spread_rad` of it.
  std::optional<std::size_t> along(std::size_t from, const Eigen::Vector2d& direction,
                                   double spread_rad) const {
    std::optional<std::size_t> best;
    double best_px = 1e9;
    for (const std::size_t i : buckets_.nearest(points_[from].pixel_px, 24)) {
      const Eigen::Vector2d step = points_[i].pixel_px - points_[from].pixel_px;
      const double length = step.norm();
      if (i == from || length < 3 || length >= best_px || !may_neighbour(from, i)) continue;
      if (std::acos(std::clamp(step.dot(direction) / length, -1.0, 1.0)) > spread_rad) continue;
      if (points_[i].oriented && std::min(line_angle(points_[i].edges_rad[0], angle_of(step)),
                                          line_angle(points_[i].edges_rad[1], angle_of(step))) > 0.4)
        continue;
      best = i;
      best_px = length;
    }
    return best;
  }

  /// The two directions of the lattice at a seed.
  std::optional<std::array<Eigen::Vector2d, 2>> axes(std::size_t seed) const {
    const LatticePoint& p = points_[seed];
    if (p.oriented)
      return std::array{Eigen::Vector2d(std::cos(p.edges_rad[0]), std::sin(p.edges_rad[0])),
                        Eigen::Vector2d(std::cos(p.edges_rad[1]), std::sin(p.edges_rad[1]))};
    const auto near = buckets_.nearest(p.pixel_px, 9);
    if (near.size() < 5) return std::nullopt;
    const Eigen::Vector2d first = (points_[near[1]].pixel_px - p.pixel_px).normalized();
    for (std::size_t i = 2; i < near.size(); ++i) {
      const Eigen::Vector2d second = (points_[near[i]].pixel_px - p.pixel_px).normalized();
      if (std::abs(first.dot(second)) < 0.65) return std::array{first, second};
    }
    return std::nullopt;
  }

  /// The four neighbours of the seed; three at least must be there and agree in length.
  bool first_ring(std::size_t seed) {
    auto directions = axes(seed);
    if (!directions) return false;
    auto& [u, v] = *directions;
    if (u.x() * v.y() - u.y() * v.x() < 0) v = -v;
    const std::array<Eigen::Vector2d, 4> around{u, v, -u, -v};
    int found = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto neighbour = along(seed, around[i], 0.45);
      if (!neighbour || taken_.contains(*neighbour)) continue;
      take(kSteps[i], *neighbour);
      ++found;
    }
    for (const Place& step : {Place{1, 0}, Place{0, 1}}) {
      const auto a = lattice_.find(step), b = lattice_.find(minus({0, 0}, step));
      if (a == lattice_.end() || b == lattice_.end()) continue;
      const double one = (a->second - lattice_[{0, 0}]).norm(), other = (b->second - lattice_[{0, 0}]).norm();
      if (one > 1.7 * other || other > 1.7 * one) return false;
    }
    return found >= 3;
  }

  void spread() {
    for (int rounds = 0; rounds < 200'000 && !queue_.empty(); ++rounds) {
      const Place here = queue_.front();
      queue_.pop();
      for (const Place& step : kSteps) extend(here, step);
    }
  }

  void extend(Place here, Place step) {
    const Place place = plus(here, step);
    if (lattice_.contains(place)) return;
    const auto expected = predicted(lattice_, place);
    if (!expected) return;
    const double length = (*expected - lattice_[here]).norm();
    const auto nearest = buckets_.nearest(*expected, 1);
    if (nearest.empty() || taken_.contains(nearest.front()) || length < 3) return;
    if ((points_[nearest.front()].pixel_px - *expected).norm() > std::max(1.5, 0.28 * length)) return;
    if (!may_neighbour(chosen_[here], nearest.front())) return;
    take(place, nearest.front());
  }

  const std::vector<LatticePoint>& points_;
  PointBuckets buckets_;
  Lattice lattice_;
  std::map<Place, std::size_t> chosen_;
  std::set<std::size_t> taken_;
  std::queue<Place> queue_;
};

/// How far a point lies from where its neighbours put it, in steps; 0 where they say nothing.
double contradiction(const Lattice& lattice, const Lattice::value_type& node) {
  double worst = 0;
  for (const Place& step : {Place{1, 0}, Place{0, 1}}) {
    const auto a = lattice.find(plus(node.first, step)), b = lattice.find(minus(node.first, step));
    if (a == lattice.end() || b == lattice.end()) continue;
    const double length = 0.5 * (a->second - b->second).norm();
    worst = std::max(worst, (0.5 * (a->second + b->second) - node.second).norm() / length);
  }
  return worst;
}

void keep_largest_part(Lattice& lattice) {
  std::set<Place> seen, best;
  for (const auto& [start, unused] : lattice) {
    if (seen.contains(start)) continue;
    std::set<Place> part{start};
    std::queue<Place> queue({start});
    while (!queue.empty()) {
      for (const Place& step : kSteps) {
        const Place next = plus(queue.front(), step);
        if (lattice.contains(next) && part.insert(next).second) queue.push(next);
      }
      queue.pop();
    }
    seen.insert(part.begin(), part.end());
    if (part.size() > best.size()) best = std::move(part);
  }
  std::erase_if(lattice, [&best](const auto& node) { return !best.contains(node.first); });
}

}  // namespace

LatticeSize size_of(const Lattice& lattice) {
  if (lattice.empty()) return {};
  int left = INT_MAX, right = INT_MIN, top = INT_MAX, bottom = INT_MIN;
  for (const auto& [place, unused] : lattice) {
    left = std::min(left, place.first);
    right = std::max(right, place.first);
    top = std::min(top, place.second);
    bottom = std::max(bottom, place.second);
  }
  return {.columns = right - left + 1, .rows = bottom - top + 1, .first_column = left, .first_row = top};
}

std::optional<Eigen::Vector2d> predicted(const Lattice& lattice, Place place) {
  // A plane, or with enough neighbours a paraboloid, through the places of the nearest known corners.
  std::vector<std::pair<Place, Eigen::Vector2d>> near;
  const auto collect = [&](int reach) {
    near.clear();
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i)
        if (const auto node = lattice.find(plus(place, {i, j})); node != lattice.end() && (i != 0 || j != 0))
          near.emplace_back(Place{i, j}, node->second);
  };
  collect(2);
  const bool curved = near.size() >= 9;
  if (near.size() < 3) return std::nullopt;
  const Eigen::Index terms = curved ? 6 : 3;
  Eigen::MatrixXd a(near.size(), terms);
  Eigen::MatrixXd b(near.size(), 2);
  for (std::size_t k = 0; k < near.size(); ++k) {
    const double i = near[k].first.first, j = near[k].first.second;
    const double weight = 1 / (i * i + j * j);
    const auto row = static_cast<Eigen::Index>(k);
    a(row, 0) = weight, a(row, 1) = weight * i, a(row, 2) = weight * j;
    if (curved) a(row, 3) = weight * i * i, a(row, 4) = weight * i * j, a(row, 5) = weight * j * j;
    b.row(row) = weight * near[k].second.transpose();
  }
  auto solver = a.colPivHouseholderQr();
  solver.setThreshold(1e-6);
  if (solver.rank() < terms) {
    if (!curved) return std::nullopt;
    solver = a.leftCols(3).colPivHouseholderQr();
    solver.setThreshold(1e-6);
    if (solver.rank() < 3) return std::nullopt;
  }
  const Eigen::MatrixXd fitted = solver.solve(b);
  return Eigen::Vector2d(fitted(0, 0), fitted(0, 1));
}

void prune(Lattice& lattice) {
  for (int round = 0; round < 3; ++round) {
    const Lattice before = lattice;
    std::erase_if(lattice, [&before](const auto& node) { return contradiction(before, node) > 0.25; });
    if (lattice.size() == before.size()) break;
  }
  keep_largest_part(lattice);
}

Lattice turned(const Lattice& lattice, int quarter_turns) {
  Lattice result = lattice;
  for (int turn = 0; turn < (quarter_turns % 4 + 4) % 4; ++turn) {
    Lattice next;
    for (const auto& [place, pixel] : result) next[{-place.second, place.first}] = pixel;
    result = std::move(next);
  }
  const LatticeSize size = size_of(result);
  Lattice moved;
  for (const auto& [place, pixel] : result) moved[minus(place, {size.first_column, size.first_row})] = pixel;
  return moved;
}

Lattice grow_lattice(const std::vector<LatticePoint>& points, std::size_t enough) {
  constexpr std::size_t kMostSeeds = 400, kMostTorn = 24;
  Growth growth(points);
  Lattice best;
  std::set<std::pair<double, double>> covered;
  std::size_t tried = 0, torn = 0;
  bool whole = false;  // of the best
  for (std::size_t seed = 0; seed < points.size() && tried < kMostSeeds; ++seed) {
    if (covered.contains({points[seed].pixel_px.x(), points[seed].pixel_px.y()})) continue;
    ++tried;
    Lattice lattice = growth.from(seed);
    if (lattice.size() < 9) continue;
    const Lattice grown = lattice;
    prune(lattice);
    // A seed whose ring was wrong grows a lattice that is torn where its two halves meet; another may grow it
    // whole.
    const bool sound = 20 * (grown.size() - lattice.size()) <= grown.size();
    if (sound || ++torn > kMostTorn)
      for (const auto& [place, pixel] : grown) covered.insert({pixel.x(), pixel.y()});
    if (lattice.size() > best.size()) {
      best = std::move(lattice);
      whole = sound;
    }
    if (best.size() >= enough || (whole && 2 * best.size() > points.size())) break;
  }
  const LatticeSize size = size_of(best);
  return size.columns >= 3 && size.rows >= 3 ? best : Lattice{};
}

}  // namespace orcart
