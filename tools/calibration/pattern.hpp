// The calibration pattern a person printed, as typed on the command line: chessboard, ChArUco board or grid
// of dots.
#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>

#include "realtime/base/result.hpp"

namespace orcart {

enum class PatternKind { chessboard, charuco, dots };

/// Chessboards and dots count inner corners and dots, ChArUco boards squares. Lengths in millimetres.
struct Pattern {
  PatternKind kind = PatternKind::chessboard;
  int columns = 0, rows = 0;
  double spacing_mm = 0;      ///< side of a square, or from dot to dot
  double marker_mm = 0;       ///< ChArUco only: side of a marker
  std::string dictionary;     ///< ChArUco only, e.g. "4X4_250"
  bool legacy_first = false;  ///< ChArUco only: which layout is tried first; both are

  /// How many columns and rows of corners or dots a whole view shows.
  int corner_columns() const { return kind == PatternKind::charuco ? columns - 1 : columns; }
  int corner_rows() const { return kind == PatternKind::charuco ? rows - 1 : rows; }
  /// A corner's place on the board, mm, z = 0.
  Eigen::Vector3d place_mm(const Eigen::Vector2i& lattice) const {
    return {lattice.x() * spacing_mm, lattice.y() * spacing_mm, 0};
  }
};

/// chessboard:14x10:3mm | charuco:19x26:5mm:4mm:4X4_250[:legacy] | dots:16x14:4mm. Refuses everything else
/// with what would be accepted; lengths need their unit mm, so that metres are not taken for millimetres.
Result<Pattern> parse_pattern(std::string_view text);

/// The pattern as it would be typed.
std::string text_of(const Pattern& pattern);

}  // namespace orcart
