// Recordings first; the views' own disagreement otherwise.
#include "tools/evaluate/recorded/tracking_error.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace orcart {
namespace {

/// Of chi-square over its degrees of freedom, `z` standard deviations from its middle.
double chi_square_share(double freedom, double z) {
  const double part = 2 / (9 * freedom);
  return std::pow(1 - part + z * std::sqrt(part), 3);
}

Result<TrackingError> measured(const std::vector<std::filesystem::path>& recordings) {
  std::vector<ToolTrack> all;
  for (const auto& file : recordings) {
    const auto tracks = tool_tracks(file);
    if (!tracks) return tl::unexpected(tracks.error());
    all.insert(all.end(), tracks->begin(), tracks->end());
  }
  TrackingError error{.from = TrackingFrom::rests, .error = {}, .still = still_tools(all)};
  if (error.still.stretches.empty())
    return fail(recordings.front().string() +
                (recordings.size() > 1 ? " and the other recordings hold" : " holds") +
                " no tool that stands still for 20 readings within 1 mm; a recording of a tool laid down is "
                "accepted");
  error.error = error.still.error;
  return error;
}

}  // namespace

std::optional<Statistics> implied_tracking(const HandEyeCalibration& calibration) {
  if (!calibration.spread) return std::nullopt;
  double place2 = 0;
  const auto views = static_cast<double>(calibration.views.size());
  for (const HandEyeView& view : calibration.views)
    place2 +=
        pose_covariance(calibration.task.noise, view.X_TS.translation_mm).bottomRightCorner<3, 3>().trace() /
        views;
  const double rms_mm = std::sqrt(calibration.spread->misfit * place2),
               mean_part = std::sqrt(8 / (3 * std::numbers::pi)), freedom = calibration.spread->freedom;
  constexpr double kChiSquare95 = 7.814727903;  // of three degrees
  const double mean_mm = mean_part * rms_mm;
  return Statistics{.count = calibration.views.size(),
                    .mean = mean_mm,
                    .sd = std::sqrt(1 - mean_part * mean_part) * rms_mm,
                    .p95 = std::sqrt(kChiSquare95 / 3) * rms_mm,
                    .max = std::numeric_limits<double>::quiet_NaN(),
                    .mean_low = mean_mm / std::sqrt(chi_square_share(freedom, 1.96)),
                    .mean_high = mean_mm / std::sqrt(chi_square_share(freedom, -1.96))};
}

Result<TrackingError> tracking_error(const std::vector<std::filesystem::path>& recordings,
                                     const HandEyeCalibration& calibration) {
  if (!recordings.empty()) return measured(recordings);
  const auto implied = implied_tracking(calibration);
  if (!implied) return TrackingError{};
  return TrackingError{.from = TrackingFrom::implied,
                       .error = *implied,
                       .still = {},
                       .marker_mm = calibration.task.noise.marker_mm * std::sqrt(calibration.spread->misfit)};
}

}  // namespace orcart
