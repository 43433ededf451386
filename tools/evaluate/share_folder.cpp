// Upwards from the program, folder by folder.
#include "tools/evaluate/share_folder.hpp"

#include <initializer_list>
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

namespace {

struct Part {
  std::filesystem::path* file;
  const char *option, *demo;
};

/// All of a whole, or none and the demo's: then `taken` names them.
Result<void> take_whole(std::initializer_list<Part> whole, std::string& taken) {
  std::string told, missing;
  for (const Part& part : whole) {
    std::string& list = part.file->empty() ? missing : told;
    list += (list.empty() ? "" : ", ") + std::string(part.option);
  }
  if (missing.empty()) return {};
  if (!told.empty())
    return fail(told + " without " + missing +
                ": they belong together, and the demo's would be another's; all of them, or none for the "
                "demo's, are accepted");
  for (const Part& part : whole) {
    auto file = demo_file(part.demo);
    if (!file) return tl::unexpected(file.error());
    *part.file = *std::move(file);
    taken += (taken.empty() ? "" : ", ") + std::string(part.demo);
  }
  return {};
}

}  // namespace

Result<std::filesystem::path> demo_file(const std::string& name) {
  const std::filesystem::path share = share_folder(this_program());
  if (share.empty())
    return fail("the demo's " + name +
                " is not installed beside this program; files of your own are accepted");
  return share / name;
}

Result<std::string> take_demo_files(const EvaluatedFiles& files) {
  std::string taken;
  auto patient = take_whole({{&files.surface, "--surface", "surfaces/ventricle.ply"},
                             {&files.registration, "--registration", "carts/demo-registration.toml"},
                             {&files.reference_rom, "--reference-rom", "tools/reference.rom"}},
                            taken);
  if (!patient) return tl::unexpected(patient.error());
  auto scope = take_whole({{&files.scope, "--scope", "scopes/neuro-2p7.toml"},
                           {&files.scope_rom, "--scope-rom", "tools/scope.rom"}},
                          taken);
  if (!scope) return tl::unexpected(scope.error());
  return taken;
}

}  // namespace orcart
