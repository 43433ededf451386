// The histogram of times against sorted data, and the rule on how many samples a percentile wants.
#include "realtime/kernel/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

/// Lengths spread evenly over the decades from 1 us to 10 s.
std::vector<Nanos> lengths(std::size_t count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> decade(3.0, 10.0);
  std::vector<Nanos> drawn(count);
  for (Nanos& length : drawn) length = Nanos{static_cast<std::int64_t>(std::pow(10.0, decade(random)))};
  return drawn;
}

TEST(Histogram, PercentilesAreWithinOnePercentAboveTheSortedData) {
  std::vector<Nanos> data = lengths(100'000);
  Histogram histogram;
  for (const Nanos length : data) histogram.record(length);
  std::ranges::sort(data);
  const HistogramSnapshot seen = histogram.snapshot();
  for (const double quantile : {0.001, 0.01, 0.25, 0.5, 0.9, 0.99, 0.999}) {
    const auto rank = static_cast<std::size_t>(std::ceil(quantile * 100'000.0 - 1e-6));
    const double truth = seconds(data[rank - 1]);
    ASSERT_TRUE(seen.percentile(quantile).has_value());
    EXPECT_GE(seconds(*seen.percentile(quantile)), truth) << quantile;
    EXPECT_LE(seconds(*seen.percentile(quantile)), truth * 1.01) << quantile;
  }
}

TEST(Histogram, CountMaximumAndMeanAreExact) {
  const std::vector<Nanos> data = lengths(1'000);
  Histogram histogram;
  for (const Nanos length : data) histogram.record(length);
  const HistogramSnapshot seen = histogram.snapshot();
  EXPECT_EQ(seen.count(), 1'000u);
  EXPECT_EQ(seen.max(), *std::ranges::max_element(data));
  EXPECT_EQ(seen.mean(), std::accumulate(data.begin(), data.end(), Nanos{0}) / 1'000);
}

TEST(Histogram, BucketsFollowEachOtherWithoutGapAndAreNarrow) {
  for (std::size_t i = 1; i < histogram_buckets::kCount; ++i) {
    const Nanos lower = histogram_buckets::upper_edge(i - 1) + Nanos{1};
    const Nanos upper = histogram_buckets::upper_edge(i);
    ASSERT_EQ(histogram_buckets::index_of(lower), i);
    ASSERT_EQ(histogram_buckets::index_of(upper), i);
    ASSERT_LE((upper - lower).count() * 100, lower.count());
  }
}

TEST(Histogram, PutsWhatIsTooLongIntoTheLastBucketAndKeepsItsMaximum) {
  Histogram histogram;
  histogram.record(1h);
  EXPECT_EQ(histogram.snapshot().bucket(histogram_buckets::kCount - 1), 1u);
  EXPECT_EQ(histogram.snapshot().max(), Nanos{1h});
}

TEST(Histogram, CountsANegativeLengthAsZero) {
  Histogram histogram;
  histogram.record(Nanos{-5});
  EXPECT_EQ(histogram.snapshot().bucket(0), 1u);
  EXPECT_EQ(histogram.snapshot().mean(), Nanos{0});
}

TEST(Histogram, StatesNoPercentileThatTooFewSamplesSupport) {
  Histogram histogram;
  for (int i = 0; i < 9'999; ++i) histogram.record(1ms);
  EXPECT_FALSE(histogram.snapshot().percentile(0.99).has_value());
  histogram.record(1ms);
  EXPECT_TRUE(histogram.snapshot().percentile(0.99).has_value());
  EXPECT_FALSE(histogram.snapshot().percentile(0.999).has_value());
}

TEST(Histogram, StatesTheMedianOfWhatItSawHoweverLittle) {
  Histogram histogram;
  EXPECT_FALSE(histogram.snapshot().median().has_value());
  histogram.record(100ns);
  histogram.record(200ns);
  histogram.record(250ns);
  EXPECT_EQ(histogram.snapshot().median(), Nanos{200});
}

TEST(Supports, WantsAHundredSamplesBeyondTheQuantile) {
  EXPECT_FALSE(supports(0.5, 199));
  EXPECT_TRUE(supports(0.5, 200));
  EXPECT_FALSE(supports(0.9, 999));
  EXPECT_TRUE(supports(0.9, 1'000));
  EXPECT_FALSE(supports(0.99, 9'999));
  EXPECT_TRUE(supports(0.99, 10'000));
  EXPECT_FALSE(supports(0.999, 99'999));
  EXPECT_TRUE(supports(0.999, 100'000));
  EXPECT_FALSE(supports(1.0, 1'000'000'000));
}

TEST(Supports, NamesTheHighestQuantileOfSoManySamples) {
  EXPECT_FALSE(highest_supported_quantile(199).has_value());
  EXPECT_EQ(highest_supported_quantile(200), 0.5);
  EXPECT_EQ(highest_supported_quantile(99'999), 0.99);
  EXPECT_EQ(highest_supported_quantile(100'000), 0.999);
}

TEST(Histogram, IsFilledAndReadWithoutAllocating) {
  Histogram histogram;
  HistogramSnapshot seen;
  EXPECT_TRUE(testing::zero_allocation([&] {
    histogram.record(1ms);
    histogram.read(seen);
  }));
  EXPECT_EQ(seen.count(), 1u);
}

TEST(Histogram, IsReadByAnotherThreadWhileItIsFilled) {
  constexpr std::uint64_t kSamples = 20'000;
  Histogram histogram;
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < kSamples; ++i) histogram.record(Nanos{static_cast<std::int64_t>(i)});
  });
  HistogramSnapshot seen;
  std::uint64_t before = 0;
  bool shrank = false;
  while (seen.count() < kSamples) {
    histogram.read(seen);
    shrank = shrank || seen.count() < before;
    before = seen.count();
    std::this_thread::yield();
  }
  writer.join();
  EXPECT_FALSE(shrank);
}

}  // namespace
}  // namespace orcart
