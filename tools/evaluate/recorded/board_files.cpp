// The formats' own writers, and views.csv line by line.
#include "tools/evaluate/recorded/board_files.hpp"

#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "firmware-host/files/whole_file.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

std::string line_of(const LeftOut& one) {
  std::string name = "\"";
  for (const char c : std::filesystem::absolute(one.view.image).lexically_normal().string())
    name += c == '"' ? std::string("\"\"") : std::string(1, c);
  std::string line = name + "\"";
  const Pose<M, C>& X = one.posed.X_MC;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      line += json::format(",%.17g", column < 3 ? X.rotation(row, column) : X.translation_mm[row]);
  return line + "\n";
}

}  // namespace

Result<void> write_board_files(const std::filesystem::path& dir, const PlaneExtent& extent,
                               const std::vector<LeftOut>& left_out) {
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    const auto folder = dir / ("view-" + std::to_string(i + 1));
    std::error_code trouble;
    std::filesystem::create_directories(folder, trouble);
    if (trouble) return fail(folder.string() + ": cannot be made: " + trouble.message());
    if (auto written = write_scope(folder / "scope.toml", left_out[i].scope); !written) return written;
    if (auto written = write_whole_file(folder / "views.csv", line_of(left_out[i])); !written) return written;
  }
  return write_ply(dir / "board.ply", plane_surface(extent));
}

}  // namespace orcart
