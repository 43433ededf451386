// The pedal's gestures at their limits, to the microsecond, whatever the rate at which time is told.
#include "firmware-host/pedal/pedal_gestures.hpp"

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

using Kind = PedalEventKind;

constexpr Instant at_ms(double ms) {
  return instant_from_nanos(1'000'000'000) + from_seconds(ms * 1e-3);
}

std::string word(const PedalEvent& event) {
  constexpr const char* kWords[] = {"capture", "cancel", "undo", "begin", "end", "stuck", "lost"};
  std::string text = kWords[static_cast<int>(event.kind)];
  text += std::to_string(event.unit) + "@";
  const double ms = milliseconds(event.at - at_ms(0));
  const auto whole = static_cast<long long>(ms);
  return text + std::to_string(whole);
}

/// A line whose level changes at the given instants, pressed first; edges are numbered as a kernel does.
class Foot {
 public:
  explicit Foot(Nanos tick = 1ms) : tick_(tick) {}

  Foot& press(double ms) { return edge(ms, EdgeKind::pressed, ++sequence_); }
  Foot& release(double ms) { return edge(ms, EdgeKind::released, ++sequence_); }
  Foot& edge(double ms, EdgeKind kind, std::uint32_t sequence) {
    run_to(at_ms(ms) - 1ns);
    gestures_.edge({.at = at_ms(ms), .kind = kind, .sequence = sequence});
    collect();
    sequence_ = sequence;
    return *this;
  }
  /// Everything that has happened until `ms`, as words.
  std::string until(double ms) {
    run_to(at_ms(ms));
    gestures_.advance(at_ms(ms));
    collect();
    return log_;
  }
  const PedalGestures& gestures() const { return gestures_; }

 private:
  void run_to(Instant t) {
    for (; now_ <= t; now_ += tick_) {
      gestures_.advance(now_);
      collect();
    }
  }
  void collect() {
    while (const auto event = gestures_.next()) log_ += (log_.empty() ? "" : " ") + word(*event);
  }

  Nanos tick_;
  PedalGestures gestures_;
  Instant now_ = at_ms(0);
  std::uint32_t sequence_ = 0;
  std::string log_;
};

TEST(PedalGestures, CapturesOnTheLeadingEdgeAtOnce) {
  PedalGestures gestures;
  gestures.edge({.at = at_ms(10), .kind = EdgeKind::pressed, .sequence = 1});
  const auto event = gestures.next();
  ASSERT_TRUE(event);
  EXPECT_EQ(event->kind, Kind::capture);
  EXPECT_EQ(event->at, at_ms(10));
  EXPECT_EQ(event->unit, 1U);
  EXPECT_FALSE(gestures.next());
}

TEST(PedalGestures, TakesBouncesOfAPressForOnePress) {
  EXPECT_EQ(Foot().press(10).release(11).press(12).release(13.5).press(14).release(120).until(400),
            "capture1@10");
}

TEST(PedalGestures, TakesBouncesOfAReleaseForNoPress) {
  EXPECT_EQ(Foot().press(10).release(200).press(202).release(204).press(210).release(211).until(900),
            "capture1@10");
}

TEST(PedalGestures, LocksOutASecondPressForFortyMilliseconds) {
  // The line has been quiet for 20 ms in both; only the lock-out tells them apart.
  EXPECT_EQ(Foot().press(10).release(15).press(49.999).until(60), "capture1@10");
  EXPECT_EQ(Foot().press(10).release(15).press(50).until(60), "capture1@10 cancel1@50 undo1@50");
}

TEST(PedalGestures, CountsAReleaseOnceTheLineIsQuietForTwentyMilliseconds) {
  EXPECT_EQ(Foot().press(10).release(100).press(119.999).until(130), "capture1@10");
  EXPECT_EQ(Foot().press(10).release(100).press(120).until(130), "capture1@10 cancel1@120 undo1@120");
}

TEST(PedalGestures, TakesASecondPressWithin350MillisecondsForARegret) {
  EXPECT_EQ(Foot().press(10).release(100).press(359.999).until(400), "capture1@10 cancel1@359 undo1@359");
  EXPECT_EQ(Foot().press(10).release(100).press(360.001).until(400), "capture1@10 capture2@360");
}

TEST(PedalGestures, TakesTheThirdPressForANewCapture) {
  EXPECT_EQ(Foot().press(10).release(60).press(160).release(210).press(310).until(400),
            "capture1@10 cancel1@160 undo1@160 capture2@310");
}

TEST(PedalGestures, StreamsAsTheSameUnitWhenHeldForHalfASecond) {
  EXPECT_EQ(Foot().press(10).release(509.999).until(900), "capture1@10");
  EXPECT_EQ(Foot().press(10).release(510.001).until(900), "capture1@10 begin1@10 end1@510");
  EXPECT_EQ(Foot().press(10).release(2000).until(2100), "capture1@10 begin1@10 end1@2000");
}

TEST(PedalGestures, KeepsAStreamThroughAShortBounce) {
  EXPECT_EQ(Foot().press(10).release(1000).press(1019.9).release(2000).until(2100),
            "capture1@10 begin1@10 end1@2000");
}

TEST(PedalGestures, DoesNotStreamFromTheSecondPressOfAPair) {
  EXPECT_EQ(Foot().press(10).release(60).press(160).release(1500).until(1600),
            "capture1@10 cancel1@160 undo1@160");
}

TEST(PedalGestures, WarnsOfAStuckPedalAndIgnoresItUntilItIsReleased) {
  EXPECT_EQ(Foot().press(10).release(5009.999).until(5100), "capture1@10 begin1@10 end1@5009");
  Foot foot;
  foot.press(10);
  EXPECT_EQ(foot.until(9000), "capture1@10 begin1@10 end1@5010 stuck1@5010");
  EXPECT_EQ(foot.release(9100).press(9200).until(9300),
            "capture1@10 begin1@10 end1@5010 stuck1@5010 capture2@9200");
}

TEST(PedalGestures, WarnsAtOnceWhereTheSequenceHasAGap) {
  Foot foot;
  foot.press(10).release(100);
  EXPECT_EQ(foot.edge(1000, EdgeKind::pressed, 5).until(1000), "capture1@10 lost1@1000");
  EXPECT_EQ(foot.until(3000), "capture1@10 lost1@1000");  // ignored until released
  EXPECT_EQ(foot.release(3100).press(3200).until(3300), "capture1@10 lost1@1000 capture2@3200");
}

TEST(PedalGestures, WarnsAtOnceOfTwoEdgesOfOnePolarity) {
  Foot foot;
  foot.press(10);
  EXPECT_EQ(foot.press(700).until(700), "capture1@10 begin1@10 end1@700 lost1@700");
  EXPECT_EQ(foot.release(900).press(1000).until(1100),
            "capture1@10 begin1@10 end1@700 lost1@700 capture2@1000");
}

TEST(PedalGestures, TakesAReleaseThatComesFirstForAPedalHeldAtStart) {
  EXPECT_EQ(Foot().release(10).press(400).until(450), "capture1@400");
}

TEST(PedalGestures, SaysWhenTimeAloneWillBringSomethingAbout) {
  PedalGestures gestures;
  EXPECT_EQ(gestures.due(), Instant::max());
  gestures.edge({.at = at_ms(10), .kind = EdgeKind::pressed, .sequence = 1});
  EXPECT_EQ(gestures.due(), at_ms(510));
  gestures.advance(at_ms(510));
  EXPECT_EQ(gestures.due(), at_ms(5010));
  gestures.edge({.at = at_ms(600), .kind = EdgeKind::released, .sequence = 2});
  EXPECT_EQ(gestures.due(), at_ms(620));
  gestures.advance(at_ms(620));
  EXPECT_EQ(gestures.due(), Instant::max());
}

TEST(PedalGestures, SaysTheSameWhateverTheRateAtWhichTimeIsTold) {
  std::mt19937 random(3);
  for (int round = 0; round < 300; ++round) {
    std::vector<double> changes_ms;
    double ms = 5;
    for (int i = 0; i < 20; ++i)
      changes_ms.push_back(ms += std::exponential_distribution<double>(1.0 / 200)(random));
    const auto log_with = [&](Nanos tick) {
      Foot foot(tick);
      for (std::size_t i = 0; i < changes_ms.size(); ++i) {
        if (i % 2 == 0)
          foot.press(changes_ms[i]);
        else
          foot.release(changes_ms[i]);
      }
      return foot.until(ms + 6000);
    };
    ASSERT_EQ(log_with(1ms), log_with(1s)) << round;
  }
}

TEST(PedalGestures, AllocatesNothing) {
  PedalGestures gestures;
  EXPECT_TRUE(testing::zero_allocation([&] {
    for (std::uint32_t i = 0; i < 100; ++i) {
      gestures.edge(
          {.at = at_ms(300 * i), .kind = i % 2 == 0 ? EdgeKind::pressed : EdgeKind::released, .sequence = i});
      gestures.advance(at_ms(300 * i + 200));
      while (gestures.next()) {
      }
    }
  }));
}

}  // namespace
}  // namespace orcart
