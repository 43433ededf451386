// Upwards from the program, folder by folder.
#include "tools/evaluate/share_folder.hpp"

#include <system_error>

namespace orcart {

std::filesystem::path share_folder(const std::filesystem::path& program) {
  std::error_code error;
  for (auto prefix = program.parent_path(); !prefix.empty(); prefix = prefix.parent_path()) {
    for (const char* inside : {"share/orcart", "share"})
      if (std::filesystem::is_directory(prefix / inside / "surfaces", error) &&
          std::filesystem::is_directory(prefix / inside / "scopes", error))
        return prefix / inside;
    if (prefix == prefix.root_path()) break;
  }
  return {};
}

std::filesystem::path this_program() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error);
}

}  // namespace orcart
