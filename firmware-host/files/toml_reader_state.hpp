// What a TomlReader and its sections share: the parsed file, the keys asked for, and the errors so far.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "firmware-host/files/toml_reader.hpp"

namespace orcart {

inline std::string shortened(const std::string& text) {
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

/// A key as a person finds it: "[tracker] rate_hz".
inline std::string joined(const std::string& section, std::string_view key) {
  return section.empty() ? std::string(key) : section + " " + std::string(key);
}

/// The name of a table in a table: "[a]" and "b" give "[a.b]".
inline std::string inner_name(const std::string& section, std::string_view key) {
  if (section.empty()) return "[" + std::string(key) + "]";
  return section.substr(0, section.size() - 1) + "." + std::string(key) + "]";
}

struct TomlReader::State {
  struct Sentence {
    unsigned line;
    std::string text;
  };

  std::string file;
  std::filesystem::path folder;
  toml::table root;
  std::vector<Sentence> errors;
  std::vector<std::string> notes;
  std::map<const toml::table*, std::set<std::string, std::less<>>> asked;

  std::string place(unsigned line) const {
    return line > 0 ? file + ":" + std::to_string(line) + ": " : file + ": ";
  }
  void error(unsigned line, const std::string& words) { errors.push_back({line, place(line) + words}); }
  void refuse_unknown_keys(const toml::table& table, const std::string& name);
};

}  // namespace orcart
