// Where the notch of an angled scope's picture is, in every picture: the turn of its light post.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "realtime/base/image.hpp"
#include "realtime/base/luma.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

/// Looks along the mask's circle, which goes round turning.centre_px with the turn, for the one narrow place
/// where the picture is dark within the circle or bright outside it. One thread; fixed work, nothing is
/// allocated after construction.
class NotchSearch {
 public:
  /// `scope` has turning and notch_rad, and both belong to its turn 0.
  explicit NotchSearch(const ScopeModel& scope);

  /// The turn since the passport was made, -pi..pi. Nothing where no notch stands out: a rim that is too dark
  /// beside it, two places alike, a picture of another size or one whose pixels are not in this process's
  /// memory.
  std::optional<double> turn_in(const ImageDescriptor& image) noexcept;

 private:
  static constexpr int kDirections = 720, kRings = 3;
  static constexpr int kNear = 12, kFar = 24;  ///< neighbourhood, in directions: 6 to 12 degrees to each side
  static constexpr int kFine = 40;             ///< directions of a close look to each side
  struct Spot {
    std::int16_t x = -1, y = -1;  ///< -1: beside the picture
  };
  using Rings = std::array<Spot, kRings>;
  /// Luma all round, as sums from the first direction on: any stretch's mean in two steps.
  struct Profile {
    std::array<double, kDirections + 2 * kFar + 1> sums{};
    void fill(std::span<const float> values) noexcept;
    /// Of directions from..to (within -kFar..kFar) beside `direction`; below 0 where one is not known.
    float mean(int direction, int from, int to) const noexcept {
      const auto at = [&](int i) { return sums[static_cast<std::size_t>(direction + kFar + i)]; };
      return static_cast<float>((at(to + 1) - at(from)) / (to - from + 1));
    }
  };
  struct Peak {
    int direction = -1;
    float part = 0;  ///< how far towards black, or towards the light, 0..1
    bool sticks_out = false;
  };
  struct Luma;  ///< a picture's bytes

  Eigen::Vector2d mask_centre(double turn_rad) const noexcept;
  Rings rings_at(const Eigen::Vector2d& centre, double angle_rad,
                 const std::array<double, kRings>& parts) const noexcept;
  void read_profiles(const Luma& luma) noexcept;
  float part_within(int direction) const noexcept;
  float part_outside(int direction) const noexcept;
  float part(int direction, bool sticks_out) const noexcept {
    return sticks_out ? part_outside(direction) : part_within(direction);
  }
  Peak highest() const noexcept;
  std::optional<double> look_closely(const Luma& luma, double turn_rad, bool sticks_out) const noexcept;

  ScopeModel scope_;
  double notch_rad_ = 0, aspect_ = 1;
  std::array<Rings, kDirections> within_{}, outside_{};  ///< by turn, from -pi on
  Profile inner_{}, outer_{};                            ///< of the newest picture
  float dark_ = 0;                                       ///< luma beside the circle
};

}  // namespace orcart
