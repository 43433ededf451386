// orcart latency: says whether this machine is good enough for the cart.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tools/latency/cart_run.hpp"
#include "tools/latency/seed_bugs.hpp"
#include "tools/orcart/verbs.hpp"

namespace orcart {
namespace {

constexpr const char* kExample =
    "Examples:\n"
    "  orcart latency --cart share/carts/demo.toml --html latency.html --json latency.json\n"
    "  orcart latency --cart share/carts/demo.toml --only-idle --for 60\n"
    "  orcart latency --cart share/carts/demo.toml --seed-bug alloc      (exits with 1 and names it)\n\n"
    "Budgets on the wall clock gate only on a PREEMPT_RT kernel with the right to SCHED_FIFO; elsewhere they "
    "are\n"
    "shown. A percentile that too few samples support is not quoted: p99 wants 10,000, p99.9 wants 100,000.";

struct Arguments {
  std::string cart = "share/carts/demo.toml";
  std::string json, html;
  double run_s = 10;
  std::size_t rounds = 20, samples = 500;
  bool only_idle = false, guards = false;
  std::string bug;
};

int complain(const std::string& sentence) {
  std::fprintf(stderr, "orcart latency: %s\n", sentence.c_str());
  return 1;
}

void progress(const std::string& what, double done) {
  if (isatty(STDERR_FILENO) == 0) return;
  std::fprintf(stderr, "\r%-40s %3.0f %%", what.c_str(), 100 * done);
}

Result<void> write_whole(const std::string& file, const std::string& content) {
  const std::string beside = file + ".part";
  {
    std::ofstream out(beside, std::ios::binary);
    out << content;
    if (!out.flush())
      return fail(file + " cannot be written; give a file in a folder with room that you may write to");
  }
  std::error_code error;
  std::filesystem::rename(beside, file, error);
  if (error) return fail(file + " cannot be replaced: " + error.message());
  return {};
}

Result<void> measure_threads(LatencyReport& report, const Arguments& arguments) {
  for (const ThreadRow& row : kThreads) {
    if (row.spec.fifo_priority == 0) continue;
    const std::string what = "waking thread " + std::string(row.spec.name);
    auto measured =
        measure_wake_ups({.spec = row.spec, .rounds = arguments.rounds, .samples = arguments.samples},
                         [&](double done) { progress(what, done); });
    if (!measured) return tl::unexpected(measured.error());
    report.wake_ups.push_back(std::move(*measured));
  }
  return {};
}

Result<void> measure_runs(LatencyReport& report, const CartConfig& config, const Arguments& arguments) {
  std::vector<MachineLoad> loads{MachineLoad::idle};
  if (!arguments.only_idle) loads.push_back(MachineLoad::every_core_busy);
  for (const MachineLoad load : loads) {
    const std::string what = load == MachineLoad::idle ? "the cart, idle" : "the cart, under load";
    auto measured = measure_cart(
        {.config = config, .duration_s = arguments.run_s, .load = load, .guarded = arguments.guards},
        [&](double done) { progress(what, done); });
    if (!measured) return tl::unexpected(measured.error());
    report.render_class = measured->render_class;
    report.renderer = measured->renderer;
    report.runs.push_back(std::move(measured->run));
  }
  if (isatty(STDERR_FILENO) != 0)
    std::fputs("\r                                                  \r", stderr);
  return {};
}

int seed(SeededBug bug, const CartConfig& config) {
  const auto result = hunt(bug, config);
  if (!result) return complain(result.error().message);
  std::printf("seeded bug \"%s\": %s\n%s", std::string(name_of(bug)).c_str(),
              result->caught ? "caught" : "NOT CAUGHT", result->account.c_str());
  return result->caught ? 1 : 3;
}

int run(const Arguments& arguments) {
  const auto config = read_cart(arguments.cart);
  if (!config) return complain(config.error().message);
  for (int i = 0; i < kSeededBugs; ++i)
    if (const auto bug = static_cast<SeededBug>(i); arguments.bug == name_of(bug)) return seed(bug, *config);
  LatencyReport report{
      .machine = look_at_machine(), .seconds_a_run = arguments.run_s, .panel_hz = config->panel.refresh_hz};
  if (auto measured = measure_threads(report, arguments); !measured)
    return complain(measured.error().message);
  if (auto measured = measure_runs(report, *config, arguments); !measured)
    return complain(measured.error().message);
  std::fputs(text_of(report).c_str(), stdout);
  for (const auto& [file, content] :
       {std::pair{arguments.json, json_of(report)}, {arguments.html, page_of(report)}}) {
    if (file.empty()) continue;
    if (auto written = write_whole(file, content); !written) return complain(written.error().message);
  }
  bool asked = false;
  for (const LatencyRun& one : report.runs) asked = asked || !one.guard_faults.empty();
  return good_enough(report) && !asked ? 0 : 1;
}

}  // namespace

void add_latency(CLI::App& app, int& exit_code) {
  auto* latency = app.add_subcommand("latency", "Measure whether this machine is good enough for the cart");
  latency->footer(kExample);
  const auto arguments = std::make_shared<Arguments>();
  latency->add_option("--cart", arguments->cart, "the cart whose stages run, on simulated devices")
      ->capture_default_str();
  latency->add_option("--for", arguments->run_s, "seconds that each run of the cart is measured")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 3600.0));
  latency->add_option("--rounds", arguments->rounds, "rounds of plain loop, ours, plain loop")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  latency->add_option("--samples", arguments->samples, "wake-ups of each loop and round")
      ->capture_default_str()
      ->check(CLI::Range(100, 100'000));
  latency->add_flag("--only-idle", arguments->only_idle,
                    "leave out the cart's second run, beside which every core is kept busy");
  latency->add_flag("--guards", arguments->guards,
                    "count what our steps ask of heap, locks, kernel and pager; slower");
  latency->add_option("--json", arguments->json, "write the figures into this file");
  latency->add_option("--html", arguments->html, "write the report with plots into this file");
  std::vector<std::string> bugs;
  bugs.reserve(kSeededBugs);
  for (int i = 0; i < kSeededBugs; ++i) bugs.emplace_back(name_of(static_cast<SeededBug>(i)));
  latency->add_option("--seed-bug", arguments->bug, "put one bug in, and let its guard name it")
      ->check(CLI::IsMember(bugs));
  latency->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace orcart
