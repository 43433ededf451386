// orcart probe: what is plugged in, what is lacking, and the one thing to do next.
#include <cstdio>
#include <iterator>
#include <memory>

#include "tools/orcart/verbs.hpp"
#include "tools/probe/device_probe.hpp"
#include "tools/probe/machine_probe.hpp"

namespace orcart {
namespace {

void append(ProbeReport& report, std::vector<Finding> findings) {
  report.findings.insert(report.findings.end(), std::make_move_iterator(findings.begin()),
                         std::make_move_iterator(findings.end()));
}

ProbeReport probe() {
  ProbeReport report;
  append(report, probe_trackers("/"));
  append(report, probe_cameras());
  append(report, probe_pedals());
  append(report, probe_encoders());
  append(report, probe_panels());
  append(report, probe_system("/", rights_of_this_process()));
  return report;
}

}  // namespace

void add_probe(CLI::App& app, int& exit_code) {
  CLI::App* verb =
      app.add_subcommand("probe", "What is plugged in, what is lacking, and what to do about it");
  verb->footer(
      "Example:\n  orcart probe\n\nChanges nothing; exit code 0 whatever is lacking (--json counts it).");
  const auto json = std::make_shared<bool>(false);
  verb->add_flag("--json", *json, "the findings as one JSON object");
  verb->callback([json, &exit_code] {
    const ProbeReport report = probe();
    std::fputs((*json ? json_of(report) : text_of(report)).c_str(), stdout);
    exit_code = 0;
  });
}

}  // namespace orcart
