// Walks over the words and lines of a text in memory, for the parsers of files that others wrote.
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

namespace orcart {

/// Splits at blanks and line ends (LF, CRLF). Never reads beyond the text; needs no terminating zero.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text) : text_(text) {}

  bool at_end() const { return place_ >= text_.size(); }
  std::size_t place() const { return place_; }
  std::size_t line_number() const { return line_number_; }  ///< of the line read last, from 1

  /// The next line without its end; empty at the end of the text.
  std::string_view line() {
    const std::size_t end = text_.find('\n', place_);
    std::string_view found = text_.substr(place_, end == std::string_view::npos ? end : end - place_);
    place_ = end == std::string_view::npos ? text_.size() : end + 1;
    ++line_number_;
    if (!found.empty() && found.back() == '\r') found.remove_suffix(1);
    return found;
  }

  /// The next word, over line ends; empty at the end of the text.
  std::string_view word() {
    while (place_ < text_.size() && blank(text_[place_])) {
      if (text_[place_] == '\n') ++line_number_;
      ++place_;
    }
    const std::size_t start = place_;
    while (place_ < text_.size() && !blank(text_[place_])) ++place_;
    return text_.substr(start, place_ - start);
  }

  /// The next word as a number; nothing where it is none.
  template <class Number>
  std::optional<Number> number() {
    return parse_number<Number>(word());
  }

  template <class Number>
  static std::optional<Number> parse_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    std::conditional_t<std::is_floating_point_v<Number>, double, Number> value{};  // 1e-46 is no float, yet 0
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || word.empty()) return std::nullopt;
    return static_cast<Number>(value);
  }

 private:
  static bool blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

  std::string_view text_;
  std::size_t place_ = 0;
  std::size_t line_number_ = 0;
};

}  // namespace orcart
