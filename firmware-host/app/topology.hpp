// THE table: every thread, stage, budget and queue of the cart. Threads, monitors, panel, reports and tests
// read it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "realtime/base/instant.hpp"
#include "realtime/kernel/budget.hpp"
#include "realtime/kernel/thread_spec.hpp"
#include "render/egl/context.hpp"

namespace orcart {

enum class ThreadId : std::uint8_t { pedal, tracker, camera, mapping, render, session };
inline constexpr std::size_t kThreadCount = 6;

/// In the order of the way of the data.
enum class StageId : std::uint8_t { pedal, encoder, tracker, camera, sync, mapper, painter, panel, session };
inline constexpr std::size_t kStageCount = 9;

struct StageRow {
  StageId id;
  std::string_view name;
  ThreadId thread;
  Budget gpu;       ///< what one step may take on a cart with a GPU
  Budget software;  ///< the same under llvmpipe
  std::string_view on_overrun;
};

/// Budgets of one step of each stage. The tracker's and camera's rows are the host's own work; waiting for
/// the wire or the exposure is in the paths below.
inline constexpr std::array<StageRow, kStageCount> kStages{{
    {StageId::pedal, "pedal", ThreadId::pedal, {1ms, 5ms}, {1ms, 5ms}, "count"},
    {StageId::encoder, "encoder", ThreadId::pedal, {1ms, 5ms}, {1ms, 5ms}, "carry"},
    {StageId::tracker, "tracker", ThreadId::tracker, {3ms, 8ms}, {3ms, 8ms}, "skip missed, keep phase"},
    {StageId::camera, "camera", ThreadId::camera, {500us, 2ms}, {500us, 2ms}, "skip"},
    {StageId::sync, "match", ThreadId::mapping, {20us, 50us}, {20us, 50us}, "-"},
    {StageId::mapper, "mapper", ThreadId::mapping, {2ms, 3ms}, {2ms, 3ms}, "carry the rest, say so"},
    {StageId::painter, "upload + paint", ThreadId::render, {3ms, 5ms}, {8ms, 20ms}, "carry"},
    {StageId::panel, "render + submit", ThreadId::render, {3ms, 5ms}, {22ms, 30ms}, "repeat counted"},
    {StageId::session, "session", ThreadId::session, {500ms, 2s}, {500ms, 2s}, "warn"},
}};

/// Threads; the rates marked 0 are event-driven. Tracker, camera and panel rates come from the configuration.
inline constexpr double kMappingRateHz = 250;
inline constexpr double kSessionRateHz = 50;
/// Of each real-time thread on a PREEMPT_RT cart: awake minus due.
inline constexpr Budget kWakeUpBudget{100us, 250us};
struct ThreadRow {
  ThreadId id;
  ThreadSpec spec;
};
inline constexpr std::array<ThreadRow, kThreadCount> kThreads{{
    {ThreadId::pedal, {.name = "pedal", .rate_hz = 0, .fifo_priority = 82, .event_timeout = 5ms}},
    {ThreadId::tracker, {.name = "tracker", .rate_hz = 0, .fifo_priority = 80, .event_timeout = 2ms}},
    {ThreadId::camera, {.name = "camera", .rate_hz = 0, .fifo_priority = 78, .event_timeout = 5ms}},
    {ThreadId::mapping, {.name = "mapping", .rate_hz = kMappingRateHz, .fifo_priority = 70}},
    {ThreadId::render, {.name = "render", .rate_hz = 60, .fifo_priority = 60}},
    {ThreadId::session, {.name = "session", .rate_hz = kSessionRateHz, .fifo_priority = 0}},
}};

/// Depths of the bounded queues; a full queue drops and counts, unless its depth makes that impossible.
inline constexpr std::size_t kPoseQueueDepth = 64;      ///< tracker -> sync: 0.16 s at 400 Hz
inline constexpr std::size_t kPedalQueueDepth = 64;     ///< pedal -> sync
inline constexpr std::size_t kEncoderQueueDepth = 256;  ///< encoder -> sync: two steps of the stage
inline constexpr std::uint32_t kFrameBuffers =
    10;  ///< 4 waiting for a pose, 2 queued, 2 painted, 1 shown, 1 filling
inline constexpr std::size_t kFrameQueueDepth = 2 * kFrameBuffers;  ///< camera -> sync: cannot overflow
inline constexpr std::size_t kPatchSlots = 4;                       ///< mapper -> painter and back
/// mapping -> painter: two orders for each buffer a driver may give, a patch each, and the pedal's; cannot
/// overflow, which would lose a buffer for good.
inline constexpr std::size_t kPaintQueueDepth = 2 * kFrameQueueDepth + kPatchSlots + kPedalQueueDepth;
inline constexpr std::size_t kSessionSlots = 8;  ///< painter -> session

constexpr const StageRow& row_of(StageId id) {
  return kStages[static_cast<std::size_t>(id)];
}
constexpr const ThreadSpec& spec_of(ThreadId id) {
  return kThreads[static_cast<std::size_t>(id)].spec;
}
constexpr Budget budget_of(StageId id, RenderClass c) {
  return c == RenderClass::gpu ? row_of(id).gpu : row_of(id).software;
}

/// How long a thread takes from one turn to the next when each of its turns lasts `busy`: whole periods,
/// since what was missed is skipped and the phase kept. What arrives just after a turn began waits this long.
constexpr Nanos cycle_of(Nanos busy, Nanos period) {
  const std::int64_t periods = (busy.count() + period.count() - 1) / period.count();
  return period * (periods > 1 ? periods : 1);
}

/// End-to-end bounds, computed from the rows, never typed; only what was asked of pedal and disk is typed.
struct PathBudget {
  Budget dequeue_to_submitted{Nanos{0}, Nanos{0}};  ///< match and render, and the wait for each thread's turn
  Budget dequeue_to_scan_out{Nanos{0}, Nanos{0}};   ///< one panel period more
  /// Asked for: 60 and 100 ms. Where the render class's stages alone take longer, their sum.
  Budget pedal_to_acknowledged{60ms, 100ms};
  Budget pedal_to_painted{150ms, 250ms};
  Budget capture_durable{500ms, 2s};
};
constexpr PathBudget path_budget(RenderClass c, double panel_hz) {
  const auto busy = [c](StageId first, StageId second) {
    const Budget one = budget_of(first, c), other = budget_of(second, c);
    return Budget{one.p999 + other.p999, one.bound + other.bound};
  };
  const Nanos panel = period_of(panel_hz), mapping = period_of(kMappingRateHz);
  const Budget match = budget_of(StageId::sync, c), pedal = budget_of(StageId::pedal, c);
  const Budget map = busy(StageId::sync, StageId::mapper), render = busy(StageId::painter, StageId::panel);
  PathBudget path;
  path.dequeue_to_submitted = {
      cycle_of(map.p999, mapping) + match.p999 + cycle_of(render.p999, panel) + render.p999,
      cycle_of(map.bound, mapping) + match.bound + cycle_of(render.bound, panel) + render.bound};
  path.dequeue_to_scan_out = {path.dequeue_to_submitted.p999 + panel,
                              path.dequeue_to_submitted.bound + panel};
  const Budget acknowledged{pedal.p999 + path.dequeue_to_scan_out.p999,
                            pedal.bound + path.dequeue_to_scan_out.bound};
  path.pedal_to_acknowledged = {std::max(path.pedal_to_acknowledged.p999, acknowledged.p999),
                                std::max(path.pedal_to_acknowledged.bound, acknowledged.bound)};
  return path;
}

}  // namespace orcart
