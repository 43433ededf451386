// Where the demo's files lie: beside the installed program, or in the source tree it was built in.
#pragma once

#include <filesystem>
#include <string>

#include "realtime/base/result.hpp"

namespace orcart {

/// The nearest of PREFIX/share/orcart and PREFIX/share that holds the demo's surfaces, PREFIX being each
/// folder above `program`; empty where there is none.
std::filesystem::path share_folder(const std::filesystem::path& program);

/// This program's own file.
std::filesystem::path this_program();

/// One of the demo's files, as share/ names it; fails where that is not installed beside this program.
Result<std::filesystem::path> demo_file(const std::string& name);

/// The files that an evaluation needs; an empty path was not told.
struct EvaluatedFiles {
  std::filesystem::path &surface, &scope, &registration, &scope_rom, &reference_rom;
};
/// Of the patient (surface, registration and the reference's markers) and of the scope (passport and its
/// markers) either all were told, or none and the demo's are taken: the parts of one are true of each other
/// only. Refuses a part of either with what is missing. Gives what was taken, in words; empty: nothing.
Result<std::string> take_demo_files(const EvaluatedFiles& files);

}  // namespace orcart
