// One misfit curve a movement; their weighted sum has the answer, their resampling its interval.
#include "tools/calibration/time_lag.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "tools/calibration/movement_misfit.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/students_t.hpp"

namespace orcart {
namespace {

constexpr double kApart_s = 0.060;    ///< lags this far from the best are another answer
constexpr double kAlike = 1.3;        ///< and must fit worse by this factor
constexpr double kLargestWeight = 4;  ///< of one movement over the median's
constexpr std::size_t kFewestSamples = 12;

/// The least of a sampled curve, between its samples by the parabola through three.
struct Least {
  double at = 0;
  std::size_t index = 0;
};
Least least_of(const std::vector<double>& curve, const std::vector<double>& at) {
  const auto i = static_cast<std::size_t>(std::min_element(curve.begin(), curve.end()) - curve.begin());
  if (i == 0 || i + 1 == curve.size()) return {.at = at[i], .index = i};
  const double before = curve[i - 1], here = curve[i], after = curve[i + 1];
  const double bend = before - 2 * here + after;
  const double part = bend > 0 ? 0.5 * (before - after) / bend : 0;
  return {.at = at[i] + part * (at[i + 1] - at[i]), .index = i};
}

std::vector<double> sum_of(const std::vector<MisfitCurve>& curves, const std::vector<double>& weights) {
  std::vector<double> sum(curves.front().squares.size(), 0.0);
  for (std::size_t m = 0; m < curves.size(); ++m)
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weights[m] * curves[m].squares[i];
  return sum;
}

/// Each movement weighs by its own variance at the common best, within limits.
std::vector<double> weights_at(const std::vector<MisfitCurve>& curves, std::size_t index) {
  std::vector<double> weights;
  weights.reserve(curves.size());
  for (const MisfitCurve& c : curves)
    weights.push_back(c.freedom / std::max(c.squares[index], 1e-12 * std::max(c.motion, 1e-12)));
  std::vector<double> sorted = weights;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double most = kLargestWeight * *middle;
  for (double& w : weights) w = std::min(w, most);
  return weights;
}

std::vector<double> best_weights(const std::vector<MisfitCurve>& curves, const std::vector<double>& lags_s) {
  std::vector<double> weights(curves.size(), 1.0);
  for (int i = 0; i < 4; ++i) weights = weights_at(curves, least_of(sum_of(curves, weights), lags_s).index);
  return weights;
}

double bootstrap_deviation_s(const std::vector<MisfitCurve>& curves, const std::vector<double>& weights,
                             const std::vector<double>& lags_s, const LagSettings& settings) {
  std::mt19937 random(settings.seed);
  std::uniform_int_distribution<std::size_t> any(0, curves.size() - 1);
  double sum = 0, squares = 0;
  std::vector<double> drawn(curves.size());
  for (int d = 0; d < settings.draws; ++d) {
    std::fill(drawn.begin(), drawn.end(), 0.0);
    for (std::size_t m = 0; m < curves.size(); ++m) {
      const std::size_t taken = any(random);
      drawn[taken] += weights[taken];
    }
    const double lag = least_of(sum_of(curves, drawn), lags_s).at;
    sum += lag, squares += lag * lag;
  }
  const double mean = sum / settings.draws;
  return std::sqrt(std::max(0.0, squares / settings.draws - mean * mean));
}

Result<void> check(const LagFit& fit, const std::vector<double>& total, std::size_t best,
                   const LagSettings& settings) {
  if (fit.explained < settings.least_explained)
    return fail(json::format(
        "the marker's motion explains %.0f %% of the picture's at best, %.0f %% are wanted: the two are not "
        "of "
        "one movement, or what the scope looked at moved too; point it at something at rest and record again",
        100 * std::max(0.0, fit.explained), 100 * settings.least_explained));
  if (best == 0 || best + 1 == total.size())
    return fail(json::format(
        "the best lag lies at the end of the search, %.0f ms; a wider --search-ms is accepted, up to 500",
        1e3 * fit.lags_s[best]));
  for (std::size_t i = 0; i < total.size(); ++i)
    if (std::abs(fit.lags_s[i] - fit.lag_s) > kApart_s && total[i] < kAlike * total[best])
      return fail(json::format(
          "%.0f ms fits nearly as well as %.0f ms: the movements repeat too evenly, or are too slow; move at "
          "uneven intervals, swiftly, with rests between",
          1e3 * fit.lags_s[i], 1e3 * fit.lag_s));
  if (!(fit.half_width_s <= settings.widest_s))
    return fail(json::format(
        "the lag is known to +-%.1f ms only (%.1f ms, %zu movements); +-%.1f ms is accepted: record more and "
        "swifter movements, with rests between",
        1e3 * fit.half_width_s, 1e3 * fit.lag_s, fit.movements.size(), 1e3 * settings.widest_s));
  return {};
}

}  // namespace

Result<LagFit> fit_lag(const PoseTrack& track, const ImageMotion& motion, const LagSettings& settings) {
  LagFit fit;
  const auto steps = static_cast<int>(std::lround(settings.search_s / settings.step_s));
  for (int i = -steps; i <= steps; ++i) fit.lags_s.push_back(settings.step_s * i);
  const std::vector<Stretch_s> moved = find_movements(track);
  std::vector<MisfitCurve> curves;
  for (std::size_t m = 0; m < moved.size(); ++m) {
    const double from =
        m == 0 ? moved[m].from_s - settings.search_s
               : std::max(moved[m].from_s - settings.search_s, 0.5 * (moved[m].from_s + moved[m - 1].to_s));
    const double to = m + 1 == moved.size() ? moved[m].to_s + settings.search_s
                                            : std::min(moved[m].to_s + settings.search_s,
                                                       0.5 * (moved[m].to_s + moved[m + 1].from_s));
    auto curve = misfit_curve(track, motion, {from, to}, {fit.lags_s, settings.X_SC});
    if (curve.samples < kFewestSamples) continue;
    const Least own = least_of(curve.squares, fit.lags_s);
    fit.movements.push_back({.from_s = moved[m].from_s,
                             .to_s = moved[m].to_s,
                             .samples = curve.samples,
                             .lag_s = own.at,
                             .misfit = std::sqrt(curve.squares[own.index] / curve.freedom)});
    curves.push_back(std::move(curve));
  }
  if (curves.size() < settings.fewest_movements)
    return fail(json::format(
        "%zu movements of the marker were found, %zu of them seen by the camera throughout; %zu or more are "
        "accepted, each of half a second or more, with rests between",
        moved.size(), curves.size(), settings.fewest_movements));

  const std::vector<double> weights = best_weights(curves, fit.lags_s);
  const std::vector<double> total = sum_of(curves, weights);
  const Least best = least_of(total, fit.lags_s);
  double all = 0, freedom = 0, left = 0;
  for (const MisfitCurve& c : curves) all += c.motion, freedom += c.freedom, left += c.squares[best.index];
  for (std::size_t i = 0; i < total.size(); ++i) {
    double squares = 0;
    for (const MisfitCurve& c : curves) squares += c.squares[i];
    fit.misfits.push_back(std::sqrt(squares / freedom));
  }
  fit.lag_s = best.at;
  fit.explained = 1 - left / std::max(all, 1e-12);
  const auto count = static_cast<double>(curves.size());
  fit.half_width_s = students_t(curves.size() - 1) * std::sqrt(count / (count - 1)) *
                     bootstrap_deviation_s(curves, weights, fit.lags_s, settings);
  if (auto checked = check(fit, total, best.index, settings); !checked)
    return tl::unexpected(checked.error());
  return fit;
}

}  // namespace orcart
