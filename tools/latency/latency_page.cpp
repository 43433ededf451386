// The report as one HTML file: plots drawn by hand, no script, no font but the reader's own.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tools/latency/latency_report.hpp"

namespace orcart {
namespace {

template <class... Args>
std::string text(const char* format, Args... args) {
  char buffer[1024];
  std::snprintf(buffer, sizeof buffer, format, args...);
  return buffer;
}

std::string escaped(const std::string& s) {
  std::string out;
  for (const char c : s) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

constexpr const char* kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;max-width:1040px;margin:2em auto;padding:0 1em;color:#1c1f24;"
    "background:#fbfaf8}h1{font-size:1.5em}h2{font-size:1.15em;margin-top:2em;border-bottom:1px solid #ddd}"
    "h3{font-size:1em;margin:1.2em 0 "
    ".4em}.grid{display:grid;grid-template-columns:repeat(auto-fill,minmax(320px,1fr));"
    "gap:.8em}.card{background:#fff;border:1px solid #e4e0da;border-radius:6px;padding:.5em .8em}.card "
    "b{display:block}"
    ".verdict{font-size:13px}.muted{color:#666;font-size:13px}.ok{color:#1d7a3a}.bad{color:#b03030;font-"
    "weight:600}"
    ".banner{background:#fff3d6;border:1px solid #e6c878;padding:.5em 1em;border-radius:6px;margin:.6em 0}"
    "svg{width:100%;height:auto}pre{font-size:12px;background:#f3f0ea;padding:.6em;overflow:auto}"
    "table{border-collapse:collapse;font-size:14px;width:100%}td,th{padding:.2em .5em;text-align:right;"
    "border-bottom:1px solid #eee}td:first-child,th:first-child{text-align:left}";

constexpr double kWidth = 380, kTop = 16, kBottom = 130, kLeft = 6;
constexpr double kLowestUs = 0.1, kHighestUs = 1e6;
constexpr int kBins = 84;  // 12 a decade

double x_of(double us) {
  const double share =
      std::log10(std::clamp(us, kLowestUs, kHighestUs) / kLowestUs) / std::log10(kHighestUs / kLowestUs);
  return kLeft + (kWidth - 2 * kLeft) * share;
}

/// `anchor`: which side of the line the label stands on (SVG's start, middle or end).
std::string vertical(double us, const char* colour, const char* label, const char* anchor) {
  const double x = x_of(us);
  const double shift = anchor[0] == 'e' ? -2 : anchor[0] == 's' ? 2 : 0;
  return text(
      "<line x1='%.1f' x2='%.1f' y1='%.0f' y2='%.0f' stroke='%s' stroke-dasharray='4 2'/>"
      "<text x='%.1f' y='%.0f' font-size='11' fill='%s' text-anchor='%s'>%s</text>",
      x, x, kTop, kBottom, colour, x + shift, kTop - 4, colour, anchor, label);
}

std::array<std::uint64_t, kBins> bins_of(const HistogramSnapshot& samples) {
  std::array<std::uint64_t, kBins> bins{};
  for (std::size_t i = 0; i < histogram_buckets::kCount; ++i) {
    if (samples.bucket(i) == 0) continue;
    const double us = microseconds(histogram_buckets::upper_edge(i));
    const double bin = std::log10(std::max(us, kLowestUs) / kLowestUs) * 12;
    bins[static_cast<std::size_t>(std::clamp(bin, 0.0, kBins - 1.0))] += samples.bucket(i);
  }
  return bins;
}

/// Counts (logarithmic bars), the share below as a curve, the budget and the bound as lines; `beside`:
/// another curve to compare with.
std::string plot(const HistogramSnapshot& samples, const Budget& budget,
                 const HistogramSnapshot* beside = nullptr) {
  std::string out = text("<svg viewBox='0 0 %.0f 150' role='img'>", kWidth);
  const char* labels[] = {"0.1", "1 us", "10 us", "100 us", "1 ms", "10 ms", "100 ms", "1 s"};
  for (int i = 0; i < 8; ++i) {
    const double x = x_of(kLowestUs * std::pow(10.0, i));
    out += text(
        "<line x1='%.1f' x2='%.1f' y1='%.0f' y2='%.0f' stroke='#eee'/>"
        "<text x='%.1f' y='144' font-size='11' fill='#666' text-anchor='%s'>%s</text>",
        x, x, kTop, kBottom, x,
        i == 0   ? "start"
        : i == 7 ? "end"
                 : "middle",
        labels[i]);
  }
  for (const double share : {0.5, 1.0})
    out += text(
        "<line x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f' stroke='#eee'/>"
        "<text x='%.1f' y='%.1f' font-size='10' fill='#999'>%.0f %%</text>",
        kLeft, kWidth - kLeft, kBottom - (kBottom - kTop) * share, kBottom - (kBottom - kTop) * share, kLeft,
        kBottom - (kBottom - kTop) * share + 11, 100 * share);
  const auto bins = bins_of(samples);
  const double most =
      std::log10(static_cast<double>(std::max<std::uint64_t>(1, *std::ranges::max_element(bins)))) + 0.3;
  const double bar = (kWidth - 2 * kLeft) / kBins;
  for (int i = 0; i < kBins; ++i) {
    if (bins[static_cast<std::size_t>(i)] == 0) continue;
    const double height =
        (kBottom - kTop) * (std::log10(static_cast<double>(bins[static_cast<std::size_t>(i)])) + 0.3) / most;
    out +=
        text("<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' fill='#9cbcd8'><title>%llu</title></rect>",
             kLeft + bar * i, kBottom - height, bar - 0.5, height,
             static_cast<unsigned long long>(bins[static_cast<std::size_t>(i)]));
  }
  const auto curve = [&](const HistogramSnapshot& of, const char* colour) {
    std::string points;
    double sum = 0;
    const auto all = bins_of(of);
    for (int i = 0; i < kBins; ++i) {
      sum += static_cast<double>(all[static_cast<std::size_t>(i)]);
      points += text("%.1f,%.1f ", kLeft + bar * (i + 1),
                     kBottom - (kBottom - kTop) * sum / static_cast<double>(of.count()));
    }
    return "<polyline fill='none' stroke='" + std::string(colour) + "' stroke-width='1.6' points='" + points +
           "'/>";
  };
  if (samples.count() > 0) out += curve(samples, "#1c4f7c");
  if (beside != nullptr && beside->count() > 0) out += curve(*beside, "#c07a20");
  if (budget.p999 != Nanos::max()) {
    const double p999 = microseconds(budget.p999), bound = microseconds(budget.bound);
    const bool close = x_of(bound) - x_of(p999) < 40;
    if (budget.p999 < budget.bound) out += vertical(p999, "#b07a00", "budget", close ? "end" : "middle");
    out += vertical(bound, "#b03030", "bound", close && p999 < bound ? "start" : "middle");
  }
  return out + "</svg>";
}

std::string card(const LatencyRow& row) {
  const Verdict verdict = verdict_of(row);
  const char* const kind = verdict == Verdict::within ? "ok" : verdict == Verdict::over ? "bad" : "muted";
  const std::string word = "<div class='verdict " + std::string(kind) + "'>" + verdict_words(row) + "</div>";
  const auto median = row.samples.median();
  std::string out = "<div class=card><b>" + escaped(row.name) + "</b><span class=muted>" + escaped(row.note) +
                    "</span>" + word + plot(row.samples, row.budget);
  out += text("<div class=muted>%llu samples", static_cast<unsigned long long>(row.samples.count()));
  if (median) out += "; p50 " + words_for(*median) + "; max " + words_for(row.samples.max());
  for (const double q : {0.99, 0.999}) out += "; " + percentile_words(row.samples, q);
  return out + "</div></div>";
}

std::string cards(const char* title, const std::vector<LatencyRow>& rows) {
  std::string out = "<h3>" + std::string(title) + "</h3><div class=grid>";
  for (const LatencyRow& row : rows) out += card(row);
  return out + "</div>";
}

std::string timeline(const std::vector<TimelineBar>& bars) {
  if (bars.empty()) return "<p class=muted>No capture was painted in this run.</p>";
  double end = 1;
  for (const TimelineBar& bar : bars) end = std::max(end, bar.until_ms);
  const double row = 24, left = 190, width = 800, height = row * static_cast<double>(bars.size()) + 26;
  const auto x = [&](double ms) { return left + (width - left - 60) * ms / end; };
  std::string out = text("<svg viewBox='0 0 %.0f %.0f' role='img'>", width, height);
  const double step = end > 160 ? 50 : end > 60 ? 20 : 10;
  for (int tick = 0; tick * step <= end; ++tick) {
    const double ms = tick * step;
    out += text(
        "<line x1='%.1f' x2='%.1f' y1='0' y2='%.0f' stroke='#eee'/>"
        "<text x='%.1f' y='%.0f' font-size='11' fill='#666' text-anchor='middle'>%.0f ms</text>",
        x(ms), x(ms), height - 18, x(ms), height - 4, ms);
  }
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const TimelineBar& bar = bars[i];
    const double y = row * static_cast<double>(i) + 4;
    out += text(
        "<text x='%.0f' y='%.1f' font-size='12' text-anchor='end'>%s</text>"
        "<rect x='%.1f' y='%.1f' width='%.1f' height='14' rx='2' fill='%s'/>"
        "<text x='%.1f' y='%.1f' font-size='11' fill='#444'>%.1f ms</text>",
        left - 8, y + 11, bar.name.c_str(), x(bar.from_ms), y,
        std::max(1.5, x(bar.until_ms) - x(bar.from_ms)), i == 0 ? "#c8c2b6" : "#4a7fb0", x(bar.until_ms) + 5,
        y + 11, bar.until_ms - bar.from_ms);
  }
  return out + "</svg>";
}

std::string worst_steps(const std::vector<WorstStep>& worst) {
  std::string out = "<h3>The ten longest steps, as a share of their bound</h3>";
  for (const WorstStep& w : worst) {
    out += text("<details><summary>%s: %.3f ms of %.3g ms, %.3f s into the trace</summary><pre>",
                w.stage.c_str(), w.took_ms, w.bound_ms, w.at_s);
    for (const std::string& line : w.trace) out += escaped(line) + "\n";
    out += "</pre></details>";
  }
  return out;
}

std::string wake_up_cards(const std::vector<WakeUps>& all) {
  std::string out =
      "<h2>Waking up, beside a plain loop</h2><p class=muted>Blue: our thread. Orange: sleep, read the "
      "clock, no more. "
      "The two took turns in one run. The ratio says what our loop adds; the plain loop against itself says "
      "what the "
      "machine's noise makes of a ratio.</p><div class=grid>";
  for (const WakeUps& w : all) {
    const WakeUpRatios ours = median_of(w.ratios), noise = median_of(w.noise);
    out += "<div class=card><b>" + std::string(w.spec.name) +
           text("</b><span class=muted>FIFO %d</span>", w.spec.fifo_priority) + plot(w.ours, {}, &w.plain) +
           text(
               "<div class=muted>p50 ratio %.3f (noise %.3f), p99 ratio %.3f (noise %.3f): medians of %zu "
               "rounds of %zu "
               "samples; ours p50 %s, plain p50 %s; ",
               ours.p50, noise.p50, ours.p99, noise.p99, w.ratios.size(), w.samples_a_round,
               words_for(w.ours.median().value_or(Nanos{0})).c_str(),
               words_for(w.plain.median().value_or(Nanos{0})).c_str()) +
           percentile_words(w.ours, 0.99) + "; " + percentile_words(w.ours, 0.999) + "</div></div>";
  }
  return out + "</div>";
}

constexpr const char* kHowToRead =
    "<p class=muted>Bars: how often it took that long, on a logarithmic scale. Curve: the share that took no "
    "longer. "
    "Dashed: the budget, which 99.9 % must keep, and the bound, which all must. The warm-up is left "
    "out.</p>";

std::string run_section(const LatencyRun& run) {
  std::string out = text(
      "<h2>The simulated cart, %s</h2><p>%llu frames shown, %llu late, %llu slips, %llu dropped by "
      "queues.</p>",
      run.title.c_str(), static_cast<unsigned long long>(run.frames),
      static_cast<unsigned long long>(run.late_frames), static_cast<unsigned long long>(run.slips),
      static_cast<unsigned long long>(run.queue_drops));
  out += kHowToRead;
  out += cards("From end to end", run.paths) + "<h3>One capture, from the pedal's edge to the flip</h3>" +
         timeline(run.capture) + cards("Stages", run.stages) + cards("Wake-ups in the cart", run.wake_ups) +
         worst_steps(run.worst);
  for (const std::string& fault : run.guard_faults) out += "<pre class=bad>" + escaped(fault) + "</pre>";
  if (!run.library_calls.empty()) {
    out += "<details><summary>What libraries asked of heap, locks and kernel inside our steps</summary><pre>";
    for (const std::string& line : run.library_calls) out += escaped(line) + "\n";
    out += "</pre></details>";
  }
  return out;
}

}  // namespace

std::string page_of(const LatencyReport& r) {
  std::string out = "<!doctype html><html lang=en><meta charset=utf-8><title>orcart latency</title><style>" +
                    std::string(kStyle) + "</style><h1>Is this machine good enough?</h1><p>" +
                    escaped(r.machine.name) + "<br>" + escaped(r.renderer) +
                    text(", render class <b>%s</b>, panel %g Hz</p>", r.render_class.c_str(), r.panel_hz);
  out += r.machine.judged()
             ? (good_enough(r) ? "<p class=ok>Yes: every wall-clock budget that could be judged is kept.</p>"
                               : "<p class=bad>No: a wall-clock budget is missed.</p>")
             : "<p class=banner>Wall-clock budgets do not gate here: they want a PREEMPT_RT kernel and the "
               "right to SCHED_FIFO. What follows is what was seen.</p>";
  if (!r.machine.causes.empty()) {
    out +=
        "<h2>What costs latency here</h2><table><tr><th>seen</th><th "
        "style='text-align:left'>remedy</th></tr>";
    for (const Cause& cause : r.machine.causes)
      out += "<tr><td>" + escaped(cause.what) + "</td><td style='text-align:left'>" + escaped(cause.remedy) +
             "</td></tr>";
    out += "</table>";
  }
  if (!r.wake_ups.empty()) out += wake_up_cards(r.wake_ups);
  for (const LatencyRun& run : r.runs) out += run_section(run);
  return out + "<p class=muted>Research use only; not a medical device.</p></html>\n";
}

}  // namespace orcart
