// Hundreds of random procedures through matcher and selector: no frame is lost, no press means a frame before
// its edge, and the order in which things arrive changes nothing.
#include <algorithm>
#include <map>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "realtime/sync/capture_selector.hpp"
#include "tests/realtime/sync/sync_samples.hpp"

namespace orcart {
namespace {

using testing::at_ms;
using testing::frame_at;
using testing::sample_at;
using testing::unseen_at;

/// Something that reaches the mapping thread at an instant.
struct Arrival {
  Instant at;
  std::optional<PoseSample> sample;
  std::optional<CapturedFrame> frame;
  std::optional<CaptureRequest> press;
};

struct Procedure {
  std::vector<Arrival> arrivals;
  std::vector<CapturedFrame> frames;
  std::vector<CaptureRequest> presses;
};

/// A second and a half: a fast tracker that loses the tool at times, a camera at 30 Hz that loses frames,
/// presses 400 ms or more apart. `hurry` decides how late each thing arrives, within its bound.
Procedure procedure(std::uint32_t seed, std::uint32_t hurry) {
  std::mt19937 random(seed), lateness(hurry);
  const auto chance = [&](double p) { return std::bernoulli_distribution(p)(random); };
  const auto late_ms = [&](double most) { return std::uniform_real_distribution<double>(0, most)(lateness); };
  Procedure made;
  double arrived = 0;
  for (int i = 0; i < 375; ++i) {
    const Instant t = at_ms(4.0 * i);
    arrived = std::max(arrived, 4.0 * i + 0.5 + late_ms(1));
    PoseSample sample = chance(0.1) ? unseen_at(t) : sample_at(t);
    if (!chance(0.05)) made.arrivals.push_back({.at = at_ms(arrived), .sample = sample});
  }
  for (std::uint32_t i = 0; i < 45; ++i) {
    CapturedFrame frame = frame_at(at_ms(7 + 100.0 / 3 * i), i);
    frame.exposure_start =
        frame.mid_exposure() - 500us;  // short, and known soon: nothing but the grace lets edges in
    frame.exposure_end = frame.exposure_start + 1ms;
    frame.dequeued_at = frame.exposure_end + from_seconds(late_ms(1) * 1e-3);
    if (chance(0.05)) continue;
    made.frames.push_back(frame);
    made.arrivals.push_back({.at = frame.dequeued_at, .frame = frame});
  }
  double edge_ms = 20;
  for (std::uint32_t unit = 1; edge_ms < 1200; ++unit) {
    edge_ms += std::uniform_real_distribution<double>(0, 100)(random);
    made.presses.push_back({.unit = unit, .edge_at = at_ms(edge_ms)});
    made.arrivals.push_back({.at = at_ms(edge_ms + late_ms(5)), .press = made.presses.back()});
    edge_ms += 400;
  }
  std::ranges::stable_sort(made.arrivals, {}, &Arrival::at);
  return made;
}

struct Outcome {
  std::map<std::uint32_t, int> left;                     ///< frame sequence -> how often it left
  std::map<std::uint32_t, std::uint32_t> frame_of_unit;  ///< unit -> frame sequence
  std::map<std::uint32_t, Refusal> refusal_of_frame;
  std::vector<std::uint32_t> failed;
  std::uint32_t late_edges = 0;
};

Outcome run(const Procedure& procedure) {
  FrameMatcher matcher;
  CaptureSelector selector;
  PoseHistory poses({.period = 4ms});
  Outcome outcome;
  const auto leave = [&](const MatchedFrame& matched) {
    ++outcome.left[matched.frame.sequence];
    outcome.refusal_of_frame[matched.frame.sequence] = matched.refusal;
    if (const auto claimed = selector.claim(matched))
      outcome.frame_of_unit[claimed->unit] = matched.frame.sequence;
  };
  std::size_t arrived = 0;
  for (Instant now = at_ms(0); now < at_ms(1800); now += 1ms) {
    for (; arrived < procedure.arrivals.size() && procedure.arrivals[arrived].at <= now; ++arrived) {
      const Arrival& arrival = procedure.arrivals[arrived];
      if (arrival.sample) (void)poses.push(*arrival.sample);
      if (arrival.press && !selector.request(*arrival.press)) outcome.failed.push_back(arrival.press->unit);
      if (arrival.frame)
        if (const auto refused = matcher.add(*arrival.frame)) leave(*refused);
    }
    while (const auto matched = matcher.next(now, poses, selector.edge_grace() + 1ms)) leave(*matched);
    while (const auto failed = selector.next_failed(now)) outcome.failed.push_back(failed->unit);
  }
  outcome.late_edges = selector.late_edges();
  return outcome;
}

/// By the definition, from the outcome's refusals alone.
std::optional<std::uint32_t> meant_by(const CaptureRequest& press, const Procedure& procedure,
                                      const Outcome& outcome) {
  for (const CapturedFrame& frame : procedure.frames)
    if (frame.mid_exposure() >= press.edge_at && outcome.refusal_of_frame.at(frame.sequence) == Refusal::none)
      return frame.sequence;
  return std::nullopt;
}

TEST(SyncProperties, EveryFrameThatEntersLeavesExactlyOnce) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    const Procedure made = procedure(seed, seed);
    const Outcome outcome = run(made);
    ASSERT_EQ(outcome.left.size(), made.frames.size()) << seed;
    for (const auto& [sequence, times] : outcome.left) ASSERT_EQ(times, 1) << seed << ", frame " << sequence;
  }
}

TEST(SyncProperties, APressMeansTheFirstGoodFrameNotBeforeItsEdgeOrFails) {
  std::size_t painted = 0, failed = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    const Procedure made = procedure(seed, seed);
    const Outcome outcome = run(made);
    ASSERT_EQ(outcome.late_edges, 0U);
    for (const CaptureRequest& press : made.presses) {
      const bool gave_up = std::ranges::count(outcome.failed, press.unit) == 1;
      ASSERT_NE(gave_up, outcome.frame_of_unit.contains(press.unit)) << seed << ", unit " << press.unit;
      ++(gave_up ? failed : painted);
      if (gave_up) continue;
      ASSERT_EQ(outcome.frame_of_unit.at(press.unit), meant_by(press, made, outcome)) << seed;
    }
  }
  EXPECT_GT(painted, 500U);
  EXPECT_LT(failed, painted / 10);
}

TEST(SyncProperties, TheOrderOfArrivalChangesNothing) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    const Outcome first = run(procedure(seed, 1)), second = run(procedure(seed, 2));
    ASSERT_EQ(first.frame_of_unit, second.frame_of_unit) << seed;
    ASSERT_EQ(first.refusal_of_frame, second.refusal_of_frame) << seed;
  }
}

}  // namespace
}  // namespace orcart
