// The tables of allowed edges, fenced headers and forbidden words, and the reader that applies them line by
// line.
#include "tests/tools/layers/layer_rules.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <optional>

namespace orcart::layers {
namespace {

using Paths = std::initializer_list<std::string_view>;

bool is_inside(std::string_view path, std::string_view folder) {
  return path.starts_with(folder) && (path.size() == folder.size() || path[folder.size()] == '/');
}

bool is_inside_any(std::string_view path, Paths folders) {
  return std::ranges::any_of(folders, [&](std::string_view folder) { return is_inside(path, folder); });
}

constexpr std::array<std::string_view, 6> kRooms{"realtime",      "board", "render",
                                                 "firmware-host", "tools", "tests"};

/// The most specific entry that holds a folder says all it may include beside itself.
struct Edges {
  std::string_view from;
  Paths to;
};
const std::initializer_list<Edges> kEdges{
    {"realtime/base", {}},
    {"realtime/kernel", {"realtime/base"}},
    {"realtime/geometry", {"realtime/base"}},
    {"realtime/optics", {"realtime/base", "realtime/kernel", "realtime/geometry"}},
    {"realtime/registration", {"realtime/base", "realtime/kernel", "realtime/geometry"}},
    {"realtime/sync",
     {"realtime/base", "realtime/kernel", "realtime/geometry", "realtime/optics", "realtime/registration"}},
    {"realtime/mapper",
     {"realtime/base", "realtime/kernel", "realtime/geometry", "realtime/optics", "realtime/registration"}},
    {"board/ports", {"realtime"}},
    {"board/linux", {"realtime", "board/ports"}},
    {"board/sim", {"realtime", "board/ports"}},
    {"render", {"realtime", "render"}},
    {"firmware-host/app", {"realtime", "render", "board", "firmware-host"}},
    {"firmware-host", {"realtime", "render", "board/ports", "firmware-host"}},
    {"tools", {"realtime", "render", "board", "firmware-host", "tools"}},
    {"tests", {"realtime", "render", "board", "firmware-host", "tools", "tests"}},
};

/// A library's headers, by how their names begin, and the folders that alone may include them.
struct Fence {
  std::string_view library;
  Paths headers;
  Paths folders;
};
const std::initializer_list<Fence> kFences{
    {"libusb", {"libusb"}, {"board/linux", "tests/board/linux"}},
    {"libgpiod", {"gpiod.", "linux/gpio.h"}, {"board/linux", "tests/board/linux"}},
    {"V4L2", {"linux/videodev2.h", "linux/media"}, {"board/linux", "tests/board/linux"}},
    {"DRM", {"drm", "libdrm/", "xf86drm"}, {"board/linux", "tests/board/linux"}},
    {"gbm", {"gbm.h"}, {"board/linux", "tests/board/linux"}},
    {"EGL and OpenGL", {"EGL/", "GLES", "GL/", "KHR/"}, {"render", "tests/render"}},
    {"OpenCV", {"opencv2/", "opencv4/"}, {"tools", "tests"}},
    {"Ceres", {"ceres/"}, {"tools", "tests"}},
    {"ITK", {"itk"}, {"tools", "tests"}},
    {"VTK", {"vtk"}, {"tools", "tests"}},
};

const Paths kRealTimeFolders{"realtime", "board/ports", "board/linux", "firmware-host/stages"};
const Paths kForbiddenWords{"throw", "try", "catch", "shared_ptr", "std::function", "std::cout", "std::cerr"};

struct Include {
  std::string target;
  bool quoted;
};

std::optional<Include> include_on(std::string_view line) {
  const auto skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
  skip_blanks();
  if (!line.starts_with('#')) return std::nullopt;
  line.remove_prefix(1);
  skip_blanks();
  if (!line.starts_with("include")) return std::nullopt;
  line.remove_prefix(7);
  skip_blanks();
  if (line.empty() || (line[0] != '"' && line[0] != '<')) return std::nullopt;
  const bool quoted = line[0] == '"';
  const auto end = line.find(quoted ? '"' : '>', 1);
  if (end == std::string_view::npos) return std::nullopt;
  return Include{std::string(line.substr(1, end - 1)), quoted};
}

std::string_view folder_of(std::string_view path) {
  const auto slash = path.rfind('/');
  return slash == std::string_view::npos ? std::string_view{} : path.substr(0, slash);
}

std::optional<std::string> include_fault(std::string_view path, const Include& include) {
  const std::string_view target = include.target;
  if (std::ranges::any_of(kRooms, [&](auto room) { return is_inside(target, room); })) {
    if (may_include(folder_of(path), folder_of(target))) return std::nullopt;
    return std::string(folder_of(path)) + " may not include " + include.target;
  }
  if (include.quoted) return "includes of our own start at the repository's root, not " + include.target;
  for (const Fence& fence : kFences) {
    const auto begins = [&](std::string_view header) { return target.starts_with(header); };
    if (std::ranges::any_of(fence.headers, begins) && !is_inside_any(path, fence.folders))
      return std::string(fence.library) + " stays out of this folder: " + include.target;
  }
  if (target == "iostream" && is_inside_any(path, kRealTimeFolders))
    return "real-time folders use no iostream";
  return std::nullopt;
}

bool has_word(std::string_view line, std::string_view word) {
  const auto in_name = [&](std::size_t at) {
    return at < line.size() && (std::isalnum(static_cast<unsigned char>(line[at])) != 0 || line[at] == '_');
  };
  for (auto at = line.find(word); at != std::string_view::npos; at = line.find(word, at + 1))
    if ((at == 0 || !in_name(at - 1)) && !in_name(at + word.size())) return true;
  return false;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

/// The first sentence may go on over the next comment lines; where the comment ends, so does a sentence.
bool opens_with_a_sentence(const std::vector<std::string_view>& lines) {
  std::string_view last;
  for (std::string_view line : lines) {
    if (!line.starts_with("// ")) break;
    last = line;
  }
  return last.ends_with('.') && lines.front().find(' ', 3) != std::string_view::npos;
}

}  // namespace

std::string code_only(std::string_view text) {
  std::string code(text);
  const auto blank = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < std::min(to, code.size()); ++i)
      if (code[i] != '\n') code[i] = ' ';
    return to;
  };
  const auto past = [&](std::string_view mark, std::size_t from) {
    const auto at = text.find(mark, from);
    return at == std::string_view::npos ? text.size() : at + mark.size();
  };
  const auto past_literal = [&](std::size_t from) {
    std::size_t i = from + 1;
    while (i < text.size() && text[i] != text[from] && text[i] != '\n') i += text[i] == '\\' ? 2 : 1;
    return i + 1;
  };
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view rest = text.substr(i);
    const bool separates_digits = i > 0 && std::isalnum(static_cast<unsigned char>(text[i - 1])) != 0;
    if (rest.starts_with("//")) {
      i = blank(i, std::min(text.find('\n', i), text.size()));
    } else if (rest.starts_with("/*")) {
      i = blank(i, past("*/", i + 2));
    } else if (rest.starts_with("R\"")) {
      const auto open = std::min(text.find('(', i), text.size());
      const std::string close = ")" + std::string(text.substr(i + 2, open - i - 2)) + "\"";
      i = blank(i, past(close, open));
    } else if (rest[0] == '"' || (rest[0] == '\'' && !separates_digits)) {
      i = blank(i, past_literal(i));
    } else {
      ++i;
    }
  }
  return code;
}

bool may_include(std::string_view from, std::string_view to) {
  if (from == to) return true;
  const Edges* edges = nullptr;
  for (const Edges& entry : kEdges)
    if (is_inside(from, entry.from) && (edges == nullptr || entry.from.size() > edges->from.size()))
      edges = &entry;
  return edges != nullptr && (is_inside(to, edges->from) || is_inside_any(to, edges->to));
}

std::vector<Finding> check(const Source& source) {
  std::vector<Finding> findings;
  const std::string code = code_only(source.text);
  const auto lines = lines_of(source.text);
  const auto code_lines = lines_of(code);
  if (lines.empty() || !opens_with_a_sentence(lines))
    findings.push_back({source.path, 1, "the first line is a comment: one sentence, what the file is for"});
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const int number = static_cast<int>(i) + 1;
    // A string literal that spans lines may hold an include; one in code begins with the '#' that code keeps.
    if (const auto include = include_on(lines[i]);
        include && code_lines[i].find('#') != std::string_view::npos)
      if (auto fault = include_fault(source.path, *include))
        findings.push_back({source.path, number, *fault});
    if (!is_inside_any(source.path, kRealTimeFolders)) continue;
    for (std::string_view word : kForbiddenWords)
      if (has_word(code_lines[i], word))
        findings.push_back({source.path, number, "real-time folders use no " + std::string(word)});
  }
  return findings;
}

}  // namespace orcart::layers
