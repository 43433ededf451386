// Judges rows and puts the report in words and in JSON.
#include "tools/latency/latency_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace orcart {
namespace {

template <class... Args>
std::string text(const char* format, Args... args) {
  char buffer[1024];
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

std::string quoted(const std::string& s) {
  std::string out = "\"";
  for (const char c : s) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      out += text("\\u%04x", c);
    else
      out += c;
  }
  return out + "\"";
}

std::string table(const char* title, const std::vector<LatencyRow>& rows) {
  std::string out = text("  %-30s %9s %10s %10s %10s %10s  %s\n", title, "samples", "p50", "judged", "max",
                         "budget", "verdict");
  for (const LatencyRow& row : rows) {
    const BudgetVerdict judged = judge(row.budget, row.samples);
    const auto median = row.samples.median();
    const bool has_budget = row.budget.p999 != Nanos::max();
    out +=
        text("  %-30s %9llu %10s %10s %10s %10s  %s\n", row.name.c_str(),
             static_cast<unsigned long long>(row.samples.count()), median ? words_for(*median).c_str() : "-",
             judged.judged_quantile ? words_for(judged.at_quantile).c_str() : "-",
             words_for(row.samples.max()).c_str(), has_budget ? words_for(row.budget.p999).c_str() : "-",
             verdict_words(row).c_str());
  }
  return out;
}

std::string json_row(const LatencyRow& row) {
  const BudgetVerdict judged = judge(row.budget, row.samples);
  std::string out =
      "{\"name\":" + quoted(row.name) + ",\"note\":" + quoted(row.note) +
      text(",\"samples\":%llu,\"max_us\":%.3f", static_cast<unsigned long long>(row.samples.count()),
           microseconds(row.samples.max()));
  if (const auto median = row.samples.median()) out += text(",\"p50_us\":%.3f", microseconds(*median));
  for (const double q : {0.9, 0.99, 0.999})
    if (const auto value = row.samples.percentile(q))
      out += text(",\"p%g_us\":%.3f", 100 * q, microseconds(*value));
  if (row.longest_own > Nanos{0}) out += text(",\"longest_own_us\":%.3f", microseconds(row.longest_own));
  if (judged.judged_quantile) out += text(",\"judged_at\":%g", *judged.judged_quantile);
  if (row.budget.p999 != Nanos::max())
    out += text(",\"budget_us\":%.3f,\"bound_us\":%.3f", microseconds(row.budget.p999),
                microseconds(row.budget.bound));
  return out + ",\"verdict\":" + quoted(verdict_words(row)) + "}";
}

template <class Item, class Writer>
std::string json_list(const std::vector<Item>& items, Writer&& write) {
  std::string out = "[";
  for (std::size_t i = 0; i < items.size(); ++i) out += (i > 0 ? "," : "") + write(items[i]);
  return out + "]";
}

std::string json_wake_ups(const WakeUps& w) {
  const WakeUpRatios ours = median_of(w.ratios), noise = median_of(w.noise);
  return "{\"thread\":" + quoted(std::string(w.spec.name)) +
         text(
             ",\"fifo_priority\":%d,\"rounds\":%zu,\"samples_a_round\":%zu,\"ratio_p50\":%.4f,\"ratio_p99\":%"
             ".4f,"
             "\"noise_p50\":%.4f,\"noise_p99\":%.4f,",
             w.spec.fifo_priority, w.ratios.size(), w.samples_a_round, ours.p50, ours.p99, noise.p50,
             noise.p99) +
         "\"ours\":" + json_row({.name = "ours", .note = "", .budget = {}, .samples = w.ours}) +
         ",\"plain\":" + json_row({.name = "plain", .note = "", .budget = {}, .samples = w.plain}) + "}";
}

std::string json_run(const LatencyRun& run) {
  return "{\"title\":" + quoted(run.title) +
         text(",\"frames\":%llu,\"late_frames\":%llu,\"queue_drops\":%llu,\"slips\":%llu",
              static_cast<unsigned long long>(run.frames), static_cast<unsigned long long>(run.late_frames),
              static_cast<unsigned long long>(run.queue_drops), static_cast<unsigned long long>(run.slips)) +
         ",\"stages\":" + json_list(run.stages, json_row) +
         ",\"wake_ups\":" + json_list(run.wake_ups, json_row) +
         ",\"paths\":" + json_list(run.paths, json_row) +
         ",\"guard_faults\":" + json_list(run.guard_faults, quoted) +
         ",\"library_calls\":" + json_list(run.library_calls, quoted) + ",\"worst\":" +
         json_list(run.worst,
                   [](const WorstStep& w) {
                     return "{\"stage\":" + quoted(w.stage) +
                            text(",\"at_s\":%.6f,\"took_ms\":%.3f,\"bound_ms\":%.3f,\"trace\":", w.at_s,
                                 w.took_ms, w.bound_ms) +
                            json_list(w.trace, quoted) + "}";
                   }) +
         ",\"capture\":" +
         json_list(run.capture,
                   [](const TimelineBar& bar) {
                     return "{\"name\":" + quoted(bar.name) +
                            text(",\"from_ms\":%.3f,\"until_ms\":%.3f}", bar.from_ms, bar.until_ms);
                   }) +
         "}";
}

bool over(const LatencyRow& row) {
  return verdict_of(row) == Verdict::over;
}

}  // namespace

Verdict verdict_of(const LatencyRow& row) {
  if (row.budget.p999 == Nanos::max()) return Verdict::no_budget;
  const BudgetVerdict judged = judge(row.budget, row.samples);
  if (!judged.within_bound || !judged.within_quantile) return Verdict::over;
  return judged.judged_quantile ? Verdict::within : Verdict::too_few;
}

std::string verdict_words(const LatencyRow& row) {
  const BudgetVerdict judged = judge(row.budget, row.samples);
  const std::string at = judged.judged_quantile ? text(" (at p%g)", 100 * *judged.judged_quantile) : "";
  switch (verdict_of(row)) {
    case Verdict::within:
      return "within" + at;
    case Verdict::too_few:
      return "too few samples";
    case Verdict::no_budget:
      return "";
    case Verdict::over:
      break;
  }
  std::string words = judged.within_bound ? "OVER" + at : "OVER the bound of " + words_for(row.budget.bound);
  if (row.longest_own > Nanos{0})
    words += ", the thread itself ran " + words_for(row.longest_own) + " at most";
  return words;
}

bool good_enough(const LatencyReport& report) {
  if (!report.machine.judged()) return true;
  return std::ranges::none_of(report.runs, [](const LatencyRun& run) {
    return std::ranges::any_of(run.stages, over) || std::ranges::any_of(run.wake_ups, over) ||
           std::ranges::any_of(run.paths, over);
  });
}

std::string words_for(Nanos length) {
  const double us = microseconds(length);
  if (us < 1000) return text(us < 10 ? "%.2f us" : us < 100 ? "%.1f us" : "%.0f us", us);
  const double ms = us / 1000;
  return text(ms < 10 ? "%.2f ms" : ms < 100 ? "%.1f ms" : "%.0f ms", ms);
}

std::string percentile_words(const HistogramSnapshot& samples, double quantile) {
  if (const auto value = samples.percentile(quantile))
    return text("p%g ", 100 * quantile) + words_for(*value);
  return text("p%g needs %.0f samples, there are %llu", 100 * quantile,
              std::ceil(100 / (1 - quantile) - 1e-6), static_cast<unsigned long long>(samples.count()));
}

std::string text_of(const LatencyReport& r) {
  std::string out = r.machine.name + "\n" + r.renderer + ", render class " + r.render_class + "\n";
  out += r.machine.judged() ? "Wall-clock budgets gate here: PREEMPT_RT and SCHED_FIFO were found.\n"
                            : "Wall-clock budgets do not gate here: they want a PREEMPT_RT kernel and the "
                              "right to SCHED_FIFO.\n";
  if (!r.wake_ups.empty())
    out +=
        "\nWake-up lateness beside a plain loop (ratio of medians over rounds; plain against itself is the "
        "noise):\n";
  for (const WakeUps& w : r.wake_ups) {
    const WakeUpRatios ours = median_of(w.ratios), noise = median_of(w.noise);
    out += text(
        "  %-8s FIFO %d: ours p50 %s, plain p50 %s; p50 ratio %.3f (noise %.3f), p99 ratio %.3f (noise "
        "%.3f); "
        "%zu rounds of %zu; ours %s; %s\n",
        std::string(w.spec.name).c_str(), w.spec.fifo_priority,
        words_for(w.ours.median().value_or(Nanos{0})).c_str(),
        words_for(w.plain.median().value_or(Nanos{0})).c_str(), ours.p50, noise.p50, ours.p99, noise.p99,
        w.ratios.size(), w.samples_a_round, percentile_words(w.ours, 0.99).c_str(),
        percentile_words(w.ours, 0.999).c_str());
  }
  for (const LatencyRun& run : r.runs) {
    out += text(
        "\nThe simulated cart, %s, %.0f s: %llu frames shown, %llu late, %llu slips, %llu dropped by "
        "queues\n",
        run.title.c_str(), r.seconds_a_run, static_cast<unsigned long long>(run.frames),
        static_cast<unsigned long long>(run.late_frames), static_cast<unsigned long long>(run.slips),
        static_cast<unsigned long long>(run.queue_drops));
    out += table("stage", run.stages) + table("wake-up of thread", run.wake_ups) + table("path", run.paths);
    for (const TimelineBar& bar : run.capture)
      out += text("  one capture: %7.1f to %7.1f ms  %s\n", bar.from_ms, bar.until_ms, bar.name.c_str());
    for (const WorstStep& w : run.worst)
      out += text("  of the ten longest: %-16s %8.3f ms of %.4g ms, %.3f s into the run\n", w.stage.c_str(),
                  w.took_ms, w.bound_ms, w.at_s);
    for (const std::string& fault : run.guard_faults) out += "  FOUND: " + fault;
    for (const std::string& line : run.library_calls) out += "  inside libraries: " + line + "\n";
  }
  out += r.machine.causes.empty() ? "\nNothing was seen here that costs latency.\n"
                                  : "\nWhat costs latency here:\n";
  for (const Cause& cause : r.machine.causes) out += "  " + cause.what + "\n      " + cause.remedy + "\n";
  return out;
}

std::string json_of(const LatencyReport& r) {
  return "{\"machine\":" + quoted(r.machine.name) + ",\"render_class\":" + quoted(r.render_class) +
         ",\"renderer\":" + quoted(r.renderer) +
         text(",\"preempt_rt\":%s,\"fifo\":%s,\"gates\":%s,\"good_enough\":%s,\"seconds_a_run\":%g",
              r.machine.preempt_rt ? "true" : "false", r.machine.fifo ? "true" : "false",
              r.machine.judged() ? "true" : "false",
              !r.machine.judged() ? "null"
              : good_enough(r)    ? "true"
                                  : "false",
              r.seconds_a_run) +
         ",\"causes\":" +
         json_list(r.machine.causes,
                   [](const Cause& c) {
                     return "{\"what\":" + quoted(c.what) + ",\"remedy\":" + quoted(c.remedy) + "}";
                   }) +
         ",\n\"wake_ups\":" + json_list(r.wake_ups, json_wake_ups) +
         ",\n\"runs\":" + json_list(r.runs, json_run) + "}\n";
}

}  // namespace orcart
