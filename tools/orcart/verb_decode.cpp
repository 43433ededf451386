// orcart decode: recorded conversations with devices, counted and listed.
#include <cinttypes>
#include <cstdio>
#include <memory>

#include "firmware-host/tracker/ndi/dialogue_figures.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Example:\n  orcart decode ndi polaris_stream_08_31_2005.bin --json\n\n"
    "Three notations are read: log lines \"N. command[len] text\" with \\xHH escapes, the same unescaped, "
    "and\n"
    "\"sent:N = text\" / \"recv:N = text\".";

void print_json(const ndi::DialogueFigures& figures) {
  std::printf("{\"commands\": %" PRIu64 ", \"replies\": %" PRIu64 ", \"crc_good\": %" PRIu64
              ", \"crc_bad\": %" PRIu64 ", \"transforms\": %" PRIu64 ", \"missing\": %" PRIu64
              ", \"disabled\": %" PRIu64 ", \"errors\": %" PRIu64 "}\n",
              figures.commands, figures.replies, figures.crc_good, figures.crc_bad, figures.transforms,
              figures.missing, figures.disabled, figures.errors);
}

void print_text(const ndi::DialogueFigures& figures) {
  std::printf("commands    %8" PRIu64 "\nreplies     %8" PRIu64 "\nCRCs good   %8" PRIu64
              "\nCRCs bad    %8" PRIu64 "\ntransforms  %8" PRIu64 "\nmissing     %8" PRIu64
              "\ndisabled    %8" PRIu64 "\nerrors      %8" PRIu64 "\nunanswered  %8" PRIu64 "\n",
              figures.commands, figures.replies, figures.crc_good, figures.crc_bad, figures.transforms,
              figures.missing, figures.disabled, figures.errors, figures.unanswered);
  for (const std::string& remark : figures.remarks) std::printf("%s\n", remark.c_str());
}

int decode_ndi(const std::string& file, bool json) {
  const auto dialogue = ndi::read_dialogue(file);
  if (!dialogue) {
    std::fprintf(stderr, "orcart decode: %s\n", dialogue.error().message.c_str());
    return 1;
  }
  const ndi::DialogueFigures figures = ndi::count_dialogue(*dialogue);
  if (json) {
    print_json(figures);
  } else {
    print_text(figures);
  }
  return 0;
}

}  // namespace

void add_decode(CLI::App& app, int& exit_code) {
  CLI::App* decode = app.add_subcommand("decode", "Count and list what a recorded conversation contains");
  decode->require_subcommand(1);
  CLI::App* ndi = decode->add_subcommand("ndi", "A conversation with an NDI tracker");
  ndi->footer(kExample);
  struct Arguments {
    std::string file;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  ndi->add_option("dialogue", arguments->file, "the recording")->required();
  ndi->add_flag("--json", arguments->json, "the figures as one JSON object");
  ndi->callback([arguments, &exit_code] { exit_code = decode_ndi(arguments->file, arguments->json); });
}

}  // namespace orcart
