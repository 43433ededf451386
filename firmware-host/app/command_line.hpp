// What the command lines of orcartd and orcart share: options that take one of a few words, and errors of one
// sentence.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace orcart {

/// "a", "a or b", "a, b or c".
inline std::string either_of(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

/// For CLI::Option::transform: these words, in capitals or not, each with the value it stands for. CLI11's
/// own transformer shows and takes the values as well, which of a small enum are control characters.
template <class Value>
CLI::Validator one_of(const std::vector<std::pair<std::string, Value>>& values) {
  std::vector<std::string> words;
  words.reserve(values.size());
  for (const auto& each : values) words.push_back(each.first);
  return {[values, accepted = either_of(words)](std::string& input) -> std::string {
            for (const auto& [word, value] : values) {
              if (CLI::detail::to_lower(input) != CLI::detail::to_lower(word)) continue;
              input = CLI::detail::value_string(value);
              return {};
            }
            return "\"" + input + "\" is none of its words; " + accepted + " is accepted";
          },
          "{" + CLI::detail::join(words, ",") + "}"};
}

/// For CLI::App::failure_message: one sentence that names the program, the verb, what is wrong, and where
/// help is.
inline std::string in_a_sentence(const CLI::App* app, const CLI::Error& error) {
  std::string called = app->get_name();
  called.erase(0, called.rfind('/') + 1);
  for (auto verbs = app->get_subcommands(); !verbs.empty(); verbs = app->get_subcommands()) {
    app = verbs.front();
    called += " " + app->get_name();
  }
  std::string wrong = error.what();
  if (wrong == CLI::RequiredError::Subcommand(1).what()) {
    std::vector<std::string> words;
    for (const CLI::App* verb : app->get_subcommands(nullptr)) words.push_back(verb->get_name());
    wrong = "a verb is wanted, " + either_of(words);
  }
  return called + ": " + wrong + "; see " + called + " --help\n";
}

/// After a wrong line: what to exit with, 0 where help or version was asked for. Prints either.
inline int exit_code_of(const CLI::App& app, const CLI::ParseError& error) {
  return app.exit(error) == 0 ? 0 : 2;
}

}  // namespace orcart
