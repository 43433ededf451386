// Segments from the loader's list, names from the symbol tables.
#include "tools/guards/code_map.hpp"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace orcart::guards {
namespace {

constexpr std::array<std::string_view, 8> kRuntime{"libc.so",  "libm.so",    "libstdc++.so", "libgcc_s.so",
                                                   "ld-linux", "linux-vdso", "libpthread",   "libdl.so"};

std::string_view base_of(std::string_view path) {
  const auto slash = path.rfind('/');
  return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

struct Object {
  std::string name;  ///< empty: the program
  std::vector<std::pair<std::uintptr_t, std::uintptr_t>> code;
};

int note_object(dl_phdr_info* info, std::size_t, void* into) {
  Object object{.name = std::string(base_of(info->dlpi_name)), .code = {}};
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& header = info->dlpi_phdr[i];
    if (header.p_type != PT_LOAD || (header.p_flags & PF_X) == 0) continue;
    const std::uintptr_t from = info->dlpi_addr + header.p_vaddr;
    object.code.emplace_back(from, from + header.p_memsz);
  }
  static_cast<std::vector<Object>*>(into)->push_back(std::move(object));
  return 0;
}

struct CloseFile {
  void operator()(std::FILE* file) const { pclose(file); }
};

/// The return address lies behind the call; one byte before it is inside.
std::size_t offset_in_program(const Dl_info& info, const void* address) {
  return reinterpret_cast<std::uintptr_t>(address) - reinterpret_cast<std::uintptr_t>(info.dli_fbase) - 1;
}

/// "function at file:line" for each offset, functions that were inlined there on lines of their own; empty
/// where addr2line is missing.
std::vector<std::string> source_lines(const std::vector<std::size_t>& offsets) {
  std::error_code error;
  std::string command =
      "addr2line -s -f -C -i -p -e '" + std::filesystem::read_symlink("/proc/self/exe", error).string() + "'";
  char part[32];
  for (const std::size_t offset : offsets) {
    std::snprintf(part, sizeof part, " 0x%zx", offset);
    command += part;
  }
  const std::unique_ptr<std::FILE, CloseFile> pipe(popen((command + " 2>/dev/null").c_str(), "re"));
  std::vector<std::string> answers;
  char line[1024];
  while (pipe && std::fgets(line, sizeof line, pipe.get()) != nullptr) {
    const bool inlined = std::string_view(line).starts_with(" (inlined by)");
    if (inlined && !answers.empty())
      answers.back() += std::string("  ") + line;
    else
      answers.push_back(std::string("  ") + line);
  }
  return answers.size() == offsets.size() ? answers : std::vector<std::string>(offsets.size());
}

}  // namespace

void CodeMap::refresh() {
  std::vector<Object> objects;
  dl_iterate_phdr(note_object, &objects);
  segments_.clear();
  names_.clear();
  for (const Object& object : objects) {
    Place place{.origin = Origin::program, .library = 0};
    if (!object.name.empty()) {
      const bool runtime = std::ranges::any_of(
          kRuntime, [&](std::string_view begin) { return std::string_view(object.name).starts_with(begin); });
      place.origin = runtime ? Origin::runtime : Origin::library;
      if (!runtime) {
        place.library = static_cast<std::uint16_t>(names_.size());
        names_.push_back(object.name.substr(0, object.name.find(".so")));
      }
    }
    for (const auto& [from, until] : object.code) segments_.push_back({from, until, place});
  }
  std::ranges::sort(segments_, {}, &Segment::from);
}

Place CodeMap::of(const void* address) const noexcept {
  const auto at = reinterpret_cast<std::uintptr_t>(address);
  const auto after = std::ranges::upper_bound(segments_, at, {}, &Segment::from);
  if (after == segments_.begin()) return {};
  const Segment& segment = *(after - 1);
  return at < segment.until ? segment.place : Place{};
}

Place CodeMap::blamed(std::span<void* const> stack) const noexcept {
  for (void* const frame : stack) {
    const Place place = of(frame);
    if (place.origin != Origin::runtime) return place;
  }
  return {.origin = Origin::program, .library = 0};
}

std::string words_for(std::span<void* const> stack, std::size_t most_frames) {
  const CodeMap code;
  std::vector<std::string> words;
  std::vector<std::size_t> offsets, places;
  for (std::size_t i = 0; i < stack.size() && words.size() < most_frames; ++i) {
    const Place place = code.of(stack[i]);
    if (place.origin == Origin::runtime) continue;
    Dl_info info{};
    const bool known = dladdr(stack[i], &info) != 0;
    if (place.origin == Origin::program && known) {
      offsets.push_back(offset_in_program(info, stack[i]));
      places.push_back(words.size());
      char text[40];
      std::snprintf(text, sizeof text, "  program+0x%zx\n", offsets.back());
      words.emplace_back(text);
    } else if (place.origin == Origin::library) {
      const bool named = known && info.dli_sname != nullptr;
      words.push_back("  " + std::string(code.name_of(place.library)) +
                      (named ? std::string(": ") + info.dli_sname : "") + "\n");
    }
  }
  if (!offsets.empty()) {
    const std::vector<std::string> lines = source_lines(offsets);
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (!lines[i].empty()) words[places[i]] = lines[i];
  }
  std::string text;
  for (const std::string& line : words) text += line;
  return text;
}

}  // namespace orcart::guards
