// What `orcart latency` found: plain data, and its text and JSON.
#pragma once

#include <string>
#include <vector>

#include "realtime/kernel/budget.hpp"
#include "tools/latency/machine.hpp"
#include "tools/latency/wake_ups.hpp"

namespace orcart {

/// One distribution against its budget.
struct LatencyRow {
  std::string name, note;
  Budget budget;  ///< Nanos::max(): none
  HistogramSnapshot samples;
  Nanos longest_own{0};  ///< the most that the thread itself ran of one; zero: not a step
};

enum class Verdict { within, over, too_few, no_budget };
Verdict verdict_of(const LatencyRow& row);
/// "within (at p90)", "OVER the bound of 5.00 ms, the thread itself ran 1.20 ms at most", "too few samples";
/// empty where there is no budget.
std::string verdict_words(const LatencyRow& row);

/// One bar of a timeline, milliseconds since its beginning.
struct TimelineBar {
  std::string name;
  double from_ms = 0, until_ms = 0;
};

/// One of the longest steps, as a share of its bound, and what all threads did around it.
struct WorstStep {
  std::string stage;
  double at_s = 0, took_ms = 0, bound_ms = 0;
  std::vector<std::string> trace;
};

/// One run of the simulated cart.
struct LatencyRun {
  std::string title;  ///< "idle" or "under load"
  std::vector<LatencyRow> stages, wake_ups, paths;
  std::vector<TimelineBar> capture;  ///< one, from the pedal's edge to its flip; empty: none was painted
  std::vector<WorstStep> worst;      ///< at most ten, the longest first
  std::vector<std::string> library_calls;
  std::vector<std::string> guard_faults;  ///< what our own code asked of heap, locks, kernel or pager
  std::uint64_t frames = 0, late_frames = 0, queue_drops = 0, slips = 0;
};

struct LatencyReport {
  MachineFacts machine;
  std::string render_class, renderer;
  double seconds_a_run = 0, panel_hz = 0;
  std::vector<WakeUps> wake_ups;
  std::vector<LatencyRun> runs;
};

/// False where a wall-clock budget that gates is missed. Where none gates, true.
bool good_enough(const LatencyReport& report);

std::string text_of(const LatencyReport& report);
std::string json_of(const LatencyReport& report);
/// One HTML file that needs no other: plots as SVG.
std::string page_of(const LatencyReport& report);

/// "12.3 us", "4.56 ms"; three digits.
std::string words_for(Nanos length);
/// The percentile's value, or how many samples it wants: "p99.9 needs 100,000 samples, there are 1,200".
std::string percentile_words(const HistogramSnapshot& samples, double quantile);

}  // namespace orcart
