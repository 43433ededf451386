// A recursive descent with a bound on its depth.
#include "tools/registration/json_reader.hpp"

#include <charconv>

namespace orcart {
namespace {

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  bool value(JsonValue& out, int depth) {
    skip();
    if (depth > 64 || at_ >= text_.size()) return false;
    const char c = text_[at_];
    if (c == '{' || c == '[') return container(out, c == '{', depth);
    if (c == '"') return string(out.text);
    for (const auto& [word, number] : {std::pair{"true", 1.0}, {"false", 0.0}, {"null", 0.0}})
      if (text_.substr(at_).starts_with(word)) {
        out.number = number;
        at_ += std::string_view(word).size();
        return true;
      }
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), out.number);
    at_ = static_cast<std::size_t>(end - text_.data());
    return error == std::errc{};
  }

  bool at_end() {
    skip();
    return at_ == text_.size();
  }

 private:
  void skip() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
      ++at_;
  }

  bool take(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  bool string(std::string& out) {
    if (!take('"')) return false;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"') {
        ++at_;
        return true;
      }
      if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
      out += text_[at_];
    }
    return false;
  }

  bool container(JsonValue& out, bool object, int depth) {
    ++at_;
    const char close = object ? '}' : ']';
    if (take(close)) return true;
    do {
      if (object) {
        skip();
        if (!string(out.names.emplace_back()) || !take(':')) return false;
      }
      if (!value(out.items.emplace_back(), depth + 1)) return false;
    } while (take(','));
    return take(close);
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::optional<JsonValue> read_json(std::string_view text) {
  Reader reader(text);
  JsonValue value;
  if (!reader.value(value, 0) || !reader.at_end()) return std::nullopt;
  return value;
}

}  // namespace orcart
