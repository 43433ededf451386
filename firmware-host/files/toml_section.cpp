// The typed getters of a TOML section: every one reports into its reader's list of errors.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "firmware-host/files/toml_reader_state.hpp"

namespace orcart {

namespace {

/// A value as the person typed it, near enough to find it.
std::string shown(const toml::node& node) {
  std::ostringstream out;
  if (const auto* text = node.as_string())
    out << '"' << text->get() << '"';
  else
    node.visit([&](const auto& value) { out << value; });
  std::string text = out.str();
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return shortened(text);
}

template <class Number>
std::string range_words(const char* kind, Number min, Number max, Number lowest, Number highest) {
  std::ostringstream out;
  out << kind;
  if (min > lowest && max < highest)
    out << " from " << min << " to " << max;
  else if (min > lowest)
    out << " of " << min << " or more";
  else if (max < highest)
    out << " of " << max << " or less";
  return out.str();
}

bool append_numbers(const toml::array& array, std::vector<double>& into, int depth) {
  for (const toml::node& item : array) {
    if (const auto number = item.value<double>(); number && item.is_number() && std::isfinite(*number))
      into.push_back(*number);
    else if (const toml::array* row = item.as_array();
             row == nullptr || depth == 0 || !append_numbers(*row, into, depth - 1))
      return false;
  }
  return true;
}

}  // namespace

struct TomlSection::Value {
  std::string label;  ///< "[tracker] rate_hz"
  const toml::node* node = nullptr;
};

bool TomlSection::has(std::string_view key) const {
  return table_ != nullptr && static_cast<const toml::table*>(table_)->contains(key);
}

TomlSection::Value TomlSection::value(std::string_view key, bool required) const {
  TomlReader::State& state = *reader_->state_;
  const auto* table = static_cast<const toml::table*>(table_);
  Value found{.label = joined(name_, key), .node = nullptr};
  if (table != nullptr) {
    state.asked[table].emplace(key);
    found.node = table->get(key);
  }
  if (found.node == nullptr && required) state.error(line_, found.label + " is missing; it is required");
  return found;
}

void TomlSection::leave_unread() const {
  const auto* table = static_cast<const toml::table*>(table_);
  if (table == nullptr) return;
  for (const auto& [key, node] : *table) reader_->state_->asked[table].emplace(key.str());
}

void TomlSection::refuse_value(const Value& value, const std::string& accepted) const {
  reader_->state_->error(value.node->source().begin.line,
                         value.label + " is " + shown(*value.node) + "; " + accepted + " is accepted");
}

double TomlSection::number(std::string_view key, NumberRange range) const {
  const Value found = value(key, !range.fallback);
  const double otherwise = range.fallback.value_or(0.0);
  if (found.node == nullptr) return otherwise;
  const auto number = found.node->is_number() ? found.node->value<double>() : std::nullopt;
  if (number && std::isfinite(*number) && *number >= range.min && *number <= range.max) return *number;
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  refuse_value(found, range_words("a number", range.min, range.max, -kInfinite, kInfinite));
  return otherwise;
}

std::int64_t TomlSection::integer(std::string_view key, IntegerRange range) const {
  const Value found = value(key, !range.fallback);
  const std::int64_t otherwise = range.fallback.value_or(0);
  if (found.node == nullptr) return otherwise;
  const auto* number = found.node->as_integer();
  if (number != nullptr && number->get() >= range.min && number->get() <= range.max) return number->get();
  using Limits = std::numeric_limits<std::int64_t>;
  refuse_value(found, range_words("a whole number", range.min, range.max, Limits::min(), Limits::max()));
  return otherwise;
}

bool TomlSection::flag(std::string_view key, std::optional<bool> fallback) const {
  const Value found = value(key, !fallback);
  if (found.node == nullptr) return fallback.value_or(false);
  if (const auto* flag = found.node->as_boolean()) return flag->get();
  refuse_value(found, "true or false");
  return fallback.value_or(false);
}

std::string TomlSection::text(std::string_view key, const std::optional<std::string>& fallback) const {
  const Value found = value(key, !fallback);
  if (found.node == nullptr) return fallback.value_or("");
  if (const auto* text = found.node->as_string(); text != nullptr && !text->get().empty()) return text->get();
  refuse_value(found, "a text in quotes, not empty,");
  return fallback.value_or("");
}

std::filesystem::path TomlSection::path(std::string_view key,
                                        const std::optional<std::filesystem::path>& fallback) const {
  const auto otherwise = fallback ? std::optional(fallback->string()) : std::nullopt;
  const std::filesystem::path given = text(key, otherwise);
  return given.empty() || given.is_absolute() ? given : reader_->state_->folder / given;
}

std::string TomlSection::choice(std::string_view key, std::span<const std::string_view> words,
                                std::optional<std::string_view> fallback) const {
  const Value found = value(key, !fallback);
  const std::string otherwise(fallback.value_or(std::string_view{}));
  if (found.node == nullptr) return otherwise;
  const auto* text = found.node->as_string();
  if (text != nullptr && std::find(words.begin(), words.end(), text->get()) != words.end())
    return text->get();
  std::string accepted;
  for (std::size_t i = 0; i < words.size(); ++i)
    accepted += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + ('"' + std::string(words[i]) + '"');
  refuse_value(found, accepted);
  return otherwise;
}

std::optional<std::vector<double>> TomlSection::flat_numbers(std::string_view key, bool required,
                                                             const std::string& accepted) const {
  const Value found = value(key, required);
  if (found.node == nullptr) return std::nullopt;
  std::vector<double> numbers;
  const auto* array = found.node->as_array();
  if (array != nullptr && append_numbers(*array, numbers, 1)) return numbers;
  refuse_value(found, accepted);
  return std::nullopt;
}

std::vector<double> TomlSection::numbers(std::string_view key, std::size_t count,
                                         const std::optional<std::vector<double>>& fallback) const {
  const std::string accepted =
      count == 0 ? "a list of numbers" : "a list of " + std::to_string(count) + " numbers";
  auto numbers = flat_numbers(key, !fallback, accepted);
  if (numbers && (count == 0 || numbers->size() == count)) return *std::move(numbers);
  if (numbers)
    refuse(key, "has " + std::to_string(numbers->size()) + " numbers; " + accepted + " is accepted");
  return fallback.value_or(std::vector<double>(count));
}

std::vector<std::string> TomlSection::texts(std::string_view key,
                                            const std::optional<std::vector<std::string>>& fallback) const {
  const Value found = value(key, !fallback);
  if (found.node == nullptr) return fallback.value_or(std::vector<std::string>{});
  std::vector<std::string> texts;
  if (const auto* array = found.node->as_array())
    for (const toml::node& item : *array)
      if (const auto* text = item.as_string()) texts.push_back(text->get());
  if (found.node->is_array() && texts.size() == found.node->as_array()->size()) return texts;
  refuse_value(found, "a list of texts");
  return fallback.value_or(std::vector<std::string>{});
}

std::array<double, 12> TomlSection::matrix_3x4(std::string_view key,
                                               std::optional<std::array<double, 12>> fallback) const {
  const std::string accepted = "a 3x4 matrix, 12 numbers row by row (or 16 ending in 0 0 0 1),";
  std::array<double, 12> matrix =
      fallback.value_or(std::array<double, 12>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  const auto numbers = flat_numbers(key, !fallback, accepted);
  if (!numbers) return matrix;
  constexpr std::array<double, 4> kLastRow{0, 0, 0, 1};
  const bool whole =
      numbers->size() == 16 && std::equal(kLastRow.begin(), kLastRow.end(), numbers->begin() + 12);
  if (numbers->size() == 12 || whole)
    std::copy_n(numbers->begin(), 12, matrix.begin());
  else if (numbers->size() == 16)
    refuse(key, "ends in another row than 0 0 0 1; " + accepted + " is accepted");
  else
    refuse(key, "has " + std::to_string(numbers->size()) + " numbers; " + accepted + " is accepted");
  return matrix;
}

std::array<double, 16> TomlSection::matrix_4x4(std::string_view key,
                                               std::optional<std::array<double, 16>> fallback) const {
  std::array<double, 16> matrix =
      fallback.value_or(std::array<double, 16>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  const auto given = numbers(
      key, 16, fallback ? std::optional(std::vector<double>(matrix.begin(), matrix.end())) : std::nullopt);
  std::copy_n(given.begin(), 16, matrix.begin());
  return matrix;
}

TomlSection TomlSection::section(std::string_view key) const {
  const Value found = value(key, false);
  TomlReader::State& state = *reader_->state_;
  const auto* table = found.node != nullptr ? found.node->as_table() : nullptr;
  if (found.node != nullptr && table == nullptr) refuse_value(found, "a section " + inner_name(name_, key));
  if (table != nullptr) state.asked[table];
  return {*reader_, table, inner_name(name_, key), table != nullptr ? table->source().begin.line : 0};
}

std::vector<TomlSection> TomlSection::sections(std::string_view key) const {
  const Value found = value(key, false);
  std::vector<TomlSection> all;
  if (found.node == nullptr) return all;
  const auto* array = found.node->as_array();
  const std::string name = inner_name(name_, key);
  if (array == nullptr ||
      !std::all_of(array->begin(), array->end(), [](const auto& n) { return n.is_table(); })) {
    refuse_value(found, "one or more sections [" + name + "]");
    return all;
  }
  for (const toml::node& item : *array) {
    reader_->state_->asked[item.as_table()];
    all.push_back({*reader_, item.as_table(), name, item.source().begin.line});
  }
  return all;
}

namespace {

unsigned line_of(const void* table, std::string_view key, unsigned otherwise) {
  if (table == nullptr) return otherwise;
  const toml::node* node = static_cast<const toml::table*>(table)->get(key);
  return node != nullptr ? node->source().begin.line : otherwise;
}

}  // namespace

void TomlSection::refuse(std::string_view key, const std::string& what_is_wrong) const {
  reader_->state_->error(line_of(table_, key, line_), joined(name_, key) + " " + what_is_wrong);
}

void TomlSection::note(std::string_view key, const std::string& what_was_done) const {
  TomlReader::State& state = *reader_->state_;
  state.notes.push_back(state.place(line_of(table_, key, line_)) + joined(name_, key) + " " + what_was_done);
}

}  // namespace orcart
