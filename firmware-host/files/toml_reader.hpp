// Reads a TOML file with typed, bounded getters and collects every error with its line, so that a person
// mends all at once.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "realtime/base/result.hpp"

namespace orcart {

/// What a number may be. Without a fallback the key is required.
struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::optional<double> fallback = std::nullopt;
};

struct IntegerRange {
  std::int64_t min = std::numeric_limits<std::int64_t>::min();
  std::int64_t max = std::numeric_limits<std::int64_t>::max();
  std::optional<std::int64_t> fallback = std::nullopt;
};

class TomlReader;

/// One table of the file, e.g. [tracker]. A light handle; the reader must outlive it. Every getter marks its
/// key as known. On an error it keeps the sentence in the reader and returns the fallback, or an empty value:
/// go on asking, and let finish() tell all errors together.
class TomlSection {
 public:
  bool present() const { return table_ != nullptr; }
  bool has(std::string_view key) const;
  const std::string& name() const { return name_; }

  double number(std::string_view key, NumberRange range = {}) const;
  std::int64_t integer(std::string_view key, IntegerRange range = {}) const;
  bool flag(std::string_view key, std::optional<bool> fallback = std::nullopt) const;
  /// A non-empty string.
  std::string text(std::string_view key, const std::optional<std::string>& fallback = std::nullopt) const;
  /// A file's path; a relative one is taken from the TOML file's folder, the fallback too unless empty.
  std::filesystem::path path(std::string_view key,
                             const std::optional<std::filesystem::path>& fallback = std::nullopt) const;
  /// One of the words; choice_of() below gives an enumeration.
  std::string choice(std::string_view key, std::span<const std::string_view> words,
                     std::optional<std::string_view> fallback = std::nullopt) const;
  std::string choice(std::string_view key, std::initializer_list<std::string_view> words,
                     std::optional<std::string_view> fallback = std::nullopt) const {
    return choice(key, std::span(words.begin(), words.size()), fallback);
  }
  /// choice_of<Medium>("medium", {{"air", Medium::air}, {"water", Medium::water}}, Medium::air)
  template <class Enum>
  Enum choice_of(std::string_view key, std::initializer_list<std::pair<std::string_view, Enum>> words,
                 std::optional<Enum> fallback = std::nullopt) const;
  /// The same for the word that says which keys the section may have. Nothing where it is refused, or
  /// missing in a section that is there: the section is to be left unread then, and none of its keys counts
  /// as unknown.
  template <class Enum>
  std::optional<Enum> kind_of(std::string_view key,
                              std::initializer_list<std::pair<std::string_view, Enum>> words,
                              std::optional<Enum> fallback = std::nullopt) const;

  /// Exactly `count` finite numbers; with count 0 any number of them.
  std::vector<double> numbers(std::string_view key, std::size_t count,
                              const std::optional<std::vector<double>>& fallback = std::nullopt) const;
  std::vector<std::string> texts(
      std::string_view key, const std::optional<std::vector<std::string>>& fallback = std::nullopt) const;
  /// A row-major 3x4 matrix: 12 numbers, or 16 whose last row is 0 0 0 1, flat or in rows.
  /// For poses see pose_from_toml() in toml_pose.hpp.
  std::array<double, 12> matrix_3x4(std::string_view key,
                                    std::optional<std::array<double, 12>> fallback = std::nullopt) const;
  std::array<double, 16> matrix_4x4(std::string_view key,
                                    std::optional<std::array<double, 16>> fallback = std::nullopt) const;

  /// A table inside this one; absent is fine until a required key of it is asked for.
  TomlSection section(std::string_view key) const;
  /// The tables of an array of tables, [[key]]; empty where there is none.
  std::vector<TomlSection> sections(std::string_view key) const;

  /// Keeps an error of the caller's own about a key: "file.toml:12: [tracker] rate_hz " + what_is_wrong.
  void refuse(std::string_view key, const std::string& what_is_wrong) const;
  /// Keeps a remark about a key that is no error, e.g. a pose that was re-orthonormalised.
  void note(std::string_view key, const std::string& what_was_done) const;

 private:
  friend class TomlReader;
  struct Value;
  TomlSection(TomlReader& reader, const void* table, std::string name, unsigned line)
      : reader_(&reader), table_(table), name_(std::move(name)), line_(line) {}
  Value value(std::string_view key, bool required) const;
  std::optional<std::vector<double>> flat_numbers(std::string_view key, bool required,
                                                  const std::string& accepted) const;
  void refuse_value(const Value& value, const std::string& accepted) const;
  void leave_unread() const;

  TomlReader* reader_;
  const void* table_;  ///< a toml::table, or null where the file has no such section
  std::string name_;   ///< as a person finds it: "[tracker]", or empty for the top of the file
  unsigned line_;
};

/// One file being read. Used by one thread, off the real-time path.
class TomlReader {
 public:
  static Result<std::unique_ptr<TomlReader>> open(const std::filesystem::path& file);
  /// The same from text; `file` is only for messages and relative paths.
  static Result<std::unique_ptr<TomlReader>> parse(std::string_view text, const std::filesystem::path& file);
  ~TomlReader();
  TomlReader(const TomlReader&) = delete;
  TomlReader& operator=(const TomlReader&) = delete;

  /// The keys before the first section.
  TomlSection top();
  TomlSection section(std::string_view name) { return top().section(name); }
  std::vector<TomlSection> sections(std::string_view name) { return top().sections(name); }

  /// Call last: adds unknown keys to the errors, and gives them all, a sentence a line in the file's order.
  Result<void> finish();
  const std::vector<std::string>& notes() const;

 private:
  friend class TomlSection;
  struct State;
  explicit TomlReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

template <class Enum>
Enum TomlSection::choice_of(std::string_view key,
                            std::initializer_list<std::pair<std::string_view, Enum>> words,
                            std::optional<Enum> fallback) const {
  std::vector<std::string_view> names;
  std::optional<std::string_view> fallback_name;
  for (const auto& [name, value] : words) {
    names.push_back(name);
    if (fallback && *fallback == value) fallback_name = name;
  }
  const std::string chosen = choice(key, names, fallback_name);
  for (const auto& [name, value] : words)
    if (name == chosen) return value;
  return fallback.value_or(words.begin()->second);
}

template <class Enum>
std::optional<Enum> TomlSection::kind_of(std::string_view key,
                                         std::initializer_list<std::pair<std::string_view, Enum>> words,
                                         std::optional<Enum> fallback) const {
  if (fallback && !has(key)) return fallback;
  std::vector<std::string_view> names;
  for (const auto& word : words) names.push_back(word.first);
  const std::string chosen = choice(key, names);
  for (const auto& [name, value] : words)
    if (name == chosen) return value;
  if (!present()) return words.begin()->second;  // so that what else is missing is told as well
  leave_unread();
  return std::nullopt;
}

}  // namespace orcart
