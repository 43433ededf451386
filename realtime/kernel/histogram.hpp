// How long things took: a histogram of fixed memory that one thread fills without locks and any thread may
// read.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "realtime/base/instant.hpp"

namespace orcart {

/// The quantiles that reports speak of, the most demanding first.
inline constexpr std::array kReportedQuantiles{0.999, 0.99, 0.9, 0.5};

/// Whether `samples` are enough to state a quantile: 100 must lie beyond it, n >= 100 / (1 - q). So p99 wants
/// 10,000 and p99.9 wants 100,000; the maximum (q = 1) is never a quantile.
bool supports(double quantile, std::uint64_t samples) noexcept;

/// The most demanding of kReportedQuantiles that `samples` support; nothing below 200 samples.
std::optional<double> highest_supported_quantile(std::uint64_t samples) noexcept;

/// Log-linear buckets over nanoseconds (as HdrHistogram, Tene 2012): exact below 256 ns, then 128 buckets an
/// octave, so that a bucket is at most 1/128 (0.78 %) of its values wide, up to 17 s. Longer values share the
/// last bucket.
namespace histogram_buckets {
constexpr int kBitsPerOctave = 7;
constexpr int kTopBit = 33;
constexpr std::size_t kCount = static_cast<std::size_t>(kTopBit - kBitsPerOctave + 2) << kBitsPerOctave;
std::size_t index_of(Nanos length) noexcept;
/// The longest value that falls into the bucket.
Nanos upper_edge(std::size_t index) noexcept;
}  // namespace histogram_buckets

/// What a histogram held when it was read: plain numbers, 28 KiB.
class HistogramSnapshot {
 public:
  std::uint64_t count() const noexcept { return count_; }
  Nanos max() const noexcept { return max_; }  ///< exact
  Nanos mean() const noexcept;                 ///< exact; zero where there is no sample
  /// The q-quantile by nearest rank, at most 0.8 % above the sample it stands for, never above max(). Nothing
  /// where supports(quantile, count()) is false.
  std::optional<Nanos> percentile(double quantile) const noexcept;
  /// The middle of what was seen, however little; nothing only where there is no sample.
  std::optional<Nanos> median() const noexcept;
  /// Samples in bucket `index` of histogram_buckets, for plots.
  std::uint64_t bucket(std::size_t index) const noexcept { return buckets_[index]; }

 private:
  friend class Histogram;
  Nanos at_rank(double quantile) const noexcept;

  std::array<std::uint64_t, histogram_buckets::kCount> buckets_{};
  std::uint64_t count_ = 0;
  Nanos max_{0};
  std::int64_t total_ns_ = 0;
};

/// One writer thread calls record; any thread reads. A reader beside a running writer may miss the newest
/// samples, and its maximum and mean may be one sample ahead of or behind the buckets.
class Histogram {
 public:
  /// Writer. A negative length counts as zero.
  void record(Nanos length) noexcept;

  /// Any thread; allocates nothing.
  void read(HistogramSnapshot& into) const noexcept;
  HistogramSnapshot snapshot() const noexcept;
  std::uint64_t count() const noexcept { return count_.load(std::memory_order_relaxed); }  // a count alone

 private:
  // All relaxed, without partners: every number stands alone, and nothing else is published through them.
  std::array<std::atomic<std::uint64_t>, histogram_buckets::kCount> buckets_{};
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::int64_t> max_ns_{0};
  std::atomic<std::int64_t> total_ns_{0};
};

}  // namespace orcart
