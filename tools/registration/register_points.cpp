// Pairs the points, looks for one that does not belong, fits, and says what the set's shape means for the
// target.
#include "tools/registration/register_points.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "realtime/registration/body_covariance.hpp"
#include "realtime/registration/rigid_fit.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/point_matching.hpp"

namespace orcart {
namespace {

struct Pairs {
  std::vector<std::string> fixed_names, moving_names;
  std::vector<Eigen::Vector3d> fixed_mm, moving_mm;

  void add(const NamedPoint& fixed, const NamedPoint& moving) {
    fixed_names.push_back(fixed.name), moving_names.push_back(moving.name);
    fixed_mm.push_back(fixed.mm), moving_mm.push_back(moving.mm);
  }
  Pairs without(std::size_t left_out) const {
    Pairs others = *this;
    const auto at = static_cast<std::ptrdiff_t>(left_out);
    others.fixed_names.erase(others.fixed_names.begin() + at),
        others.moving_names.erase(others.moving_names.begin() + at);
    others.fixed_mm.erase(others.fixed_mm.begin() + at),
        others.moving_mm.erase(others.moving_mm.begin() + at);
    return others;
  }
  Result<RigidFit> fit() const { return rigid_fit({.from_mm = moving_mm, .to_mm = fixed_mm}); }
};

const NamedPoint* find(const std::vector<NamedPoint>& points, const std::string& name) {
  const auto found =
      std::find_if(points.begin(), points.end(), [&name](const NamedPoint& p) { return p.name == name; });
  return found == points.end() ? nullptr : &*found;
}

bool all_named(const std::vector<NamedPoint>& points, const std::vector<NamedPoint>& among) {
  return std::all_of(points.begin(), points.end(),
                     [&](const NamedPoint& p) { return find(among, p.name) != nullptr; });
}

/// The names of `points` that the file gave, and not one of `among` has; numbers are no names.
std::vector<std::string> without_namesake(const std::vector<NamedPoint>& points,
                                          const std::vector<NamedPoint>& among) {
  std::vector<std::string> names;
  for (const NamedPoint& p : points) {
    const NamedPoint* other = find(among, p.name);
    if (p.numbered || other == nullptr || other->numbered) names.push_back(p.name);
  }
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "\"" : ", \"") + name + "\"";
  return list;
}

/// One misspelt name must not throw all others together in another order.
Result<Pairing> pairing_told_by(const RegistrationTask& task, std::vector<std::string>& notes) {
  const auto fixed = without_namesake(task.fixed, task.moving),
             moving = without_namesake(task.moving, task.fixed);
  if (fixed.empty() || moving.empty()) return Pairing::by_name;
  if (fixed.size() < task.fixed.size())
    return fail("some names are alike on both sides and others are not: fiducials " + listed(fixed) +
                ", measured " + listed(moving) + "; names alike, or --order given, are accepted");
  const auto named = [](const NamedPoint& p) { return !p.numbered; };
  if (std::any_of(task.fixed.begin(), task.fixed.end(), named) &&
      std::any_of(task.moving.begin(), task.moving.end(), named))
    notes.emplace_back("no name is alike on both sides: the points are paired in the order given");
  return Pairing::by_order;
}

/// A fiducial that was not touched is left out where every touched one has its namesake.
Result<Pairs> by_name(const RegistrationTask& task, std::vector<std::string>& notes) {
  Pairs pairs;
  const bool some_untouched = all_named(task.moving, task.fixed);
  for (const NamedPoint& fixed : task.fixed) {
    const NamedPoint* moving = find(task.moving, fixed.name);
    if (moving == nullptr && some_untouched) {
      notes.push_back("the fiducial \"" + fixed.name + "\" was not measured and is left out");
      continue;
    }
    if (moving == nullptr)
      return fail("the fiducial \"" + fixed.name +
                  "\" was not measured; a point of that name, or --order, is accepted");
    pairs.add(fixed, *moving);
  }
  for (const NamedPoint& moving : task.moving)
    if (find(task.fixed, moving.name) == nullptr)
      notes.push_back("the measured point \"" + moving.name + "\" is no fiducial's and is left out");
  return pairs;
}

Result<Pairs> by_order(const RegistrationTask& task) {
  if (task.fixed.size() != task.moving.size())
    return fail("there are " + std::to_string(task.fixed.size()) + " fiducials and " +
                std::to_string(task.moving.size()) +
                " measured points; as many of both are accepted, or --order unknown");
  Pairs pairs;
  for (std::size_t i = 0; i < task.fixed.size(); ++i) pairs.add(task.fixed[i], task.moving[i]);
  return pairs;
}

std::vector<Eigen::Vector3d> places(const std::vector<NamedPoint>& points) {
  std::vector<Eigen::Vector3d> result;
  result.reserve(points.size());
  for (const NamedPoint& p : points) result.push_back(p.mm);
  return result;
}

Result<Pairs> by_distances(const RegistrationTask& task) {
  const auto matched = match_points(places(task.fixed), places(task.moving), std::max(3.0, 6 * task.fle_mm));
  if (!matched) return tl::unexpected(matched.error());
  Pairs pairs;
  for (std::size_t i = 0; i < task.fixed.size(); ++i) pairs.add(task.fixed[i], task.moving[(*matched)[i]]);
  return pairs;
}

Result<Pairs> pair_up(const RegistrationTask& task, std::vector<std::string>& notes) {
  const auto pairing = task.pairing ? Result<Pairing>(*task.pairing) : pairing_told_by(task, notes);
  if (!pairing) return tl::unexpected(pairing.error());
  switch (*pairing) {
    case Pairing::by_name:
      return by_name(task, notes);
    case Pairing::by_order:
      return by_order(task);
    case Pairing::unknown:
      break;
  }
  return by_distances(task);
}

double spread_mm(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double sum = 0;
  for (const auto& p : points) middle += p / static_cast<double>(points.size());
  for (const auto& p : points) sum += (p - middle).squaredNorm();
  return std::sqrt(sum);
}

/// No touch of a fiducial is off by so much that one set is twice the other; another unit makes it so.
Result<void> check_scale(const Pairs& pairs) {
  const double fixed = spread_mm(pairs.fixed_mm), moving = spread_mm(pairs.moving_mm);
  if (pairs.fixed_mm.size() < 3 || !(moving > 0) || (moving > fixed / 2 && moving < fixed * 2)) return {};
  return fail(
      json::format("the measured points lie %.3g times as far apart as the fiducials; both in millimetres, "
                   "and each beside its partner, are accepted",
                   moving / fixed));
}

/// One point of five or more whose absence makes all others agree.
void take_outlier(Pairs& pairs, Registration& result) {
  const auto whole = pairs.fit();
  if (!whole || whole->fre_mm < 2 * result.fle_mm) return;
  if (pairs.fixed_mm.size() < 5) {
    result.notes.push_back(json::format(
        "FRE %.2f mm is large against the declared error of %.2f mm; with %zu points it cannot be told "
        "which is wrong: five or more can",
        whole->fre_mm, result.fle_mm, pairs.fixed_mm.size()));
    return;
  }
  double best = whole->fre_mm, second = whole->fre_mm;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < pairs.fixed_mm.size(); ++i) {
    const auto fit = pairs.without(i).fit();
    if (!fit) continue;
    if (fit->fre_mm < best) {
      second = best, best = fit->fre_mm, worst = i;
    } else {
      second = std::min(second, fit->fre_mm);
    }
  }
  if (best > 0.4 * whole->fre_mm || second < 1.8 * best) {
    result.notes.push_back(json::format(
        "FRE %.2f mm is large against the declared error of %.2f mm, and no one point explains it; the "
        "expected error is the declared one's",
        whole->fre_mm, result.fle_mm));
    return;
  }
  const auto fit = pairs.without(worst).fit();
  result.outlier = pairs.fixed_names[worst];
  result.outlier_mm =
      (fit->rotation * pairs.moving_mm[worst] + fit->translation_mm - pairs.fixed_mm[worst]).norm();
  result.notes.push_back(
      json::format("\"%s\" lies %.1f mm off and was left out: FRE %.2f mm with it, %.2f mm without",
                   result.outlier.c_str(), result.outlier_mm, whole->fre_mm, best));
  pairs = pairs.without(worst);
}

/// Far beyond what touching makes: points that are not each other's partners, or an error declared too small.
Result<void> check_fre(double fre_mm, const RegistrationTask& task) {
  constexpr double kMost = 10;
  if (fre_mm <= kMost * task.fle_mm) return {};
  return fail(json::format(
      "FRE %.1f mm is over ten times the declared error of %.2f mm: are two names or places exchanged? "
      "--order unknown finds the partners; where touching is so coarse, a larger --fle is accepted",
      fre_mm, task.fle_mm));
}

void measure_shape(const Pairs& pairs, Registration& result) {
  const auto count = static_cast<double>(pairs.fixed_mm.size());
  for (const auto& p : pairs.fixed_mm) result.centroid_mm += p / count;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& p : pairs.fixed_mm)
    covariance += (p - result.centroid_mm) * (p - result.centroid_mm).transpose() / count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  result.axes = solver.eigenvectors();
  const Eigen::Vector3d& along = solver.eigenvalues();
  for (Eigen::Index k = 0; k < 3; ++k) result.spread2_mm2[k] = along.sum() - along[k];
}

/// Empty where the points lie neither on one line nor in one plane.
std::string shape_of(const Registration& r) {
  const Eigen::Vector3d along = 0.5 * r.spread2_mm2.sum() * Eigen::Vector3d::Ones() - r.spread2_mm2;
  const double length = std::sqrt(along[2]), width = std::sqrt(std::max(0.0, along[1])),
               depth = std::sqrt(std::max(0.0, along[0]));
  const double among = predicted_tre_mm(r, r.centroid_mm);
  if (width < 0.15 * length)
    return json::format(
        "the points lie nearly on one line (%.0f mm long, %.1f mm wide): 50 mm beside it the expected error "
        "is %.1f mm, on it %.1f mm; add one beside the line",
        length, width, predicted_tre_mm(r, r.centroid_mm + 50 * r.axes.col(1)), among);
  if (depth < 0.1 * width)
    return json::format(
        "the points lie nearly in one plane (%.1f mm deep): 50 mm above it the expected error is %.1f mm, in "
        "it %.1f mm, and only the guard against reflections tells its two sides apart",
        depth, predicted_tre_mm(r, r.centroid_mm + 50 * r.axes.col(0)), among);
  return {};
}

}  // namespace

Result<Registration> register_points(const RegistrationTask& task) {
  Registration result;
  auto pairs = pair_up(task, result.notes);
  if (!pairs) return tl::unexpected(pairs.error());
  if (auto alike = check_scale(*pairs); !alike) return tl::unexpected(alike.error());
  result.fle_mm = task.fle_mm;
  take_outlier(*pairs, result);
  const auto fit = pairs->fit();
  if (!fit) return tl::unexpected(fit.error());
  if (auto near = check_fre(fit->fre_mm, task); !near) return tl::unexpected(near.error());
  result.X_MR = {.rotation = fit->rotation, .translation_mm = fit->translation_mm};
  result.fre_mm = fit->fre_mm;
  for (std::size_t i = 0; i < pairs->fixed_mm.size(); ++i)
    result.points.push_back(
        {.fixed = pairs->fixed_names[i],
         .moving = pairs->moving_names[i],
         .fixed_mm = pairs->fixed_mm[i],
         .moving_mm = pairs->moving_mm[i],
         .error_mm =
             (fit->rotation * pairs->moving_mm[i] + fit->translation_mm - pairs->fixed_mm[i]).norm()});
  measure_shape(*pairs, result);
  tell_shape(result);
  return result;
}

void tell_shape(Registration& registration) {
  if (!registration.shape.empty()) std::erase(registration.notes, registration.shape);
  registration.shape = shape_of(registration);
  if (!registration.shape.empty()) registration.notes.push_back(registration.shape);
}

TwistCovariance twist_covariance(const Registration& registration) {
  if (!registration.pose_covariance) {
    std::vector<Eigen::Vector3d> points_R_mm;
    points_R_mm.reserve(registration.points.size());
    for (const RegisteredPoint& point : registration.points) points_R_mm.push_back(point.moving_mm);
    return body_covariance(points_R_mm, registration.fle_mm / std::numbers::sqrt3);
  }
  // From turn and shift about the centroid to a twist in M, then to R.
  TwistCovariance twist = TwistCovariance::Zero();
  twist.topLeftCorner<3, 3>() = cross_matrix(registration.centroid_mm);
  twist.topRightCorner<3, 3>().setIdentity();
  twist.bottomLeftCorner<3, 3>().setIdentity();
  return covariance_seen_from(registration.X_MR, twist * *registration.pose_covariance * twist.transpose());
}

double predicted_tre_mm(const Registration& registration, const Eigen::Vector3d& target_mm) {
  if (registration.pose_covariance) {
    const Eigen::Vector3d arm = target_mm - registration.centroid_mm;
    Eigen::Matrix<double, 3, 6> motion;
    motion << 0, arm.z(), -arm.y(), 1, 0, 0, -arm.z(), 0, arm.x(), 0, 1, 0, arm.y(), -arm.x(), 0, 0, 0, 1;
    return std::sqrt((motion * *registration.pose_covariance * motion.transpose()).trace());
  }
  const Eigen::Vector3d from = registration.axes.transpose() * (target_mm - registration.centroid_mm);
  double sum = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double distance2 = from.squaredNorm() - from[k] * from[k];
    sum += distance2 / std::max(1e-9, registration.spread2_mm2[k]) / 3;
  }
  return registration.fle_mm * std::sqrt((1 + sum) / static_cast<double>(registration.points.size()));
}

}  // namespace orcart
