// The text headers of NRRD and MetaImage: lines of a key and its value, and the numbers in a value.
#pragma once

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware-host/files/text_cursor.hpp"

namespace orcart {

inline std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

inline std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

using HeaderFields = std::map<std::string, std::string>;

/// The value of the first of the keys that is there.
inline std::optional<std::string> field(const HeaderFields& fields, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (const auto found = fields.find(key); found != fields.end()) return found->second;
  return std::nullopt;
}

/// All numbers of a text in which blanks, commas and brackets separate; nothing where a word is none.
inline std::optional<std::vector<double>> numbers_of(std::string text) {
  for (char& c : text)
    if (c == ',' || c == '(' || c == ')') c = ' ';
  std::vector<double> numbers;
  TextCursor words(text);
  for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
    const auto number = TextCursor::parse_number<double>(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

/// Exactly `count` of them.
inline std::optional<std::vector<double>> numbers_of(const std::string& text, std::size_t count) {
  auto numbers = numbers_of(text);
  return numbers && numbers->size() == count ? numbers : std::nullopt;
}

inline std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  TextCursor cursor(text);
  for (std::string_view word = cursor.word(); !word.empty(); word = cursor.word()) words.emplace_back(word);
  return words;
}

}  // namespace orcart
