// Ledgers into rows, records into paths, traces into the worst steps.
#include "tools/latency/cart_run.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <thread>

#include "tools/latency/guarded_threads.hpp"

namespace orcart {
namespace {

constexpr std::size_t kTraced = 65'535;

/// A thread a core that copies memory as fast as it can, for as long as it lives.
class BusyCores {
 public:
  explicit BusyCores(MachineLoad load) {
    const unsigned count = load == MachineLoad::idle ? 0 : std::max(1U, std::thread::hardware_concurrency());
    for (unsigned i = 0; i < count; ++i)
      threads_.emplace_back([this] {
        constexpr std::size_t kHalf = 4 << 20;
        std::vector<char> memory(2 * kHalf, 1);
        // A flag alone, no partner.
        while (!over_.load(std::memory_order_relaxed))
          std::memcpy(memory.data(), memory.data() + kHalf, kHalf);
      });
  }
  ~BusyCores() {
    over_.store(true, std::memory_order_relaxed);
    for (std::thread& thread : threads_) thread.join();
  }
  BusyCores(const BusyCores&) = delete;
  BusyCores& operator=(const BusyCores&) = delete;

 private:
  std::atomic<bool> over_{false};
  std::vector<std::thread> threads_;
};

/// Fills a row sample by sample.
class RowMaker {
 public:
  void add(Nanos length) { histogram_.record(length); }
  LatencyRow row(std::string name, std::string note, const Budget& budget) const {
    return {
        .name = std::move(name), .note = std::move(note), .budget = budget, .samples = histogram_.snapshot()};
  }

 private:
  Histogram histogram_;
};

std::vector<LatencyRow> paths_of(BenchCart& bench) {
  const Cart& cart = bench.cart();
  const PathBudget budget = path_budget(cart.render_class(), bench.config().panel.refresh_hz);
  RowMaker submitted, scan_out, matched, acknowledged, painted;
  for (std::size_t i = 0; i < cart.frames().size(); ++i) {
    const FrameRecord& frame = cart.frames().at(i);
    if (frame.dequeued_at < bench.measured_from()) continue;
    submitted.add(frame.submitted_at - frame.dequeued_at);
    scan_out.add(frame.scan_out_at - frame.dequeued_at);
  }
  for (std::size_t i = 0; i < cart.captures().size(); ++i) {
    const CaptureRecord& c = cart.captures().at(i);
    if (c.edge_at < bench.measured_from() || c.refusal != Refusal::none) continue;
    matched.add(c.matched_at - c.mid_exposure);
    if (c.acknowledged_at != Instant{}) acknowledged.add(c.acknowledged_at - c.edge_at);
    if (c.on_panel_at != Instant{}) painted.add(c.on_panel_at - c.edge_at);
  }
  return {submitted.row("dequeue to submitted", "frame taken to picture handed over",
                        budget.dequeue_to_submitted),
          scan_out.row("dequeue to scan-out", "frame taken to its first line on the panel",
                       budget.dequeue_to_scan_out),
          matched.row("mid-exposure to pose", "captured frames", {Nanos{60ms}, Nanos{60ms}}),
          acknowledged.row("pedal to acknowledged", "edge to the scan-out that says so",
                           budget.pedal_to_acknowledged),
          painted.row("pedal to painted", "edge to the scan-out that shows it", budget.pedal_to_painted)};
}

std::vector<TimelineBar> capture_timeline(BenchCart& bench) {
  const auto& captures = bench.cart().captures();
  for (std::size_t i = captures.size(); i > 0; --i) {
    const CaptureRecord& c = captures.at(i - 1);
    if (c.refusal != Refusal::none || c.on_panel_at == Instant{} || c.acknowledged_at == Instant{}) continue;
    const auto ms = [&](Instant t) { return milliseconds(t - c.edge_at); };
    return {{"pedal edge to flip", 0, ms(c.on_panel_at)},
            {"acknowledged on the panel", 0, ms(c.acknowledged_at)},
            {"edge to mid-exposure", 0, ms(c.mid_exposure)},
            {"pose bracket in hand", ms(c.mid_exposure), ms(c.matched_at)},
            {"cut out (mapper)", ms(c.matched_at), ms(c.mapped_at)},
            {"painted", ms(c.mapped_at), ms(c.painted_at)},
            {"drawn, flipped", ms(c.painted_at), ms(c.on_panel_at)}};
  }
  return {};
}

struct Traced {
  std::size_t thread = 0;
  TraceEvent event;
};

const StageRow* row_of_step(std::size_t thread, std::uint16_t stage) {
  std::uint16_t seen = 0;
  for (const StageRow& row : kStages)
    if (static_cast<std::size_t>(row.thread) == thread && seen++ == stage) return &row;
  return nullptr;
}

std::string words_of(const Traced& traced, Instant zero) {
  const TraceEvent& e = traced.event;
  const StageRow* const row = row_of_step(traced.thread, e.stage);
  char line[160];
  std::snprintf(line, sizeof line, "%+10.3f ms  %-8.8s %s%.*s%s", milliseconds(e.at - zero),
                kThreads[traced.thread].spec.name.data(),
                e.kind == TraceKind::wake   ? "wakes, late by "
                : e.kind == TraceKind::slip ? "slips, periods skipped: "
                                            : "",
                e.kind == TraceKind::step && row != nullptr ? static_cast<int>(row->name.size()) : 0,
                row != nullptr ? row->name.data() : "",
                e.kind == TraceKind::slip   ? std::to_string(e.value).c_str()
                : e.kind == TraceKind::wake ? words_for(Nanos{e.value}).c_str()
                                            : (" took " + words_for(e.length)).c_str());
  return line;
}

std::vector<WorstStep> worst_of(BenchCart& bench) {
  const Cart& cart = bench.cart();
  std::vector<Traced> all;
  for (std::size_t t = 0; t < cart.traces().size(); ++t)
    for (const TraceEvent& event : cart.traces()[t]->snapshot())
      if (event.at >= bench.measured_from()) all.push_back({t, event});
  std::ranges::sort(all, {}, [](const Traced& t) { return t.event.at; });
  const auto share = [&](const Traced& t) {
    const StageRow* const row = row_of_step(t.thread, t.event.stage);
    if (t.event.kind != TraceKind::step || row == nullptr) return 0.0;
    return static_cast<double>(t.event.length.count()) /
           static_cast<double>(budget_of(row->id, cart.render_class()).bound.count());
  };
  std::vector<Traced> longest = all;
  const std::size_t count = std::min<std::size_t>(10, longest.size());
  std::ranges::partial_sort(longest, longest.begin() + static_cast<std::ptrdiff_t>(count),
                            std::ranges::greater{}, share);
  std::vector<WorstStep> worst;
  for (std::size_t i = 0; i < count; ++i) {
    const TraceEvent& e = longest[i].event;
    const StageRow* const row = row_of_step(longest[i].thread, e.stage);
    if (e.kind != TraceKind::step || row == nullptr) continue;
    WorstStep one{.stage = std::string(row->name),
                  .at_s = seconds(e.at - bench.measured_from()),
                  .took_ms = milliseconds(e.length),
                  .bound_ms = milliseconds(budget_of(row->id, cart.render_class()).bound),
                  .trace = {}};
    for (const Traced& t : all)
      if (t.event.at + t.event.length >= e.at - 2ms && t.event.at <= e.at + e.length && one.trace.size() < 60)
        one.trace.push_back(words_of(t, e.at));
    worst.push_back(std::move(one));
  }
  return worst;
}

/// What was counted before the warm-up was over, to be taken off in the end: the first turns compile shaders
/// and fetch pages, and are no cart's that is armed.
struct WarmUp {
  std::vector<HistogramSnapshot> stages, own, wake_ups;
  std::uint64_t slips = 0;

  void take(const Cart& cart) {
    for (const StageLedger& ledger : cart.stage_ledgers()) {
      stages.push_back(ledger.wall().snapshot());
      own.push_back(ledger.cpu().snapshot());
    }
    for (const ThreadLedger* ledger : cart.thread_ledgers()) {
      wake_ups.push_back(ledger->lateness.snapshot());
      slips += ledger->slips;
    }
  }
};

/// Bucket by bucket, so the longest is told as its bucket's upper edge: at most 0.8 % above what it was.
HistogramSnapshot without(const HistogramSnapshot& before, const HistogramSnapshot& all) {
  Histogram rest;
  for (std::size_t i = 0; i < histogram_buckets::kCount; ++i)
    for (std::uint64_t n = before.bucket(i); n < all.bucket(i); ++n)
      rest.record(std::min(histogram_buckets::upper_edge(i), all.max()));
  return rest.snapshot();
}

LatencyRun gathered(BenchCart& bench, const WarmUp& before, const char* title) {
  const Cart& cart = bench.cart();
  LatencyRun run{.title = title};
  for (const StageRow& row : kStages) {
    const auto index = static_cast<std::size_t>(row.id);
    const StageLedger& ledger = cart.stage_ledgers()[index];
    if (ledger.wall().count() == 0) continue;
    run.stages.push_back({.name = std::string(row.name),
                          .note = "thread " + std::string(spec_of(row.thread).name),
                          .budget = ledger.budget(),
                          .samples = without(before.stages[index], ledger.wall().snapshot()),
                          .longest_own = without(before.own[index], ledger.cpu().snapshot()).max()});
  }
  for (std::size_t i = 0; i < cart.thread_ledgers().size(); ++i) {
    const ThreadLedger& ledger = *cart.thread_ledgers()[i];
    const bool real_time = kThreads[i].spec.fifo_priority > 0;
    run.wake_ups.push_back({.name = std::string(kThreads[i].spec.name),
                            .note = "awake minus due",
                            .budget = real_time ? kWakeUpBudget : Budget{},
                            .samples = without(before.wake_ups[i], ledger.lateness.snapshot())});
    run.slips += ledger.slips;
  }
  run.slips -= before.slips;
  run.paths = paths_of(bench);
  run.capture = capture_timeline(bench);
  run.worst = worst_of(bench);
  for (std::size_t i = 0; i < cart.frames().size(); ++i) {
    if (cart.frames().at(i).dequeued_at < bench.measured_from()) continue;
    ++run.frames;
    run.late_frames += cart.frames().at(i).late;
  }
  run.queue_drops = cart.figures().queue_drops;
  return run;
}

}  // namespace

Result<MeasuredRun> measure_cart(const CartRunWish& wish, const std::function<void(double)>& tick) {
  GuardedThreads threads;
  auto made = BenchCart::create({.config = wish.config,
                                 .duration_s = wish.duration_s,
                                 .wrapper = wish.guarded ? &threads : nullptr,
                                 .traced = kTraced});
  if (!made) return tl::unexpected(made.error());
  BenchCart& bench = **made;
  WarmUp before;
  {
    const BusyCores load(wish.load);
    const auto warm = [&] {
      before.take(bench.cart());
      threads.arm();
    };
    if (auto ran = bench.run(warm, tick); !ran) return tl::unexpected(ran.error());
  }
  MeasuredRun measured{.run = gathered(bench, before, wish.load == MachineLoad::idle ? "idle" : "under load"),
                       .render_class = bench.cart().render_class() == RenderClass::gpu ? "gpu" : "software",
                       .renderer = bench.cart().context().renderer_name()};
  if (wish.guarded) {
    measured.run.guard_faults = faults_of(threads);
    measured.run.library_calls = library_lines(threads);
  }
  return measured;
}

}  // namespace orcart
