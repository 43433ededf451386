// A search with backtracking: a partner is taken only where its distances to all earlier partners agree.
#include "tools/registration/point_matching.hpp"

#include <cmath>

#include "realtime/registration/rigid_fit.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

class Search {
 public:
  Search(const std::vector<Eigen::Vector3d>& fixed, const std::vector<Eigen::Vector3d>& moving,
         double tolerance)
      : fixed_(fixed), moving_(moving), tolerance_(tolerance), used_(moving.size()) {}

  void run() { extend(); }
  double best_mm = 1e9, second_mm = 1e9;
  std::vector<std::size_t> best;

 private:
  static constexpr int kMostSteps = 2'000'000;

  void extend() {
    if (++steps_ > kMostSteps) return;
    if (chosen_.size() == fixed_.size()) {
      judge();
      return;
    }
    const std::size_t next = chosen_.size();
    for (std::size_t candidate = 0; candidate < moving_.size(); ++candidate) {
      if (used_[candidate] || !agrees(next, candidate)) continue;
      used_[candidate] = true;
      chosen_.push_back(candidate);
      extend();
      chosen_.pop_back();
      used_[candidate] = false;
    }
  }

  bool agrees(std::size_t next, std::size_t candidate) const {
    for (std::size_t i = 0; i < next; ++i)
      if (std::abs((fixed_[next] - fixed_[i]).norm() - (moving_[candidate] - moving_[chosen_[i]]).norm()) >
          tolerance_)
        return false;
    return true;
  }

  void judge() {
    std::vector<Eigen::Vector3d> partners;
    for (const std::size_t i : chosen_) partners.push_back(moving_[i]);
    const auto fit = rigid_fit({.from_mm = partners, .to_mm = fixed_});
    if (!fit) return;
    if (fit->fre_mm < best_mm) {
      second_mm = best_mm;
      best_mm = fit->fre_mm;
      best = chosen_;
    } else {
      second_mm = std::min(second_mm, fit->fre_mm);
    }
  }

  const std::vector<Eigen::Vector3d>& fixed_;
  const std::vector<Eigen::Vector3d>& moving_;
  double tolerance_;
  std::vector<bool> used_;
  std::vector<std::size_t> chosen_;
  int steps_ = 0;
};

}  // namespace

Result<std::vector<std::size_t>> match_points(const std::vector<Eigen::Vector3d>& fixed_mm,
                                              const std::vector<Eigen::Vector3d>& moving_mm,
                                              double tolerance_mm) {
  if (moving_mm.size() < fixed_mm.size())
    return fail(std::to_string(moving_mm.size()) + " points were measured for " +
                std::to_string(fixed_mm.size()) + " fiducials; each needs one");
  Search search(fixed_mm, moving_mm, tolerance_mm);
  search.run();
  if (search.best.empty())
    return fail(json::format("no order of the points brings their distances within %.1f mm of the fiducials'",
                             tolerance_mm));
  if (search.second_mm < 1.5 * search.best_mm + 0.05)
    return fail(
        json::format("two orders of the points fit equally well (FRE %.2f and %.2f mm); name the points "
                     "alike on both sides",
                     search.best_mm, search.second_mm));
  return search.best;
}

}  // namespace orcart
