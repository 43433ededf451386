// orcart VERB: the one tool beside the resident program.
#include <algorithm>
#include <cstdio>

#include "firmware-host/files/edit_distance.hpp"
#include "tools/orcart/verbs.hpp"

namespace {

/// True where the first word is no verb; says so, and which was probably meant.
bool is_unknown_verb(const CLI::App& app, const char* word) {
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands(nullptr)) verbs.push_back(verb->get_name());
  if (word[0] == '-' || std::find(verbs.begin(), verbs.end(), word) != verbs.end()) return false;
  const std::string meant = orcart::did_you_mean(word, verbs);
  std::fprintf(stderr, "orcart knows no verb \"%s\"; %s\n", word,
               meant.empty() ? "orcart --help lists them" : ("did you mean " + meant + "?").c_str());
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "orcart: paint what an endoscope sees onto the surface from the patient's CT or MR.\n"
      "Research use only; not a medical device."};
  app.failure_message(orcart::in_a_sentence);
  app.require_subcommand(1);
  app.set_version_flag("--version", ORCART_VERSION);
  int exit_code = 0;
  orcart::add_bench(app, exit_code);
  orcart::add_calibrate(app, exit_code);
  orcart::add_decode(app, exit_code);
  orcart::add_emulate(app, exit_code);
  orcart::add_evaluate(app, exit_code);
  orcart::add_export(app, exit_code);
  orcart::add_latency(app, exit_code);
  orcart::add_paint(app, exit_code);
  orcart::add_probe(app, exit_code);
  orcart::add_pivot(app, exit_code);
  orcart::add_rectify(app, exit_code);
  orcart::add_register(app, exit_code);
  orcart::add_surface(app, exit_code);
  orcart::add_turn(app, exit_code);
  if (argc > 1 && is_unknown_verb(app, argv[1])) return 2;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return orcart::exit_code_of(app, error);
  }
  return exit_code;
}
