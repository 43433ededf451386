// Small pieces of JSON and numbers as text, for the answers of the verbs.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace orcart::json {

inline std::string number(double value) {
  if (!std::isfinite(value)) return "null";
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.10g", value);
  return text.data();
}

inline std::string text(std::string_view words) {
  std::string out = "\"";
  for (const char c : words) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) out += c;
  }
  return out + "\"";
}

/// Items that are JSON already.
inline std::string list(const std::vector<std::string>& items) {
  std::string out = "[";
  for (const std::string& item : items) out += (out.size() > 1 ? ", " : "") + item;
  return out + "]";
}

template <class Numbers>
std::string numbers(const Numbers& values) {
  std::vector<std::string> items;
  items.reserve(static_cast<std::size_t>(std::size(values)));
  for (const double value : values) items.push_back(number(value));
  return list(items);
}

/// A pose as a row-major 3x4 matrix, 12 numbers.
template <class Pose>
std::string pose(const Pose& X) {
  std::vector<double> m;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) m.push_back(X.rotation(row, column));
    m.push_back(X.translation_mm[row]);
  }
  return numbers(m);
}

/// printf into a string.
template <class... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
  std::array<char, 512> out{};
  std::snprintf(out.data(), out.size(), pattern, arguments...);
  return out.data();
}

}  // namespace orcart::json
