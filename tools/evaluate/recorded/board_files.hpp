// What was painted, as files that `orcart paint` reads.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/evaluate/recorded/board_mapping.hpp"

namespace orcart {

/// DIR/board.ply, and for the n-th view DIR/view-n/scope.toml and views.csv, whose line names the picture
/// where it lies: `orcart paint` gives the very painting that was measured.
Result<void> write_board_files(const std::filesystem::path& dir, const PlaneExtent& extent,
                               const std::vector<LeftOut>& left_out);

}  // namespace orcart
