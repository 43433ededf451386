// Grows a lattice over corners or dots from a seed, neighbour by neighbour, so that parts of a board are
// enough.
#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "tools/calibration/saddle_points.hpp"

namespace orcart {

/// Columns and rows (i, j) that are taken, each with a place in the picture; i to j turns as x to y does
/// (clockwise as seen), so a lattice is never mirrored.
using Lattice = std::map<std::pair<int, int>, Eigen::Vector2d>;

struct LatticeSize {
  int columns = 0, rows = 0;
  int first_column = 0, first_row = 0;
};
LatticeSize size_of(const Lattice& lattice);

/// The largest lattice that the points hold, single points that hang loosely taken off. Stops early at one of
/// `enough` points. Empty where nothing of 3 by 3 is found.
Lattice grow_lattice(const std::vector<LatticePoint>& points, std::size_t enough);

/// Where (i, j) should lie, from the neighbours that are known; nothing where they are too few or on one
/// line.
std::optional<Eigen::Vector2d> predicted(const Lattice& lattice, std::pair<int, int> place);

/// Drops points that their neighbours contradict, then all but the largest connected part.
void prune(Lattice& lattice);

/// The lattice turned by quarter turns (clockwise as seen) and moved so that (0, 0) is its upper left corner.
Lattice turned(const Lattice& lattice, int quarter_turns);

}  // namespace orcart
