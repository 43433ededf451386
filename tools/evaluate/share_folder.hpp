// Where the demo's files lie: beside the installed program, or in the source tree it was built in.
#pragma once

#include <filesystem>

namespace orcart {

/// The nearest of PREFIX/share/orcart and PREFIX/share that holds the demo's surfaces, PREFIX being each
/// folder above `program`; empty where there is none.
std::filesystem::path share_folder(const std::filesystem::path& program);

/// This program's own file.
std::filesystem::path this_program();

}  // namespace orcart
