// Opens a TOML file through toml++, and tells all errors at the end, unknown keys among them.
#include "firmware-host/files/toml_reader.hpp"

#include <algorithm>

#include "firmware-host/files/edit_distance.hpp"
#include "firmware-host/files/toml_reader_state.hpp"
#include "firmware-host/files/whole_file.hpp"

namespace orcart {

namespace {

constexpr std::uintmax_t kLargestTomlBytes = 16U << 20U;

}  // namespace

void TomlReader::State::refuse_unknown_keys(const toml::table& table, const std::string& name) {
  const auto& known = asked[&table];
  for (const auto& [key, node] : table) {
    const std::string_view word = key.str();
    if (known.contains(word)) {
      if (const auto* inner = node.as_table(); inner != nullptr && asked.contains(inner))
        refuse_unknown_keys(*inner, inner_name(name, word));
      if (const auto* list = node.as_array())
        for (const toml::node& item : *list)
          if (const auto* inner = item.as_table(); inner != nullptr && asked.contains(inner))
            refuse_unknown_keys(*inner, inner_name(name, word));
      continue;
    }
    const std::string what =
        node.is_table() ? inner_name(name, word) : joined(name, shortened(std::string(word)));
    const std::string hint = did_you_mean(word, {known.begin(), known.end()});
    error(key.source().begin.line,
          what + " is not known" + (hint.empty() ? "; remove it" : "; did you mean " + hint + "?"));
  }
}

Result<std::unique_ptr<TomlReader>> TomlReader::open(const std::filesystem::path& file) {
  const auto text = read_whole_file(file, kLargestTomlBytes);
  if (!text) return tl::unexpected(text.error());
  return parse({reinterpret_cast<const char*>(text->data()), text->size()}, file);
}

Result<std::unique_ptr<TomlReader>> TomlReader::parse(std::string_view text,
                                                      const std::filesystem::path& file) {
  auto state = std::make_unique<State>();
  state->file = file.string();
  state->folder = file.parent_path();
  try {
    state->root = toml::parse(text, state->file);
  } catch (const toml::parse_error& error) {
    return fail(state->place(error.source().begin.line) +
                "is not valid TOML: " + std::string(error.description()));
  }
  return std::unique_ptr<TomlReader>(new TomlReader(std::move(state)));
}

TomlReader::TomlReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
TomlReader::~TomlReader() = default;

TomlSection TomlReader::top() {
  state_->asked[&state_->root];
  return {*this, &state_->root, "", 0};
}

const std::vector<std::string>& TomlReader::notes() const {
  return state_->notes;
}

Result<void> TomlReader::finish() {
  state_->refuse_unknown_keys(state_->root, "");
  if (state_->errors.empty()) return {};
  auto errors = std::move(state_->errors);
  std::stable_sort(errors.begin(), errors.end(),
                   [](const auto& a, const auto& b) { return a.line < b.line; });
  std::string all;
  for (const State::Sentence& error : errors) all += (all.empty() ? "" : "\n") + error.text;
  return fail(all);
}

}  // namespace orcart
