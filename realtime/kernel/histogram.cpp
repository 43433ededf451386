// Bucket arithmetic, recording and the percentiles of a histogram of times.
#include "realtime/kernel/histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "realtime/kernel/one_writer.hpp"

namespace orcart {

bool supports(double quantile, std::uint64_t samples) noexcept {
  // The slack is for quantiles that are not representable: 1 - 0.9 is a little under 0.1.
  return static_cast<double>(samples) * (1.0 - quantile) >= 100.0 * (1.0 - 1e-9);
}

std::optional<double> highest_supported_quantile(std::uint64_t samples) noexcept {
  for (const double quantile : kReportedQuantiles) {
    if (supports(quantile, samples)) return quantile;
  }
  return std::nullopt;
}

std::size_t histogram_buckets::index_of(Nanos length) noexcept {
  constexpr std::int64_t kLongest = (std::int64_t{1} << (kTopBit + 1)) - 1;
  const auto ns = static_cast<std::uint64_t>(std::clamp<std::int64_t>(length.count(), 0, kLongest));
  const int top_bit = std::bit_width(ns) - 1;
  const int shift = std::max(0, top_bit - kBitsPerOctave);
  // Within octave `shift` the shifted value runs from 128 to 255, so octaves follow each other without a gap.
  return (static_cast<std::size_t>(shift) << kBitsPerOctave) + static_cast<std::size_t>(ns >> shift);
}

Nanos histogram_buckets::upper_edge(std::size_t index) noexcept {
  constexpr std::size_t kPerOctave = std::size_t{1} << kBitsPerOctave;
  if (index < 2 * kPerOctave) return Nanos{static_cast<std::int64_t>(index)};
  const std::size_t shift = (index >> kBitsPerOctave) - 1;
  const std::size_t leading = index - (shift << kBitsPerOctave);
  return Nanos{static_cast<std::int64_t>(((leading + 1) << shift) - 1)};
}

void Histogram::record(Nanos length) noexcept {
  const std::int64_t ns = std::max<std::int64_t>(0, length.count());
  add_alone(buckets_[histogram_buckets::index_of(length)], 1);
  add_alone(count_, 1);
  add_alone(total_ns_, ns);
  if (ns > max_ns_.load(std::memory_order_relaxed)) max_ns_.store(ns, std::memory_order_relaxed);
}

void Histogram::read(HistogramSnapshot& into) const noexcept {
  into.count_ = 0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    into.buckets_[i] = buckets_[i].load(std::memory_order_relaxed);
    into.count_ += into.buckets_[i];
  }
  into.max_ = Nanos{max_ns_.load(std::memory_order_relaxed)};
  into.total_ns_ = total_ns_.load(std::memory_order_relaxed);
}

HistogramSnapshot Histogram::snapshot() const noexcept {
  HistogramSnapshot taken;
  read(taken);
  return taken;
}

Nanos HistogramSnapshot::mean() const noexcept {
  return count_ == 0 ? Nanos{0} : Nanos{total_ns_ / static_cast<std::int64_t>(count_)};
}

std::optional<Nanos> HistogramSnapshot::percentile(double quantile) const noexcept {
  if (!supports(quantile, count_)) return std::nullopt;
  return at_rank(quantile);
}

std::optional<Nanos> HistogramSnapshot::median() const noexcept {
  if (count_ == 0) return std::nullopt;
  return at_rank(0.5);
}

Nanos HistogramSnapshot::at_rank(double quantile) const noexcept {
  // The slack keeps 0.99 * 10,000 at rank 9,900 where its product comes out a hair above.
  const double exact_rank = quantile * static_cast<double>(count_);
  const auto rank = static_cast<std::uint64_t>(std::max(1.0, std::ceil(exact_rank * (1.0 - 1e-12))));
  std::uint64_t passed = 0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    passed += buckets_[i];
    if (passed >= rank) return std::min(histogram_buckets::upper_edge(i), max_);
  }
  return max_;
}

}  // namespace orcart
