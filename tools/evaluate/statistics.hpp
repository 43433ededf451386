// Mean, spread and extremes of a list of errors, with how far the mean may be trusted.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tools/registration/students_t.hpp"

namespace orcart {

struct Statistics {
  std::size_t count = 0;
  double mean = 0, sd = 0, p95 = 0, max = 0;
  double mean_low = 0, mean_high = 0;  ///< 95 % confidence of the mean
};

/// Of values that come in groups (the landmarks of one set-up share its errors): the confidence of the mean
/// is taken from the means of the groups, by Student's t for as many.
inline Statistics statistics_of(std::vector<double> values, const std::vector<double>& group_means) {
  Statistics s{.count = values.size()};
  if (values.empty()) return s;
  for (const double v : values) s.mean += v / static_cast<double>(values.size());
  for (const double v : values) s.sd += (v - s.mean) * (v - s.mean);
  s.sd = values.size() > 1 ? std::sqrt(s.sd / static_cast<double>(values.size() - 1)) : 0;
  std::sort(values.begin(), values.end());
  s.p95 = values[std::min(values.size() - 1, values.size() * 95 / 100)];
  s.max = values.back();
  double centre = 0, spread = 0;
  const auto groups = static_cast<double>(group_means.size());
  for (const double g : group_means) centre += g / groups;
  for (const double g : group_means) spread += (g - centre) * (g - centre);
  const double half =
      groups > 1 ? students_t(group_means.size() - 1) * std::sqrt(spread / (groups - 1) / groups) : 0;
  s.mean_low = s.mean - half;
  s.mean_high = s.mean + half;
  return s;
}

/// Values kept by the set-up they belong to.
class GroupedValues {
 public:
  void add(const std::vector<double>& group) {
    if (group.empty()) return;
    double mean = 0;
    for (const double v : group) mean += v / static_cast<double>(group.size());
    means_.push_back(mean);
    values_.insert(values_.end(), group.begin(), group.end());
  }
  Statistics statistics() const { return statistics_of(values_, means_); }
  const std::vector<double>& values() const { return values_; }

 private:
  std::vector<double> values_, means_;
};

}  // namespace orcart
