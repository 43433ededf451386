// Upwards from the program, folder by folder.
#include "tools/evaluate/share_folder.hpp"

#include <array>
#include <string>
#include <system_error>
#include <utility>

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

Result<void> take_demo_files(const EvaluatedFiles& files) {
  const std::filesystem::path share = share_folder(this_program());
  const std::array<std::pair<std::filesystem::path*, const char*>, 5> demo{
      {{&files.surface, "surfaces/ventricle.ply"},
       {&files.scope, "scopes/neuro-2p7.toml"},
       {&files.registration, "carts/demo-registration.toml"},
       {&files.scope_rom, "tools/scope.rom"},
       {&files.reference_rom, "tools/reference.rom"}}};
  for (const auto& [file, name] : demo) {
    if (!file->empty()) continue;
    if (share.empty())
      return fail(
          std::string("the demo's ") + name +
          " is not installed beside this program; --surface, --scope, --registration, --scope-rom and "
          "--reference-rom are accepted");
    *file = share / name;
  }
  return {};
}

}  // namespace orcart
