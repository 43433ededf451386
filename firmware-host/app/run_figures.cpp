// Ledgers into distributions, captures into rows, what went wrong into sentences.
#include "firmware-host/app/run_figures.hpp"

#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>

#include "firmware-host/app/content_hash.hpp"

namespace orcart {
namespace {

Distribution distribution_of(const std::string& name, const std::string& note, const Budget& budget,
                             const Histogram& histogram) {
  const HistogramSnapshot snapshot = histogram.snapshot();
  Distribution d{.name = name, .note = note, .samples = snapshot.count()};
  if (budget.p999 != Nanos::max()) {
    d.budget_ms = milliseconds(budget.p999);
    d.bound_ms = milliseconds(budget.bound);
  }
  d.max_ms = milliseconds(snapshot.max());
  if (const auto median = snapshot.median()) d.p50_ms = milliseconds(*median);
  d.judged_quantile = highest_supported_quantile(snapshot.count()).value_or(0.5);
  d.judged_ms =
      milliseconds(snapshot.percentile(d.judged_quantile).value_or(snapshot.median().value_or(Nanos{0})));
  d.bins.assign(kDistributionBins, 0);
  for (std::size_t i = 0; i < histogram_buckets::kCount; ++i) {
    const std::uint64_t count = snapshot.bucket(i);
    if (count != 0)
      d.bins[static_cast<std::size_t>(distribution_bin(milliseconds(histogram_buckets::upper_edge(i))))] +=
          count;
  }
  return d;
}

Distribution path_of(const std::string& name, const std::string& note, const Budget& budget,
                     std::vector<double> samples_ms) {
  Distribution d{.name = name,
                 .note = note,
                 .budget_ms = milliseconds(budget.p999),
                 .bound_ms = milliseconds(budget.bound)};
  fill_from_samples(d, std::move(samples_ms));
  return d;
}

std::vector<Distribution> paths_of(const Cart& cart, const CartConfig& config) {
  const PathBudget budget = path_budget(cart.render_class(), config.panel.refresh_hz);
  std::vector<double> submitted, scanned, acknowledged, painted, bracket;
  for (std::size_t i = 0; i < cart.frames().size(); ++i) {
    const FrameRecord& f = cart.frames().at(i);
    submitted.push_back(milliseconds(f.submitted_at - f.dequeued_at));
    scanned.push_back(milliseconds(f.scan_out_at - f.dequeued_at));
  }
  for (std::size_t i = 0; i < cart.captures().size(); ++i) {
    const CaptureRecord& c = cart.captures().at(i);
    if (c.refusal != Refusal::none) continue;
    bracket.push_back(milliseconds(c.matched_at - c.mid_exposure));
    if (c.streaming) continue;
    if (c.acknowledged_at != Instant{}) acknowledged.push_back(milliseconds(c.acknowledged_at - c.edge_at));
    if (c.on_panel_at != Instant{}) painted.push_back(milliseconds(c.on_panel_at - c.edge_at));
  }
  const Budget bracket_budget{
      2 * period_of(config.tracker.rate_hz) + from_seconds(config.tracker.latency_ms * 1e-3) + 10ms, 60ms};
  return {path_of("dequeue to submitted", "camera frame taken to panel picture handed over",
                  budget.dequeue_to_submitted, submitted),
          path_of("dequeue to scan-out", "camera frame taken to its first line on the panel",
                  budget.dequeue_to_scan_out, scanned),
          path_of("mid-exposure to pose in hand", "captured frames", bracket_budget, bracket),
          path_of("pedal to acknowledged", "edge to the scan-out that says so", budget.pedal_to_acknowledged,
                  acknowledged),
          path_of("pedal to painted", "edge to the scan-out that shows the paint", budget.pedal_to_painted,
                  painted)};
}

const char* word_for_pose(PoseKind kind) {
  switch (kind) {
    case PoseKind::exact:
      return "exact";
    case PoseKind::interpolated:
      return "interpolated";
    case PoseKind::predicted:
      return "predicted";
    case PoseKind::none:
      break;
  }
  return "none";
}

std::vector<CaptureRow> rows_of(const Cart& cart, Instant started) {
  std::vector<CaptureRow> rows;
  for (std::size_t i = 0; i < cart.captures().size(); ++i) {
    const CaptureRecord& c = cart.captures().at(i);
    CaptureRow row{.unit = c.unit, .edge_s = seconds(c.edge_at - started)};
    row.outcome = c.refusal != Refusal::none ? "refused: " + std::string(word_for(c.refusal))
                                             : (c.undone ? "undone" : "painted");
    if (c.refusal == Refusal::none) {
      row.pose = word_for_pose(c.pose_kind);
      row.pose_distance_ms = milliseconds(c.pose_distance);
      if (c.streaming) row.outcome += " (stream)";
      if (c.acknowledged_at != Instant{} && !c.streaming)
        row.to_acknowledged_ms = milliseconds(c.acknowledged_at - c.edge_at);
      if (c.on_panel_at != Instant{} && !c.streaming)
        row.to_painted_ms = milliseconds(c.on_panel_at - c.edge_at);
    }
    rows.push_back(row);
  }
  return rows;
}

std::string counted(std::uint64_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::vector<std::string> events_of(const Cart& cart, const RunReport& r) {
  std::vector<std::string> events;
  if (r.sequence_gaps > 0)
    events.push_back(counted(r.sequence_gaps, "frame was", "frames were") +
                     " lost before they reached the cart (gaps in the driver's count).");
  if (r.frames_dropped > 0)
    events.push_back(counted(r.frames_dropped, "frame was", "frames were") +
                     " replaced by a newer one before the panel's next picture.");
  if (r.queue_drops > 0)
    events.push_back(counted(r.queue_drops, "item was", "items were") + " dropped by a full queue.");
  if (r.frames_late > 0)
    events.push_back(counted(r.frames_late, "frame", "frames") +
                     " missed the first vblank after the submit deadline.");
  std::map<std::string, int> refusals;
  for (const CaptureRow& c : r.captures)
    if (c.outcome.starts_with("refused")) ++refusals[c.outcome];
  for (const auto& [why, n] : refusals)
    events.push_back(counted(static_cast<std::uint64_t>(n), "capture was ", "captures were ") + why + ".");
  if (r.tracker_missing > 0)
    events.push_back(counted(r.tracker_missing, "poll", "polls") + " in which a tool was not seen.");
  if (r.tracker_bad_crc > 0)
    events.push_back(counted(r.tracker_bad_crc, "reply", "replies") + " of the tracker arrived damaged.");
  for (const StageLedger& ledger : cart.stage_ledgers()) {
    if (ledger.over_bound() > 0)
      events.push_back(std::string(ledger.name()) + ": " + counted(ledger.over_bound(), "step", "steps") +
                       " over the hard bound.");
  }
  return events;
}

std::string machine_name() {
  utsname name{};
  uname(&name);
  std::string processor = "unknown processor", line;
  for (std::ifstream in("/proc/cpuinfo"); std::getline(in, line);) {
    if (line.starts_with("model name")) {
      processor = line.substr(line.find(':') + 2);
      break;
    }
  }
  return processor + ", " + std::to_string(sysconf(_SC_NPROCESSORS_ONLN)) + " cores, Linux " + name.release;
}

std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm broken{};
  localtime_r(&now, &broken);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &broken);
  return text;
}

}  // namespace

double resident_mb() {
  std::string line;
  for (std::ifstream in("/proc/self/status"); std::getline(in, line);)
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024;
  return 0;
}

RunReport figures_of(Cart& cart, const RunFacts& facts) {
  const CartConfig& config = facts.config;
  const CartFigures figures = cart.figures();
  RunReport r;
  r.title = "orcart: " + config.name;
  r.cart = config.file.string();
  r.when = date_now();
  r.machine = machine_name();
  r.renderer = cart.context().renderer_name();
  r.render_class = cart.render_class() == RenderClass::software ? "software" : "gpu";
  r.pictures_by_gpu = cart.painter().picture_copy() == PictureCopy::gpu;
  r.simulated = config.simulated();
  r.duration_s = seconds(facts.ended - facts.started);
  r.panel_hz = config.panel.refresh_hz;
  r.camera_hz = config.camera.rate_hz;
  r.tracker_hz = config.tracker.rate_hz;
  r.triangles = static_cast<std::uint32_t>(facts.patient.surface.mesh.triangles.size());
  r.texel_mm = facts.patient.layout.texel_mm;
  r.frames_shown = cart.frames().size();
  for (std::size_t i = 0; i < cart.frames().size(); ++i) r.frames_late += cart.frames().at(i).late;
  r.frames_dropped = figures.frames_taken > r.frames_shown ? figures.frames_taken - r.frames_shown : 0;
  r.sequence_gaps = figures.sequence_gaps;
  r.queue_drops = figures.queue_drops;
  r.tracker_polls = figures.tracker_polls;
  r.tracker_missing = figures.tracker_missing;
  r.tracker_bad_crc = figures.tracker_bad_crc;
  r.resident_mb = facts.resident_mb;
  r.degraded = cart.lacks();
  for (const StageRow& row : kStages) {
    const StageLedger& ledger = cart.stage_ledgers()[static_cast<std::size_t>(row.id)];
    if (row.id == StageId::encoder && ledger.wall().count() == 0) continue;  // this cart has none
    r.stages.push_back(distribution_of(std::string(row.name),
                                       "thread " + std::string(spec_of(row.thread).name), ledger.budget(),
                                       ledger.wall()));
    r.stages.back().over_bound = ledger.over_bound();
  }
  for (std::size_t i = 0; i < cart.thread_ledgers().size(); ++i) {
    r.wake_ups.push_back(distribution_of(std::string(kThreads[i].spec.name), "awake minus due", {},
                                         cart.thread_ledgers()[i]->lateness));
  }
  r.paths = paths_of(cart, config);
  r.captures = rows_of(cart, facts.started);
  r.coverage_over_time = facts.coverage;
  for (int i = 0; i < 64; ++i)
    r.coverage = cart.painter().coverage();  // a few thousand tiles, counted 512 at a time
  r.painting_hash = hash_of(cart.painter().read_back().rgba);
  r.events = events_of(cart, r);
  return r;
}

}  // namespace orcart
