// Finds the two complete samples next to an instant and says what they allow to be said.
#include "realtime/sync/pose_history.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orcart {
namespace {

double fraction_of(Instant t, const PoseSample& from, const PoseSample& to) {
  return seconds(t - from.measured_at) / seconds(to.measured_at - from.measured_at);
}

/// The shorter way round.
double turn_between(const PoseSample& from, const PoseSample& to, double fraction) {
  const double start = from.turn_rad.value_or(0);
  return start + fraction * std::remainder(to.turn_rad.value_or(0) - start, 2 * std::numbers::pi);
}

}  // namespace

PoseHistory::PoseHistory(const PoseHistorySettings& settings)
    : settings_(settings), ring_(std::max<std::size_t>(2, settings.capacity)) {}

bool PoseHistory::push(const PoseSample& sample) noexcept {
  const bool falls = size_ > 0 && sample.measured_at <= newest();
  if (falls || sample.measured_at > sample.arrived_at) {
    ++refused_;
    return false;
  }
  ring_[next_] = sample;
  next_ = (next_ + 1) % ring_.size();
  size_ = std::min(size_ + 1, ring_.size());
  return true;
}

PoseHistory::Neighbours PoseHistory::neighbours(Instant t) const noexcept {
  Neighbours found;
  for (std::size_t age = 0; age < size_; ++age) {
    const PoseSample& sample = back(age);
    if (!complete(sample)) continue;
    if (sample.measured_at <= t) {
      found.before = &sample;
      break;
    }
    found.after = &sample;
  }
  return found;
}

PoseAnswer PoseHistory::at(Instant t) const noexcept {
  const auto [before, after] = neighbours(t);
  const Nanos since = before != nullptr ? t - before->measured_at : Nanos::max();
  const Nanos until = after != nullptr ? after->measured_at - t : Nanos::max();
  const PoseSample* nearest = since <= until ? before : after;
  const Nanos distance = std::min(since, until);
  if (nearest == nullptr) return {};
  if (distance <= settings_.exact_within)
    return {.kind = PoseKind::exact,
            .X_RS = nearest->X_RS(),
            .distance = distance,
            .turn_rad = nearest->turn_rad.value_or(0)};
  if (before == nullptr) return {};
  if (after == nullptr) return predict(*before, t);
  if (after->measured_at - before->measured_at > longest_gap()) return {};
  const double fraction = fraction_of(t, *before, *after);
  return {.kind = PoseKind::interpolated,
          .X_RS = interpolate(before->X_RS(), after->X_RS(), fraction),
          .distance = distance,
          .turn_rad = turn_between(*before, *after, fraction)};
}

PoseAnswer PoseHistory::predict(const PoseSample& last, Instant t) const noexcept {
  const Nanos distance = t - last.measured_at;
  if (&last != &back(0) || distance > settings_.longest_prediction) return {};
  PoseAnswer answer{.kind = PoseKind::predicted,
                    .X_RS = last.X_RS(),
                    .distance = distance,
                    .turn_rad = last.turn_rad.value_or(0)};
  const PoseSample* earlier = neighbours(last.measured_at - Nanos{1}).before;
  if (earlier != nullptr && last.measured_at - earlier->measured_at <= longest_gap()) {
    answer.X_RS = interpolate(earlier->X_RS(), answer.X_RS, fraction_of(t, *earlier, last));
    answer.turn_rad = turn_between(*earlier, last, fraction_of(t, *earlier, last));
  }
  return answer;
}

std::optional<Twist> PoseHistory::velocity(Instant t, Nanos over) const noexcept {
  const auto [before, after] = neighbours(t);
  const PoseSample *last = after != nullptr ? after : before, *first = last;
  if (last == nullptr) return std::nullopt;
  for (std::size_t age = 0; age < size_ && back(age).measured_at >= last->measured_at - over; ++age)
    if (complete(back(age)) && back(age).measured_at < first->measured_at) first = &back(age);
  const double span_s = seconds(last->measured_at - first->measured_at);
  if (span_s < seconds(over) / 2) return std::nullopt;
  return twist_between(first->X_RS(), last->X_RS()) / span_s;
}

bool PoseHistory::decided(Instant t) const noexcept {
  if (at(t).may_paint()) return true;
  if (newest() <= t + settings_.exact_within) return false;
  const PoseSample* before = neighbours(t).before;
  return before == nullptr || newest() - before->measured_at >= longest_gap();
}

bool PoseHistory::lacks_turn_around(Instant t) const noexcept {
  const auto lacks = [&](const PoseSample* sample) {
    return settings_.needs_turn && sample != nullptr && sample->complete() && !sample->turn_rad;
  };
  const PoseSample *before = nullptr, *after = nullptr;
  for (std::size_t age = 0; age < size_ && before == nullptr; ++age)
    (back(age).measured_at <= t ? before : after) = &back(age);
  return lacks(before) || lacks(after);
}

bool PoseHistory::sampled_around(Instant t) const noexcept {
  const Nanos reach = settings_.period + settings_.period / 10;
  Nanos since = Nanos::max(), until = Nanos::max();
  for (std::size_t age = 0; age < size_ && since == Nanos::max(); ++age) {
    const Instant measured_at = back(age).measured_at;
    (measured_at <= t ? since : until) = measured_at <= t ? t - measured_at : measured_at - t;
  }
  return since <= reach && until <= reach;
}

}  // namespace orcart
