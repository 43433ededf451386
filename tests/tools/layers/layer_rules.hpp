// The house rules that a reader of one source file can check: who may include whom, and what its rooms keep
// out.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace orcart::layers {

struct Source {
  std::string path;  ///< from the repository's root, with forward slashes
  std::string text;
};

struct Finding {
  std::string path;
  int line;  ///< from 1
  std::string what;
};

/// `text` with comments, character and string literals blanked; lines and columns stay where they were.
std::string code_only(std::string_view text);

/// True where a file in folder `from` may include a header in folder `to` (both as "realtime/base").
bool may_include(std::string_view from, std::string_view to);

/// Every line of `source` that breaks a rule, in order; empty for a clean file.
std::vector<Finding> check(const Source& source);

}  // namespace orcart::layers
