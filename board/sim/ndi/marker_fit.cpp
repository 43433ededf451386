// Noise on markers and the rigid fit.
#include "board/sim/ndi/marker_fit.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace orcart {
namespace {

using Points = std::span<const Eigen::Vector3d>;

constexpr int kFitSteps = 4;
constexpr double kRankTolerance = 1e-9;

/// Numbers that depend on the seed alone (splitmix64; Steele, Lea, Flood 2014).
class NoiseStream {
 public:
  explicit NoiseStream(std::uint64_t seed) noexcept : state_(seed) {}

  std::uint64_t next() noexcept {
    state_ += 0x9E3779B97F4A7C15u;
    std::uint64_t z = state_;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return z ^ z >> 31;
  }
  /// Standard normal (Box and Muller 1958).
  double gaussian() noexcept {
    const double u = (static_cast<double>(next() >> 11) + 0.5) * 0x1p-53;
    const double v = static_cast<double>(next() >> 11) * 0x1p-53;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
  }

 private:
  std::uint64_t state_;
};

Eigen::Vector3d centre_of(Points points) noexcept {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// The shortest x with |A x - b| least, A symmetric and positive semi-definite.
Eigen::Vector3d least_norm_solution(const Eigen::Matrix3d& A, const Eigen::Vector3d& b) noexcept {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(A);
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double value = eigen.eigenvalues()[i];
    const Eigen::Vector3d axis = eigen.eigenvectors().col(i);
    if (value > kRankTolerance * eigen.eigenvalues()[2]) x += axis * (axis.dot(b) / value);
  }
  return x;
}

Eigen::Quaterniond turned_by(const Eigen::Vector3d& rotation_vector) noexcept {
  const double angle = rotation_vector.norm();
  if (angle < 1e-15) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

}  // namespace

MarkerFit fit_markers(Points model, Points seen) noexcept {
  const Eigen::Vector3d model_centre = centre_of(model);
  const Eigen::Vector3d seen_centre = centre_of(seen);
  MarkerFit fit;
  for (int step = 0; step < kFitSteps; ++step) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < model.size(); ++i) {
      const Eigen::Vector3d u = fit.rotation * (model[i] - model_centre);
      A += u.squaredNorm() * Eigen::Matrix3d::Identity() - u * u.transpose();
      b += u.cross(seen[i] - seen_centre);
    }
    fit.rotation = (turned_by(least_norm_solution(A, b)) * fit.rotation).normalized();
  }
  fit.translation_mm = seen_centre - fit.rotation * model_centre;
  double squares = 0;
  for (std::size_t i = 0; i < model.size(); ++i) {
    squares += (fit.rotation * model[i] + fit.translation_mm - seen[i]).squaredNorm();
  }
  fit.error_mm = std::sqrt(squares / static_cast<double>(model.size()));
  return fit;
}

MarkerFit measure_tool(Points markers_mm, const TrueToolPose& truth, const MarkerNoise& noise, int tool,
                       std::uint32_t frame) noexcept {
  MarkerFit fit;
  if (noise.sigma_mm > 0) {
    // The noise is the same in every direction, so it may be drawn in the tool's own frame.
    NoiseStream draw(noise.seed * 0x9E3779B97F4A7C15u ^ static_cast<std::uint64_t>(tool) << 32 ^ frame);
    std::array<Eigen::Vector3d, kMaxToolMarkers> seen;
    for (std::size_t i = 0; i < markers_mm.size(); ++i) {
      const Eigen::Vector3d offset(draw.gaussian(), draw.gaussian(), draw.gaussian());
      seen[i] = markers_mm[i] + noise.sigma_mm * offset;
    }
    fit = fit_markers(markers_mm, Points{seen.data(), markers_mm.size()});
  }
  fit.translation_mm = truth.rotation * fit.translation_mm + truth.translation_mm;
  fit.rotation = (truth.rotation * fit.rotation).normalized();
  return fit;
}

}  // namespace orcart
