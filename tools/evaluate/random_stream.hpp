// Random numbers that depend on a seed alone, so that a set-up is the same on any machine and any thread.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <Eigen/Core>

namespace orcart {

/// splitmix64 (Steele, Lea, Flood 2014); the normal distribution after Box and Muller 1958.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream) : state_(seed * 0xD1342543DE82EF95u + stream) {
    next();
    state_ ^= stream * 0x9E3779B97F4A7C15u;
  }

  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15u;
    std::uint64_t z = state_;
    z = (z ^ z >> 30U) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27U) * 0x94D049BB133111EBu;
    return z ^ z >> 31U;
  }
  /// 0 < u < 1
  double uniform() { return (static_cast<double>(next() >> 11U) + 0.5) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  double gaussian() {
    const double u = uniform(), v = uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
  }
  Eigen::Vector3d gaussian3() {
    const double x = gaussian(), y = gaussian(), z = gaussian();
    return {x, y, z};
  }
  Eigen::Vector3d direction() { return gaussian3().normalized(); }

 private:
  std::uint64_t state_;
};

}  // namespace orcart
