// A stage within a stage that misbehaves; outside of it the guards, as on any cart.
#include "tools/latency/seed_bugs.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <thread>

#include "firmware-host/stages/pedal_stage.hpp"
#include "tools/latency/guarded_threads.hpp"

namespace orcart {
namespace {

constexpr std::array<std::string_view, 7> kNames{"alloc", "lock", "write",  "fault",
                                                 "late",  "edge", "relaxed"};

/// Where each bug lives, and what it asks for.
struct Seed {
  StageId stage;
  guards::Ask ask;
};
Seed seed_of(SeededBug bug) {
  switch (bug) {
    case SeededBug::lock:
      return {StageId::tracker, guards::Ask::lock};
    case SeededBug::write:
      return {StageId::camera, guards::Ask::system_call};
    case SeededBug::fault:
      return {StageId::pedal, guards::Ask::page_fault};
    case SeededBug::late:
      return {StageId::mapper, guards::Ask::overrun};
    default:
      return {StageId::mapper, guards::Ask::allocation};
  }
}

/// Does nothing wrong until told to; then, at every step.
class MisbehavingStage final : public Stage {
 public:
  static constexpr std::size_t kPage = 4096, kPages = 4096;

  MisbehavingStage(Stage& stage, SeededBug bug) : stage_(stage), bug_(bug) {
    void* const memory =
        mmap(nullptr, kPages * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    untouched_ = memory != MAP_FAILED ? static_cast<volatile char*>(memory) : nullptr;
    nowhere_ = open("/dev/null", O_WRONLY | O_CLOEXEC);
  }
  ~MisbehavingStage() override {
    if (untouched_ != nullptr) munmap(const_cast<char*>(untouched_), kPages * kPage);
    if (nowhere_ >= 0) close(nowhere_);
  }
  std::string_view name() const noexcept override { return stage_.name(); }
  void enter_thread() noexcept override { stage_.enter_thread(); }
  void leave_thread() noexcept override { stage_.leave_thread(); }
  StepReport step(Instant now) noexcept override {
    StepReport report = stage_.step(now);
    if (!on_.load(std::memory_order_relaxed)) return report;  // a flag alone, no partner
    switch (bug_) {
      case SeededBug::alloc:
        allocate();
        break;
      case SeededBug::lock:
        lock();
        break;
      case SeededBug::write:
        write_out();
        break;
      case SeededBug::fault:
        touch_new_page();
        break;
      case SeededBug::late:
        take_too_long(now);
        break;
      default:
        break;
    }
    return report;
  }
  void start() { on_.store(true, std::memory_order_relaxed); }

 private:
  [[gnu::noinline]] void allocate() { delete[] std::exchange(kept_, new char[64]); }
  [[gnu::noinline]] void lock() {
    const std::lock_guard held(mutex_);
    ++steps_;
  }
  [[gnu::noinline]] void write_out() {
    if (::write(nowhere_, "x", 1) == 1) ++steps_;
  }
  [[gnu::noinline]] void touch_new_page() {
    if (untouched_ != nullptr && steps_ < kPages) untouched_[steps_++ * kPage] = 1;
  }
  [[gnu::noinline]] void take_too_long(Instant began) {
    const RealClock clock;
    const Nanos length = 2 * row_of(StageId::mapper).software.bound;
    while (clock.now() < began + length) ++steps_;  // bound: the clock
  }

  Stage& stage_;
  SeededBug bug_;
  std::atomic<bool> on_{false};
  std::mutex mutex_;
  volatile char* untouched_ = nullptr;
  int nowhere_ = -1;
  char* kept_ = nullptr;
  std::size_t steps_ = 0;
};

/// The bug inside, the guards around it.
class BuggyThreads final : public StageWrapper {
 public:
  explicit BuggyThreads(SeededBug bug) : bug_(bug) {}
  Stage& around(const ThreadSpec& thread, StageId id, Stage& stage) override {
    if (id != seed_of(bug_).stage) return guards.around(thread, id, stage);
    misbehaving = std::make_unique<MisbehavingStage>(stage, bug_);
    return guards.around(thread, id, *misbehaving);
  }
  GuardedThreads guards;
  std::unique_ptr<MisbehavingStage> misbehaving;

 private:
  SeededBug bug_;
};

/// Looks at the threads every half millisecond, for as long as it lives.
class Watcher {
 public:
  explicit Watcher(GuardedThreads& threads)
      : thread_([&threads, this] {
          RealClock clock;
          while (!over_.load(std::memory_order_relaxed)) {  // a flag alone, no partner
            threads.ask_late_steps(clock.now());
            clock.sleep_until(clock.now() + 500us);
          }
        }) {}
  ~Watcher() {
    over_.store(true, std::memory_order_relaxed);
    thread_.join();
  }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

 private:
  std::atomic<bool> over_{false};
  std::thread thread_;
};

Result<BugHunt> hunt_in_cart(SeededBug bug, const CartConfig& config) {
  if (!guards::kGuardsWork)
    return BugHunt{.caught = false, .account = "this build's sanitizer stands in for the guards"};
  BuggyThreads threads(bug);
  auto bench = BenchCart::create({.config = config, .duration_s = 1, .wrapper = &threads});
  if (!bench) return tl::unexpected(bench.error());
  std::optional<Watcher> watcher;
  const auto go_wrong = [&] {
    threads.guards.arm();
    if (bug == SeededBug::late) watcher.emplace(threads.guards);
    threads.misbehaving->start();
  };
  auto ran = (*bench)->run(go_wrong, {});
  watcher.reset();
  if (!ran) return tl::unexpected(ran.error());
  BugHunt result;
  for (const std::string& fault : faults_of(threads.guards)) {
    if (fault.find("MisbehavingStage") == std::string::npos) continue;
    if (fault.find(guards::word_for(seed_of(bug).ask)) == std::string::npos) continue;
    result.caught = true;
    result.account += fault;
  }
  if (bug == SeededBug::late) {
    const StageLedger& ledger = (*bench)->cart().stage_ledgers()[static_cast<std::size_t>(StageId::mapper)];
    result.caught = result.caught && ledger.over_bound() > 0;
    result.account +=
        "  its ledger: " + std::to_string(ledger.over_bound()) + " steps over the bound of 3 ms\n";
  }
  return result;
}

/// Three presses, and the driver loses the second one's release.
BugHunt hunt_lost_edge() {
  SimulatedClock clock;
  const Instant start = clock.now();
  GpioScript script{.edges = {}, .lost = {4}};
  for (const Nanos at : {1s, 2s, 3s}) {
    script.edges.push_back({.at = start + at, .kind = EdgeKind::pressed});
    script.edges.push_back({.at = start + at + 110ms, .kind = EdgeKind::released});
  }
  SimulatedGpio line(clock, script);
  Lanes lanes({.poses = 1, .pedal = kPedalQueueDepth, .frames = 1, .orders = 1, .patches = 1});
  PedalStage stage(line, {}, lanes);
  BugHunt result;
  for (; clock.now() < start + 5s; clock.advance_by(1ms)) {
    (void)stage.step(clock.now());
    for (PedalEvent event; lanes.pedal.try_pop(event);) {
      if (event.kind != PedalEventKind::lost_edge) continue;
      char line_of[200];
      std::snprintf(line_of, sizeof line_of,
                    "thread pedal, stage pedal: an edge was lost before the one stamped %.3f s, after the "
                    "press of unit "
                    "%u: PedalGestures reports lost_edge, and ignores the pedal until it is up\n",
                    seconds(event.at - start), event.unit);
      result = {.caught = true, .account = line_of};
    }
  }
  return result;
}

struct CloseFile {
  void operator()(std::FILE* file) const { pclose(file); }
};

/// The checker takes the place of operator new, so it is a program of its own.
BugHunt hunt_relaxed() {
  std::error_code error;
  const auto checker =
      std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "orcart-check-channels";
  if (!std::filesystem::exists(checker))
    return {.caught = false,
            .account =
                checker.string() + " is not there: this build was configured without Relacy (relacy-dev)\n"};
  const std::unique_ptr<std::FILE, CloseFile> pipe(
      popen(("'" + checker.string() + "' --weaken-queue").c_str(), "re"));
  BugHunt result;
  char line[512];
  while (pipe && std::fgets(line, sizeof line, pipe.get()) != nullptr) result.account += line;
  result.caught = result.account.starts_with("caught: ");
  return result;
}

}  // namespace

std::string_view name_of(SeededBug bug) {
  return kNames[static_cast<std::size_t>(bug)];
}

Result<BugHunt> hunt(SeededBug bug, const CartConfig& config) {
  if (bug == SeededBug::edge) return hunt_lost_edge();
  if (bug == SeededBug::relaxed) return hunt_relaxed();
  return hunt_in_cart(bug, config);
}

}  // namespace orcart
