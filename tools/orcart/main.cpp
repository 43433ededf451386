// orcart VERB: the one tool beside the resident program.
#include "tools/orcart/verbs.hpp"

int main(int argc, char** argv) {
  CLI::App app{
      "orcart: paint what an endoscope sees onto the surface from the patient's CT or MR.\n"
      "Research use only; not a medical device."};
  app.require_subcommand(1);
  app.set_version_flag("--version", ORCART_VERSION);
  int exit_code = 0;
  orcart::add_bench(app, exit_code);
  orcart::add_decode(app, exit_code);
  orcart::add_emulate(app, exit_code);
  orcart::add_paint(app, exit_code);
  orcart::add_surface(app, exit_code);
  CLI11_PARSE(app, argc, argv);
  return exit_code;
}
