// Relacy (Vyukov) drives the shipped templates: its atomics take the place of std::atomic, its variables that
// of what the channels carry.
#include "tools/latency/channel_model.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <source_location>
#include <sstream>
#include <streambuf>
#include <string_view>

#include "realtime/kernel/mailbox.hpp"
#include "realtime/kernel/pool.hpp"
#include "realtime/kernel/spsc_queue.hpp"
#include "realtime/kernel/trace_ring.hpp"

// The shipped headers come first: Relacy's macros take the place of memory orders and of new.
#include <relacy/relacy.hpp>
#undef memory_order_relaxed
#undef memory_order_consume
#undef memory_order_acquire
#undef memory_order_release
#undef memory_order_acq_rel
#undef memory_order_seq_cst
#undef new
#undef delete
#undef malloc
#undef calloc
#undef realloc
#undef free
#undef assert
#undef errno

namespace orcart {
namespace {

std::string_view base_of(std::string_view path) {
  return path.substr(path.rfind('/') + 1);
}

/// Of fixed size: Relacy takes the place of operator new, and checks what is allocated while it runs.
struct Watch {
  struct Site {
    std::string_view file;
    unsigned line = 0;
    bool publishes = false;
    friend bool operator==(const Site&, const Site&) = default;
  };
  Site weakened;
  std::array<Site, 32> ordered;
  std::size_t count = 0;
};
Watch watch;  // one check at a time: Relacy itself has one context

/// What the checker is told the order is.
rl::memory_order order_at(std::memory_order order, const std::source_location& where) {
  if (order == std::memory_order_relaxed) return rl::mo_relaxed;
  const Watch::Site site{.file = base_of(where.file_name()),
                         .line = where.line(),
                         .publishes = order == std::memory_order_release};
  auto* const end = watch.ordered.begin() + watch.count;
  if (std::find(watch.ordered.begin(), end, site) == end && watch.count < watch.ordered.size())
    watch.ordered[watch.count++] = site;
  if (watch.weakened == site) return rl::mo_relaxed;
  switch (order) {
    case std::memory_order_acquire:
      return rl::mo_acquire;
    case std::memory_order_release:
      return rl::mo_release;
    case std::memory_order_acq_rel:
      return rl::mo_acq_rel;
    default:
      return rl::mo_seq_cst;
  }
}

rl::debug_info info_at(const std::source_location& where) {
  return {where.function_name(), where.file_name(), where.line()};
}

/// std::atomic's interface as far as the channels use it; the default argument knows who called.
template <class T>
class ModelAtomic {
 public:
  ModelAtomic(T value = T(), std::source_location where = std::source_location::current()) {
    atomic_.store(value, rl::mo_relaxed, info_at(where));
  }
  T load(std::memory_order order, std::source_location where = std::source_location::current()) const {
    return atomic_.load(order_at(order, where), info_at(where));
  }
  void store(T value, std::memory_order order, std::source_location where = std::source_location::current()) {
    atomic_.store(value, order_at(order, where), info_at(where));
  }
  T exchange(T value, std::memory_order order, std::source_location where = std::source_location::current()) {
    return atomic_.exchange(value, order_at(order, where), info_at(where));
  }

 private:
  mutable rl::atomic<T> atomic_;
};

/// What a channel carries: an access that is not ordered after the last one is a data race.
struct Cargo {
  Cargo() { set(0); }
  Cargo(const Cargo& other) { set(other.get()); }
  Cargo& operator=(const Cargo& other) {
    set(other.get());
    return *this;
  }
  explicit Cargo(int v) { set(v); }
  int get() const { return value(RL_INFO); }
  void set(int v) { value(RL_INFO) = v; }
  mutable rl::var<int> value;
};

constexpr int kItems = 4;

void expect(bool holds, const char* what) {
  if (!holds) rl::ctx().fail_test(what, rl::test_result_user_assert_failed, RL_INFO);
}

struct QueueTest : rl::test_suite<QueueTest, 2> {
  SpscQueue<Cargo, ModelAtomic> queue{2};
  void thread(unsigned index) {
    int expected = 1;
    for (int i = 0; i < 2 * kItems; ++i) {
      if (index == 0) {
        if (expected <= kItems && queue.try_push(Cargo(expected))) ++expected;
      } else if (Cargo cargo; queue.try_pop(cargo)) {
        expect(cargo.get() == expected++, "the queue lost or repeated an element");
      }
    }
  }
};

/// One element passes through, and a third thread counts: what it sees of the consumer must imply the
/// producer's.
struct QueueSizeTest : rl::test_suite<QueueSizeTest, 3> {
  SpscQueue<Cargo, ModelAtomic> queue{2};
  void thread(unsigned index) {
    Cargo cargo(1);
    if (index == 0) (void)queue.try_push(cargo);
    if (index == 1) (void)queue.try_pop(cargo);
    if (index == 2) expect(queue.size() <= 1, "more elements than there ever were");
  }
};

struct MailboxTest : rl::test_suite<MailboxTest, 2> {
  LatestMailbox<Cargo, ModelAtomic> mailbox;
  void thread(unsigned index) {
    int last = 0;
    for (int i = 1; i <= kItems; ++i) {
      Cargo cargo(i);
      if (index == 0) {
        mailbox.post(cargo);
      } else if (mailbox.take(cargo)) {
        expect(cargo.get() > last, "the mailbox went back in time");
        last = cargo.get();
      }
    }
  }
};

struct PoolTest : rl::test_suite<PoolTest, 2> {
  Pool<Cargo, ModelAtomic> pool{2};
  SpscQueue<PoolHandle, ModelAtomic> lane{2};
  void thread(unsigned index) {
    for (int i = 1; i <= kItems; ++i) {
      if (index == 0) {
        const auto handle = pool.take();
        if (!handle) continue;
        pool[*handle].set(i);
        expect(lane.try_push(*handle), "more handles than slots");
      } else if (PoolHandle handle; lane.try_pop(handle)) {
        expect(pool[handle].get() > 0, "a slot was taken while it was read");
        pool.give_back(handle);
      }
    }
  }
};

struct TraceTest : rl::test_suite<TraceTest, 2> {
  BasicTraceRing<ModelAtomic> ring{1};
  void thread(unsigned index) {
    for (std::int64_t i = 1; i <= 3; ++i) {
      if (index == 0) {
        ring.write({.at = instant_from_nanos(i), .length = Nanos{i}, .value = i});
        continue;
      }
      std::array<TraceEvent, 1> events;
      if (ring.read(events) == 0) continue;
      const std::int64_t whole = events[0].value;
      expect(whole > 0 && events[0].length.count() == whole && nanos_since_zero(events[0].at) == whole,
             "the reader got an event that is half of one and half of another");
    }
  }
};

/// The tail of Relacy's report of the faulty schedule: its own paths and blank lines left out.
std::vector<std::string> last_lines(const std::string& report) {
  constexpr std::size_t kMost = 24;
  std::vector<std::string> lines;
  std::istringstream in(report);
  const auto begin = report.find("execution history");
  in.seekg(begin == std::string::npos ? 0 : static_cast<std::streamoff>(begin));
  for (std::string line; std::getline(in, line) && !line.starts_with("thread 0:");)
    if (line.starts_with('[')) lines.push_back(line);
  if (lines.size() > kMost) lines.erase(lines.begin(), lines.end() - kMost);
  return lines;
}

/// What is written to it, as far as there is room: Relacy reports from within its own operator new, where a
/// stream must not allocate.
template <std::size_t kRoom>
class FixedText final : public std::streambuf {
 public:
  FixedText() : room_(std::make_unique<char[]>(kRoom)) { setp(room_.get(), room_.get() + kRoom); }
  std::string text() const { return {pbase(), pptr()}; }

 private:
  std::unique_ptr<char[]> room_;
};

template <class Test>
ModelVerdict run(std::uint64_t schedules) {
  FixedText<1 << 20> report;
  FixedText<1 << 10> progress;
  std::ostream report_stream(&report), progress_stream(&progress);
  rl::test_params parameters;
  parameters.iteration_count = schedules;
  parameters.search_type = rl::random_scheduler_type;
  parameters.output_stream = &report_stream;
  parameters.progress_stream = &progress_stream;
  const bool holds = rl::simulate<Test>(parameters);
  ModelVerdict verdict{.holds = holds, .schedules = holds ? schedules : parameters.stop_iteration};
  if (!holds) {
    verdict.fault = rl::test_result_str(parameters.test_result);
    verdict.history = last_lines(report.text());
  }
  return verdict;
}

}  // namespace

ModelVerdict check_channel(Channel channel, std::uint64_t schedules,
                           const std::optional<AtomicSite>& weakened) {
  watch = {};
  if (weakened)
    watch.weakened = {.file = weakened->file, .line = weakened->line, .publishes = weakened->publishes};
  ModelVerdict verdict;
  switch (channel) {
    case Channel::queue:
      verdict = run<QueueTest>(schedules);
      break;
    case Channel::queue_size:
      verdict = run<QueueSizeTest>(schedules);
      break;
    case Channel::mailbox:
      verdict = run<MailboxTest>(schedules);
      break;
    case Channel::pool:
      verdict = run<PoolTest>(schedules);
      break;
    case Channel::trace_ring:
      verdict = run<TraceTest>(schedules);
      break;
  }
  for (std::size_t i = 0; i < watch.count; ++i)
    verdict.ordered.push_back({.file = std::string(watch.ordered[i].file),
                               .line = watch.ordered[i].line,
                               .publishes = watch.ordered[i].publishes});
  return verdict;
}

}  // namespace orcart
