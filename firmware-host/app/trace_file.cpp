// Rings and ledgers into the Trace Event Format.
#include "firmware-host/app/trace_file.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "firmware-host/files/whole_file.hpp"

namespace orcart {
namespace {

constexpr Nanos kLateWake = 250us;  // the worst a PREEMPT_RT cart may show
constexpr int kFrameTrack = 100, kCaptureTrack = 101;

/// Collects events; each knows its track.
class Events {
 public:
  explicit Events(Instant zero) : zero_(zero) {
    add("{\"ph\":\"M\",\"pid\":1,\"name\":\"process_name\",\"args\":{\"name\":\"orcartd\"}}");
  }

  void track(int id, std::string_view name) {
    add("{\"ph\":\"M\",\"pid\":1,\"tid\":%d,\"name\":\"thread_name\",\"args\":{\"name\":\"%.*s\"}}", id,
        static_cast<int>(name.size()), name.data());
  }
  void span(int track, std::string_view name, Instant at, Nanos length, const std::string& arguments) {
    add("{\"ph\":\"X\",\"pid\":1,\"tid\":%d,\"name\":\"%.*s\",\"ts\":%.3f,\"dur\":%.3f,\"args\":{%s}}", track,
        static_cast<int>(name.size()), name.data(), microseconds(at - zero_), microseconds(length),
        arguments.c_str());
  }
  void mark(int track, const char* name, Instant at, const std::string& arguments) {
    add("{\"ph\":\"i\",\"s\":\"t\",\"pid\":1,\"tid\":%d,\"name\":\"%s\",\"ts\":%.3f,\"args\":{%s}}", track,
        name, microseconds(at - zero_), arguments.c_str());
  }
  /// Overlapping lengths of one kind: the reader draws each id on a line of its own, what lies inside another
  /// below it. `parts` adds those; an outer length ends after its parts.
  template <class Parts>
  void stretch(int track, const char* kind, std::uint32_t id, const char* name, Instant from, Instant until,
               Parts&& parts) {
    if (from == Instant{} || until < from) return;
    edge('b', track, kind, id, name, from);
    parts();
    edge('e', track, kind, id, name, until);
  }
  void stretch(int track, const char* kind, std::uint32_t id, const char* name, Instant from, Instant until) {
    stretch(track, kind, id, name, from, until, [] {});
  }
  std::string text() const { return "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n" + text_ + "\n]}\n"; }

 private:
  void edge(char phase, int track, const char* kind, std::uint32_t id, const char* name, Instant at) {
    add("{\"ph\":\"%c\",\"cat\":\"%s\",\"id\":%u,\"pid\":1,\"tid\":%d,\"name\":\"%s\",\"ts\":%.3f}", phase,
        kind, id, track, name, microseconds(at - zero_));
  }
  template <class... Args>
  void add(const char* format, Args... args) {
    char line[512];
    std::snprintf(line, sizeof line, format, args...);
    if (!text_.empty()) text_ += ",\n";
    text_ += line;
  }
  Instant zero_;
  std::string text_;
};

std::string number(const char* name, std::int64_t value) {
  return "\"" + std::string(name) + "\":" + std::to_string(value);
}

std::vector<std::string_view> stages_of(ThreadId thread) {
  std::vector<std::string_view> names;
  for (const StageRow& row : kStages)
    if (row.thread == thread) names.push_back(row.name);
  return names;
}

void add_thread(Events& events, ThreadId id, const std::vector<TraceEvent>& traced) {
  const int track = static_cast<int>(id) + 1;
  const auto names = stages_of(id);
  events.track(track, spec_of(id).name);
  for (const TraceEvent& event : traced) {
    if (event.kind == TraceKind::step && event.stage < names.size())
      events.span(track, names[event.stage], event.at, event.length, number("items", event.value));
    if (event.kind == TraceKind::slip) events.mark(track, "slip", event.at, number("skipped", event.value));
    if (event.kind == TraceKind::wake && event.value > kLateWake.count())
      events.mark(track, "late wake-up", event.at, number("late_ns", event.value));
  }
}

void add_frames(Events& events, const Ledger<FrameRecord>& frames) {
  events.track(kFrameTrack, "frames");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameRecord& frame = frames.at(i);
    const auto id = frame.sequence;
    const auto part = [&](const char* name, Instant from, Instant until) {
      events.stretch(kFrameTrack, "frame", id, name, from, until);
    };
    events.stretch(kFrameTrack, "frame", id, frame.late ? "frame (late)" : "frame", frame.mid_exposure,
                   frame.scan_out_at, [&] {
                     part("exposed, read out", frame.mid_exposure, frame.dequeued_at);
                     part("to the GPU", frame.dequeued_at, frame.uploaded_at);
                     part("drawn", frame.uploaded_at, frame.submitted_at);
                     part("waits for its flip", frame.submitted_at, frame.scan_out_at);
                   });
  }
}

void add_captures(Events& events, const Ledger<CaptureRecord>& captures) {
  events.track(kCaptureTrack, "captures");
  for (std::size_t i = 0; i < captures.size(); ++i) {
    const CaptureRecord& c = captures.at(i);
    if (c.refusal != Refusal::none) {
      events.mark(kCaptureTrack, "capture refused", c.edge_at, number("unit", c.unit));
      continue;
    }
    const auto id = static_cast<std::uint32_t>(i);  // frames of a stream share their unit
    const auto part = [&](const char* name, Instant from, Instant until) {
      events.stretch(kCaptureTrack, "capture", id, name, from, until);
    };
    const bool asked_for = i == 0 || captures.at(i - 1).unit != c.unit;  // the others follow in the stream
    events.stretch(kCaptureTrack, "capture", id, "capture", asked_for ? c.edge_at : c.mid_exposure,
                   c.on_panel_at, [&] {
                     if (asked_for) part("edge to mid-exposure", c.edge_at, c.mid_exposure);
                     part("to its pose", c.mid_exposure, c.matched_at);
                     part("cut out", c.matched_at, c.mapped_at);
                     part("painted", c.mapped_at, c.painted_at);
                     part("onto the panel", c.painted_at, c.on_panel_at);
                   });
  }
}

}  // namespace

std::string trace_of(const Cart& cart) {
  std::vector<std::vector<TraceEvent>> traced;
  Instant zero = Instant::max();
  for (const auto& ring : cart.traces()) {
    traced.push_back(ring->snapshot());
    if (!traced.back().empty()) zero = std::min(zero, traced.back().front().at);
  }
  if (cart.frames().size() > 0) zero = std::min(zero, cart.frames().at(0).mid_exposure);
  if (cart.captures().size() > 0) zero = std::min(zero, cart.captures().at(0).edge_at);
  Events events(zero == Instant::max() ? Instant{} : zero);
  for (std::size_t i = 0; i < traced.size(); ++i) add_thread(events, static_cast<ThreadId>(i), traced[i]);
  add_frames(events, cart.frames());
  add_captures(events, cart.captures());
  return events.text();
}

Result<void> write_trace(const std::filesystem::path& file, const Cart& cart) {
  auto written = write_whole_file(file, trace_of(cart));
  if (!written) return fail("the trace: " + written.error().message);
  return {};
}

}  // namespace orcart
