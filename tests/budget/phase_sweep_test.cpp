// Deadlines under the simulated clock, at worst-case stage times and at every phase between camera, tracker,
// panel and pedal: each run is held to arithmetic done beside it, to the nanosecond, and to its budget.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "firmware-host/tracker/ndi/baud.hpp"
#include "firmware-host/tracker/ndi_settings.hpp"
#include "tests/budget/scripted_cart.hpp"

namespace orcart::testing {
namespace {

/// A combination of render class, rates and stage times.
struct Case {
  RenderClass render_class;
  Times times;
  double camera_hz, tracker_hz, panel_hz;
  friend std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << (c.render_class == RenderClass::gpu ? "gpu" : "software")
               << (c.times == Times::bound ? " bounds" : " p99.9") << ", camera " << c.camera_hz
               << ", tracker " << c.tracker_hz << ", panel " << c.panel_hz << " Hz";
  }
};

constexpr Nanos kDeviceLatency = 8ms;
constexpr std::uint32_t kBaud = 115'200;
constexpr Nanos kPress = 120ms;

Nanos wire_time() {
  return ndi::wire_time(poll_reply_bytes(2), kBaud);
}

/// The first instant of the grid 0, step, 2 step, ... that is not before `t`.
Nanos on_grid(Nanos t, Nanos step) {
  return step * ((t.count() + step.count() - 1) / step.count());
}

/// What must come out, by arithmetic alone.
class Oracle {
 public:
  explicit Oracle(const ScriptedSetup& setup) : s_(setup) {
    const auto cost = [&](StageId id) {
      const Budget budget = budget_of(id, s_.render_class);
      return s_.times == Times::p999 ? budget.p999 : budget.bound;
    };
    pedal_ = cost(StageId::pedal), camera_ = cost(StageId::camera), match_ = cost(StageId::sync);
    mapper_ = cost(StageId::mapper), render_ = cost(StageId::painter) + cost(StageId::panel);
    mapping_cycle_ = cycle_of(match_ + mapper_, period_of(kMappingRateHz));
    render_cycle_ = cycle_of(render_, period_of(s_.panel_hz));
  }

  Nanos mid(int k) const { return start_of(k) + s_.exposure / 2; }
  Nanos dequeued(int k) const { return start_of(k) + s_.exposure + s_.readout + camera_; }
  Nanos match_turn(Nanos known) const { return on_grid(known, mapping_cycle_); }
  Nanos render_turn(Nanos known) const { return on_grid(known, render_cycle_); }
  /// The end of the render turn that first may see what the match stage saw at `turn`.
  Nanos submitted_after(Nanos match_turn) const { return render_turn(match_turn + match_) + render_; }
  Nanos scan_out_after(Nanos submitted) const {
    const double period = 1e9 / s_.panel_hz;
    auto k = static_cast<std::int64_t>(
        std::floor(static_cast<double>((submitted - s_.vblank_phase).count()) / period));
    const auto vblank = [&](std::int64_t n) {
      return s_.vblank_phase + Nanos{std::llround(static_cast<double>(n) * period)};
    };
    for (k -= 1; vblank(k) <= submitted;) ++k;
    return vblank(k);
  }

  int meant_frame() const {
    int k = 0;
    while (mid(k) < s_.press_at) ++k;
    return k;
  }
  Nanos pose_known(Nanos mid_exposure) const {
    constexpr Nanos kExact = 200us;
    const auto measured = [&](int n) { return s_.tracker_phase + period_of(s_.tracker_hz) * n; };
    int n = 0;
    while (measured(n) < mid_exposure - kExact) ++n;
    return measured(n) + s_.tracker_delay;
  }
  Nanos matched() const {
    const int k = meant_frame();
    constexpr Nanos kEdgeGrace = 5ms;
    return match_turn(std::max({dequeued(k), pose_known(mid(k)), mid(k) + kEdgeGrace}));
  }
  Nanos painted_on_panel() const {
    return scan_out_after(render_turn(matched() + match_ + mapper_) + render_);
  }
  Nanos acknowledged() const { return scan_out_after(submitted_after(match_turn(s_.press_at + pedal_))); }

 private:
  Nanos start_of(int k) const {
    return s_.camera_phase + Nanos{std::llround(static_cast<double>(k) * 1e9 / s_.camera_hz)};
  }
  const ScriptedSetup& s_;
  Nanos pedal_{}, camera_{}, match_{}, mapper_{}, render_{}, mapping_cycle_{}, render_cycle_{};
};

/// The longest of each path over a sweep.
struct Worst {
  Nanos submitted{}, scan_out{}, acknowledged{}, painted{}, matched{};
};

class PhaseSweep : public ::testing::TestWithParam<Case> {
 protected:
  static ScriptedSetup setup_of(const Case& c) {
    return {.render_class = c.render_class,
            .times = c.times,
            .camera_hz = c.camera_hz,
            .tracker_hz = c.tracker_hz,
            .panel_hz = c.panel_hz,
            .tracker_delay = kDeviceLatency + wire_time() +
                             (c.times == Times::bound ? budget_of(StageId::tracker, c.render_class).bound
                                                      : budget_of(StageId::tracker, c.render_class).p999),
            .press_at = kPress,
            .run_for = 480ms};
  }

  void hold_to_arithmetic(const ScriptedSetup& setup) {
    const Oracle oracle(setup);
    const ScriptedOutcome out = run_scripted(setup);
    ASSERT_EQ(out.drops, 0u);
    ASSERT_EQ(out.mapping_slips, 0u);
    for (const ShownFrame& frame : out.shown) {
      const auto k = static_cast<int>(frame.sequence);
      ASSERT_EQ(frame.dequeued, oracle.dequeued(k)) << k;
      ASSERT_EQ(frame.submitted, oracle.submitted_after(oracle.match_turn(frame.dequeued))) << k;
      ASSERT_EQ(frame.scan_out, oracle.scan_out_after(frame.submitted)) << k;
      worst_.submitted = std::max(worst_.submitted, frame.submitted - frame.dequeued);
      worst_.scan_out = std::max(worst_.scan_out, frame.scan_out - frame.dequeued);
    }
    ASSERT_GE(out.shown.size(), 4u);
    ASSERT_TRUE(out.painted);
    ASSERT_EQ(static_cast<int>(out.painted_sequence), oracle.meant_frame());
    ASSERT_EQ(out.mid_exposure, oracle.mid(oracle.meant_frame()));
    ASSERT_EQ(out.matched, oracle.matched());
    ASSERT_EQ(out.acknowledged, oracle.acknowledged());
    ASSERT_EQ(out.on_panel, oracle.painted_on_panel());
    worst_.matched = std::max(worst_.matched, out.matched - out.mid_exposure);
    worst_.acknowledged = std::max(worst_.acknowledged, out.acknowledged - setup.press_at);
    worst_.painted = std::max(worst_.painted, out.on_panel - setup.press_at);
  }

  Worst worst_;
};

TEST_P(PhaseSweep, EveryPhaseIsAsArithmeticSaysAndWithinBudget) {
  const Case& c = GetParam();
  const Nanos camera = period_of(c.camera_hz), tracker = period_of(c.tracker_hz),
              panel = period_of(c.panel_hz);
  ScriptedSetup setup = setup_of(c);
  // The pedal against all others through the camera's phase: only differences matter to which frame is meant.
  constexpr int kCamera = 41, kPanel = 13, kTracker = 11;
  int runs = 0;
  for (int i = 0; i < kCamera; ++i)
    for (int j = 0; j < kPanel; ++j)
      for (int k = 0; k < kTracker; ++k) {
        setup.camera_phase = camera * i / kCamera;
        setup.vblank_phase = panel * j / kPanel;
        setup.tracker_phase = tracker * k / kTracker;
        setup.press_at = kPress + camera * ((i * 13 + j * 5 + k * 17) % 31) / 31;
        hold_to_arithmetic(setup);
        if (HasFatalFailure()) {
          FAIL() << "at camera " << i << "/" << kCamera << ", panel " << j << "/" << kPanel << ", tracker "
                 << k << "/" << kTracker << ", press at " << setup.press_at.count() << " ns";
        }
        ++runs;
      }
  // An edge at a mid-exposure, and a nanosecond to either side of it.
  for (const int offset : {-1, 0, 1}) {
    setup.camera_phase = 3'100us;
    setup.press_at =
        setup.camera_phase + setup.exposure / 2 + Nanos{std::llround(4 * 1e9 / c.camera_hz)} + Nanos{offset};
    hold_to_arithmetic(setup);
  }
  const PathBudget budget = path_budget(c.render_class, c.panel_hz);
  const bool bound = c.times == Times::bound;
  const auto of = [&](const Budget& b) { return bound ? b.bound : b.p999; };
  EXPECT_LE(worst_.submitted, of(budget.dequeue_to_submitted));
  // No looser than it must be; a frame that waits for more than the next one is not shown, and counts as
  // dropped.
  if (c.render_class == RenderClass::gpu) {
    EXPECT_GE(worst_.submitted, of(budget.dequeue_to_submitted) - 3ms);
  }
  EXPECT_LE(worst_.scan_out, of(budget.dequeue_to_scan_out));
  EXPECT_LE(worst_.acknowledged, of(budget.pedal_to_acknowledged));
  EXPECT_LE(worst_.painted, of(budget.pedal_to_painted));
  EXPECT_LE(worst_.matched, bound ? 60ms : tracker + setup.tracker_delay + period_of(kMappingRateHz));
  std::printf("  %d phases: submitted %.2f, scan-out %.2f, pose %.2f, acknowledged %.2f, painted %.2f ms\n",
              runs, milliseconds(worst_.submitted), milliseconds(worst_.scan_out),
              milliseconds(worst_.matched), milliseconds(worst_.acknowledged), milliseconds(worst_.painted));
}

INSTANTIATE_TEST_SUITE_P(Rates, PhaseSweep,
                         ::testing::Values(Case{RenderClass::gpu, Times::bound, 30, 60, 60},
                                           Case{RenderClass::gpu, Times::p999, 30, 60, 60},
                                           Case{RenderClass::gpu, Times::bound, 60, 60, 75},
                                           Case{RenderClass::gpu, Times::bound, 25, 100, 50},
                                           Case{RenderClass::software, Times::bound, 30, 60, 60},
                                           Case{RenderClass::software, Times::p999, 30, 60, 60},
                                           Case{RenderClass::software, Times::bound, 30, 60, 30},
                                           Case{RenderClass::software, Times::bound, 25, 60, 20}));

}  // namespace
}  // namespace orcart::testing
