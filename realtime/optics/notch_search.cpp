// First all round in half degrees, then closely about the one place that stands out: the middle of what it
// takes from its neighbourhood.
#include "realtime/optics/notch_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orcart {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::array<double, 3> kWithin{0.975, 0.960, 0.945},
    kOutside{1.020, 1.035, 1.050};   ///< of the radius
constexpr float kLeastLight = 12;    ///< of the neighbourhood above the dark, grey levels of 255
constexpr float kLeastPart = 0.6F;   ///< of its neighbourhood's light that the notch takes away or shows
constexpr float kSecondBest = 0.6F;  ///< any other place is below this share of the best
constexpr double kFineStep_rad = kPi / 720;
constexpr int kFineNear = 26;    ///< a close look's own neighbourhood begins here: 6.5 degrees
constexpr float kFloor = 0.25F;  ///< what is less than this part of the notch is noise

}  // namespace

struct NotchSearch::Luma {
  const std::byte* first = nullptr;
  std::size_t stride_bytes = 0, step_bytes = 0;

  /// Mean over the rings; below 0 where one lies beside the picture.
  float mean(const Rings& rings) const noexcept {
    float sum = 0;
    for (const Spot& spot : rings) {
      if (spot.x < 0) return -1;
      sum += static_cast<float>(first[static_cast<std::size_t>(spot.y) * stride_bytes +
                                      static_cast<std::size_t>(spot.x) * step_bytes]);
    }
    return sum / kRings;
  }
};

NotchSearch::NotchSearch(const ScopeModel& scope)
    : scope_(scope), notch_rad_(scope.notch_rad.value_or(0)), aspect_(scope.lens.fy_px / scope.lens.fx_px) {
  for (std::size_t i = 0; i < kDirections; ++i) {
    const double turn = -kPi + 2 * kPi * static_cast<double>(i) / kDirections;
    within_[i] = rings_at(mask_centre(turn), notch_rad_ + turn, kWithin);
    outside_[i] = rings_at(mask_centre(turn), notch_rad_ + turn, kOutside);
  }
}

/// In pixels as they are.
Eigen::Vector2d NotchSearch::mask_centre(double turn_rad) const noexcept {
  const Eigen::Vector2d& round = scope_.turning->centre_px;
  const double x = scope_.mask.cx_px - round.x(), y = (scope_.mask.cy_px - round.y()) / aspect_;
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  return {round.x() + c * x - s * y, round.y() + aspect_ * (s * x + c * y)};
}

/// At these parts of the radius.
NotchSearch::Rings NotchSearch::rings_at(const Eigen::Vector2d& centre, double angle_rad,
                                         const std::array<double, kRings>& parts) const noexcept {
  const double along_x = scope_.mask.radius_px * std::cos(angle_rad),
               along_y = aspect_ * scope_.mask.radius_px * std::sin(angle_rad);
  Rings rings;
  for (std::size_t i = 0; i < kRings; ++i) {
    const double x = centre.x() + parts[i] * along_x, y = centre.y() + parts[i] * along_y;
    if (x >= 0 && y >= 0 && x <= scope_.width_px - 1 && y <= scope_.height_px - 1)
      rings[i] = {.x = static_cast<std::int16_t>(x + 0.5), .y = static_cast<std::int16_t>(y + 0.5)};
  }
  return rings;
}

// A direction that is not known makes the mean of each stretch with it fall below 0.
void NotchSearch::Profile::fill(std::span<const float> values) noexcept {
  constexpr double kUnknown = -1e6;
  for (int i = 0; i < kDirections + 2 * kFar; ++i) {
    const float value = values[static_cast<std::size_t>((i - kFar + kDirections) % kDirections)];
    const auto at = static_cast<std::size_t>(i);
    sums[at + 1] = sums[at] + (value < 0 ? kUnknown : static_cast<double>(value));
  }
}

void NotchSearch::read_profiles(const Luma& luma) noexcept {
  std::array<float, kDirections> inner{}, outer{};
  dark_ = 255;
  for (std::size_t i = 0; i < kDirections; ++i) {
    inner[i] = luma.mean(within_[i]);
    outer[i] = luma.mean(outside_[i]);
    if (outer[i] >= 0) dark_ = std::min(dark_, outer[i]);
  }
  inner_.fill(inner);
  outer_.fill(outer);
}

/// The part of the neighbourhood's light that is missing here; 0 where there is too little light to tell.
float NotchSearch::part_within(int direction) const noexcept {
  const float before = inner_.mean(direction, -kFar, -kNear), after = inner_.mean(direction, kNear, kFar),
              here = inner_.mean(direction, -1, 1);
  if (here < 0 || std::min(before, after) < dark_ + kLeastLight) return 0;
  return std::clamp(1 - (here - dark_) / (0.5F * (before + after) - dark_), 0.0F, 1.0F);
}

/// The part of the light within the circle that is seen outside it here, and not beside.
float NotchSearch::part_outside(int direction) const noexcept {
  const float before = outer_.mean(direction, -kFar, -kNear), after = outer_.mean(direction, kNear, kFar),
              here = outer_.mean(direction, -1, 1), light = inner_.mean(direction, -1, 1);
  if (std::min({here, before, after}) < 0 || light < dark_ + kLeastLight) return 0;
  return std::clamp((here - std::max(before, after)) / (light - dark_), 0.0F, 1.0F);
}

/// The place that stands out, where it is the only one.
NotchSearch::Peak NotchSearch::highest() const noexcept {
  Peak best;
  for (const bool sticks_out : {false, true})
    for (int i = 0; i < kDirections; ++i) {
      const float here = part(i, sticks_out);
      if (here > best.part) best = {.direction = i, .part = here, .sticks_out = sticks_out};
    }
  if (best.part < kLeastPart) return {};
  float second = 0;
  for (int i = 0; i < kDirections; ++i) {
    const int away = std::abs(i - best.direction);
    if (std::min(away, kDirections - away) > kFar) second = std::max(second, part(i, best.sticks_out));
  }
  return second < kSecondBest * best.part ? best : Peak{};
}

/// What the notch takes from the light beside it, or shows of the light within, direction by direction; its
/// middle.
std::optional<double> NotchSearch::look_closely(const Luma& luma, double turn_rad,
                                                bool sticks_out) const noexcept {
  const Eigen::Vector2d centre = mask_centre(turn_rad);
  const auto read = [&](int i, const std::array<double, kRings>& rings) {
    return luma.mean(rings_at(centre, notch_rad_ + turn_rad + i * kFineStep_rad, rings));
  };
  std::array<float, 2 * kFine + 1> values{};
  for (int i = -kFine; i <= kFine; ++i) {
    float& value = values[static_cast<std::size_t>(i + kFine)];
    value = read(i, sticks_out ? kOutside : kWithin);
    if (value < 0) return std::nullopt;
  }
  float before = 0, after = 0;
  for (int i = kFineNear; i <= kFine; ++i) {
    before += values[static_cast<std::size_t>(kFine - i)] / (kFine - kFineNear + 1);
    after += values[static_cast<std::size_t>(kFine + i)] / (kFine - kFineNear + 1);
  }
  std::array<float, 2 * kFine + 1> parts{};
  float most = 0;
  for (int i = -kFineNear + 1; i < kFineNear; ++i) {
    const auto at = static_cast<std::size_t>(i + kFine);
    const float beside = before + (after - before) * (static_cast<float>(i) / (2.0F * kFine) + 0.5F);
    const float light = sticks_out ? read(i, kWithin) : beside;
    parts[at] =
        (sticks_out ? values[at] - beside : beside - values[at]) / std::max(light - dark_, kLeastLight);
    most = std::max(most, parts[at]);
  }
  double sum = 0, weights = 0;
  for (int i = -kFineNear + 1; i < kFineNear; ++i) {
    const float weight = parts[static_cast<std::size_t>(i + kFine)] - kFloor * most;
    if (weight <= 0) continue;
    sum += static_cast<double>(weight) * i;
    weights += static_cast<double>(weight);
  }
  if (!(weights > 0)) return std::nullopt;
  return std::remainder(turn_rad + kFineStep_rad * sum / weights, 2 * kPi);
}

std::optional<double> NotchSearch::turn_in(const ImageDescriptor& image) noexcept {
  const LumaLayout layout = luma_layout(image.format);
  const ImagePlane& plane = image.planes[0];
  if (plane.data == nullptr || layout.step_bytes == 0 || image.width_px != scope_.width_px ||
      image.height_px != scope_.height_px)
    return std::nullopt;
  const Luma luma{.first = plane.data + plane.offset_bytes + layout.first_byte,
                  .stride_bytes = plane.stride_bytes,
                  .step_bytes = layout.step_bytes};
  read_profiles(luma);
  const Peak peak = highest();
  if (peak.direction < 0) return std::nullopt;
  std::optional<double> turn = -kPi + 2 * kPi * peak.direction / kDirections;
  for (int i = 0; turn && i < 2; ++i)
    turn = look_closely(luma, *turn, peak.sticks_out);  // the second centred
  return turn;
}

}  // namespace orcart
