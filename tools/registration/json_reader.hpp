// Reads JSON into a tree; enough for the files that other programs hand over.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace orcart {

/// One value: a text, a number, or a list or object with its items (an object's have names). true is 1, false
/// and null are 0.
struct JsonValue {
  std::string text;
  double number = 0;
  std::vector<JsonValue> items;
  std::vector<std::string> names;

  const JsonValue* member(std::string_view name) const {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == name) return &items[i];
    return nullptr;
  }
};

/// Nothing where the text is no JSON, or is nested deeper than 64.
std::optional<JsonValue> read_json(std::string_view text);

}  // namespace orcart
