// Where the demo's files lie: beside the installed program, or in the source tree it was built in.
#pragma once

#include <filesystem>

#include "realtime/base/result.hpp"

namespace orcart {

/// The nearest of PREFIX/share/orcart and PREFIX/share that holds the demo's surfaces, PREFIX being each
/// folder above `program`; empty where there is none.
std::filesystem::path share_folder(const std::filesystem::path& program);

/// This program's own file.
std::filesystem::path this_program();

/// The files that an evaluation needs; an empty path was not told.
struct EvaluatedFiles {
  std::filesystem::path &surface, &scope, &registration, &scope_rom, &reference_rom;
};
/// What was not told becomes the demo's; fails where that is not installed beside this program.
Result<void> take_demo_files(const EvaluatedFiles& files);

}  // namespace orcart
