// Lattices over dots that a tilted board shows, some of them hidden.
#include "tools/calibration/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tools/calibration/lattice_sides.hpp"

namespace orcart {
namespace {

struct Dot {
  Eigen::Vector2d pixel_px;
  int column = 0, row = 0;
};

/// A board of 25x18 dots, one of twenty hidden, from 110 mm; `tilt_rad` about an axis of chance.
std::vector<Dot> dots_seen(double tilt_rad, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  const double spin = 3.14 * any(random), axis = 3.14 * any(random);
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d(std::cos(axis), std::sin(axis), 0)) *
       Eigen::AngleAxisd(spin, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  std::vector<Dot> dots;
  for (int row = 0; row < 18; ++row)
    for (int column = 0; column < 25; ++column) {
      const Eigen::Vector3d at =
          turn * Eigen::Vector3d(5 * (column - 12), 5 * (row - 8.5), 0) + Eigen::Vector3d(0, 0, 110);
      const Eigen::Vector2d pixel(960 + 1750 * at.x() / at.z(), 540 + 1750 * at.y() / at.z());
      const bool within = pixel.x() > 5 && pixel.y() > 5 && pixel.x() < 1915 && pixel.y() < 1075;
      if (within && any(random) < 0.9) dots.push_back({.pixel_px = pixel, .column = column, .row = row});
    }
  std::sort(dots.begin(), dots.end(),
            [](const Dot& a, const Dot& b) { return a.pixel_px.y() > b.pixel_px.y(); });
  return dots;
}

Lattice lattice_of(const std::vector<Dot>& dots) {
  std::vector<LatticePoint> points;
  for (const Dot& dot : dots) points.push_back({.pixel_px = dot.pixel_px, .strength = 1});
  return grow_lattice(points, 450);
}

/// Whether neighbours in the lattice are neighbours on the board, but for strays at its rim.
bool goes_along_sides(const Lattice& lattice, const std::vector<Dot>& dots) {
  const auto dot_at = [&](const Eigen::Vector2d& pixel) {
    return *std::find_if(dots.begin(), dots.end(), [&](const Dot& d) { return d.pixel_px == pixel; });
  };
  int wrong = 0;
  for (const auto& [place, pixel] : lattice)
    for (const auto& step : {std::pair{1, 0}, {0, 1}}) {
      const auto next = lattice.find({place.first + step.first, place.second + step.second});
      if (next == lattice.end()) continue;
      const Dot a = dot_at(pixel), b = dot_at(next->second);
      wrong += std::abs(a.column - b.column) + std::abs(a.row - b.row) == 1 ? 0 : 1;
    }
  return wrong < 0.02 * static_cast<double>(lattice.size() * 2);
}

TEST(Lattice, DotsOfATiltedBoardAreCountedAlongItsSides) {
  int sheared = 0, wrong = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const auto dots = dots_seen(0.3 + 0.01 * seed, seed);
    Lattice lattice = lattice_of(dots);
    sheared += goes_along_sides(lattice, dots) ? 0 : 1;
    count_along_sides(lattice, {1920, 1080});
    wrong += goes_along_sides(lattice, dots) ? 0 : 1;
  }
  EXPECT_GT(sheared, 5) << "diagonals do look shorter than sides here";
  EXPECT_LE(wrong, 1);
}

TEST(Lattice, HiddenDotsSeldomTearIt) {
  int torn = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const auto dots = dots_seen(0.5, seed);
    torn += lattice_of(dots).size() < 0.85 * static_cast<double>(dots.size()) ? 1 : 0;
  }
  EXPECT_LE(torn, 3);
}

}  // namespace
}  // namespace orcart
