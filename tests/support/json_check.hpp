// Whether a text is JSON (RFC 8259), and where it stops being it: for tests of what programs write for
// others.
#pragma once

#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>

namespace orcart::testing {

/// Reads a text once, from front to back; keeps nothing of it.
class JsonCheck {
 public:
  /// Empty where `text` is one JSON value and nothing more; else the place of the first fault and what is
  /// there.
  static std::string fault_in(std::string_view text) {
    JsonCheck check(text);
    if (check.value() && check.over()) return {};
    return "byte " + std::to_string(check.at_) + ": " + std::string(text.substr(check.at_, 40));
  }

 private:
  static constexpr int kDeepest = 64;

  explicit JsonCheck(std::string_view text) : text_(text) {}

  char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  bool take(char c) {
    if (here() != c) return false;
    ++at_;
    return true;
  }
  void skip_blanks() {
    while (here() == ' ' || here() == '\n' || here() == '\r' || here() == '\t') ++at_;
  }
  bool over() {
    skip_blanks();
    return at_ == text_.size();
  }
  bool word(std::string_view w) {
    if (!text_.substr(at_).starts_with(w)) return false;
    at_ += w.size();
    return true;
  }

  bool value() {
    skip_blanks();
    switch (here()) {
      case '{':
        return list('}', [this] { return text() && (skip_blanks(), take(':')) && value(); });
      case '[':
        return list(']', [this] { return value(); });
      case '"':
        return text();
      case 't':
        return word("true");
      case 'f':
        return word("false");
      case 'n':
        return word("null");
      default:
        return number();
    }
  }
  template <class Item>
  bool list(char end, Item&& item) {
    if (++depth_ > kDeepest) return false;
    ++at_;
    skip_blanks();
    bool whole = take(end);
    while (!whole) {
      skip_blanks();
      if (!item()) return false;
      skip_blanks();
      whole = take(end);
      if (!whole && !take(',')) return false;
    }
    --depth_;
    return true;
  }
  bool text() {
    if (!take('"')) return false;
    while (here() != '"') {
      if (static_cast<unsigned char>(here()) < 0x20) return false;
      if (take('\\') && !escape()) return false;
      ++at_;
    }
    ++at_;
    return true;
  }
  /// Stands on its last character afterwards.
  bool escape() {
    if (here() != 'u')
      return here() != '\0' && std::string_view("\"\\/bfnrt").find(here()) != std::string_view::npos;
    for (int i = 0; i < 4; ++i)
      if (++at_; std::isxdigit(static_cast<unsigned char>(here())) == 0) return false;
    return true;
  }
  bool digits() {
    const std::size_t begin = at_;
    while (std::isdigit(static_cast<unsigned char>(here())) != 0) ++at_;
    return at_ > begin;
  }
  bool number() {
    (void)take('-');
    if (!take('0') && !digits()) return false;
    if (take('.') && !digits()) return false;
    if (!take('e') && !take('E')) return true;
    if (!take('+')) (void)take('-');
    return digits();
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace orcart::testing
