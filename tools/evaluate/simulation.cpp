// Every set-up on its own; threads take them from a counter, sums are made afterwards in order.
#include "tools/evaluate/simulation.hpp"

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "tools/evaluate/propagation.hpp"

namespace orcart {

namespace {

/// What one set-up gave.
struct SetupOutcome {
  bool found = false;  ///< a view with room
  std::vector<double> tracking, tip, tip_3d, mapping, predicted;
  std::array<std::vector<double>, kComponents> alone;
  Coverage coverage, coverage_all;
  std::size_t lost = 0, jumped = 0;
};

class Setup {
 public:
  Setup(const EvaluationScene& scene, const SimulationRequest& request, int number)
      : scene_(scene), request_(request), random_(request.seed, static_cast<std::uint64_t>(number)) {}

  SetupOutcome run() {
    const auto view = view_of_chance(scene_, random_);
    if (!view) return {};
    outcome_.found = true;
    capture_.X_MC = *view;
    capture_.velocity << request_.model.speed_mm_s * random_.direction(),
        request_.model.turn_rad_s * random_.direction();
    fiducials_ = fiducials_of_chance(scene_, request_.model.fiducials, random_);
    errors_random_ = random_.next();
    measure_tracking();
    measure_tip();
    measure_mapping();
    return std::move(outcome_);
  }

 private:
  /// The same numbers for every set of components.
  DrawnErrors errors(const ComponentSet& set) const {
    RandomStream random(errors_random_, 1);
    return drawn_errors(scene_, request_.model, set, fiducials_, random);
  }

  void measure_tracking() {
    std::vector<Eigen::Vector3d> places;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (int i = 0; i < request_.trials; ++i) {
      places.push_back(drawn_body(scene_.scope_markers_mm, request_.model.marker_rms_mm, random_).head<3>());
      mean += places.back() / request_.trials;
    }
    for (const Eigen::Vector3d& place : places) outcome_.tracking.push_back((place - mean).norm());
  }

  /// How far the window is believed beside its place in C; from a stream of its own, so that what else is
  /// drawn does not depend on whether the passport states it.
  Eigen::Vector3d drawn_window() const {
    if (!request_.model.window_root) return Eigen::Vector3d::Zero();
    RandomStream random(errors_random_, 2);
    return *request_.model.window_root * random.gaussian3();
  }

  /// Of E in R; the errors of hand-eye and window stay, the tracker's are new in every trial.
  Eigen::Vector3d measured_tip(const Capture& capture, const DrawnErrors& fixed) {
    DrawnErrors now = fixed;
    now.registration = Twist::Zero();
    now.time_s = 0;
    now.scope = drawn_body(scene_.scope_markers_mm, request_.model.marker_rms_mm, random_);
    now.reference = drawn_body(scene_.reference_markers_mm, request_.model.marker_rms_mm, random_);
    Pose<C, E> X_CE = scene_.scope.X_CE;
    X_CE.translation_mm += drawn_window();
    const Pose<M, E> X_ME = believed_pose(scene_, capture, now) * X_CE;
    return X_ME.translation_mm;
  }

  Eigen::Vector3d true_tip(const Capture& capture) const {
    return (capture.X_MC * scene_.scope.X_CE).translation_mm;
  }

  void measure_tip() {
    const DrawnErrors fixed = errors(only(Component::hand_eye));
    constexpr double kTurnRad = 0.35;
    for (int i = 0; i < request_.trials; ++i) {
      Twist turn = Twist::Zero();
      turn.tail<3>() = kTurnRad * random_.direction();
      Capture other = capture_;
      other.X_MC = moved(capture_.X_MC, turn);
      other.X_MC.translation_mm += random_.between(10, 60) * random_.direction();
      const Eigen::Vector3d here = measured_tip(capture_, fixed), there = measured_tip(other, fixed);
      const double known_mm = (true_tip(other) - true_tip(capture_)).norm();
      outcome_.tip.push_back(std::abs((there - here).norm() - known_mm));
      outcome_.tip_3d.push_back((here - true_tip(capture_)).norm());
    }
  }

  void measure_mapping() {
    const auto landmarks =
        landmarks_of_chance(scene_, capture_.X_MC, static_cast<std::size_t>(request_.landmarks), random_);
    const ErrorSpread spread = spread_of(scene_, request_.model, fiducials_);
    std::vector<std::uint64_t> own_seeds;
    for (std::size_t i = 0; i < landmarks.size(); ++i) own_seeds.push_back(random_.next());
    for (std::size_t c = 0; c < kComponents; ++c) {
      const ComponentSet set = only(static_cast<Component>(c));
      const DrawnErrors drawn = errors(set);
      for (std::size_t i = 0; i < landmarks.size(); ++i)
        if (const auto place = painted(landmarks[i], drawn, set, own_seeds[i]))
          outcome_.alone[c].push_back((*place - landmarks[i].place_mm).norm());
    }
    const DrawnErrors all = errors(kAllComponents);
    for (std::size_t i = 0; i < landmarks.size(); ++i) judge(landmarks[i], all, own_seeds[i], spread);
  }

  LandmarkErrors own_errors(const ComponentSet& set, std::uint64_t seed) const {
    RandomStream random(seed, 2);
    return drawn_landmark_errors(request_.model, set, random);
  }

  std::optional<Eigen::Vector3d> painted(const Landmark& landmark, const DrawnErrors& drawn,
                                         const ComponentSet& set, std::uint64_t seed) const {
    return painted_place(scene_, capture_, landmark, drawn, own_errors(set, seed));
  }

  void judge(const Landmark& landmark, const DrawnErrors& all, std::uint64_t seed,
             const ErrorSpread& spread) {
    const LandmarkErrors own = own_errors(kAllComponents, seed);
    const auto place = painted_place(scene_, capture_, landmark, all, own);
    if (!place) {
      ++outcome_.lost;
      return;
    }
    outcome_.mapping.push_back((*place - landmark.place_mm).norm());
    const auto predicted = predict(scene_, request_.model, spread, capture_, landmark);
    const auto on_plane = painted_on_plane(scene_, capture_, landmark, all, own);
    if (!predicted || !on_plane) return;
    outcome_.predicted.push_back(predicted->rms_mm());
    const auto tangents = tangents_of(landmark.normal);
    const Eigen::Vector2d error = tangents.transpose() * (*place - landmark.place_mm);
    const Eigen::Vector2d flat_error = tangents.transpose() * (*on_plane - landmark.place_mm);
    // The same sheet: near where the tangent plane would have caught the light.
    const double apart_mm = (*place - *on_plane).norm(), expected_mm = flat_error.norm();
    const bool jumped = apart_mm > 1 + expected_mm;
    outcome_.jumped += jumped ? 1 : 0;
    count(outcome_.coverage_all, predicted->covers(error));
    if (!jumped) count(outcome_.coverage, predicted->covers(error));
  }

  static void count(Coverage& coverage, bool covered) {
    ++coverage.points;
    coverage.covered += covered ? 1 : 0;
  }

  const EvaluationScene& scene_;
  const SimulationRequest& request_;
  RandomStream random_;
  std::uint64_t errors_random_ = 0;
  Capture capture_;
  std::vector<Eigen::Vector3d> fiducials_;
  SetupOutcome outcome_;
};

SimulationResult gathered(const std::vector<SetupOutcome>& outcomes) {
  SimulationResult result;
  GroupedValues tracking, tip, tip_3d, mapping, predicted;
  std::array<GroupedValues, kComponents> alone;
  for (const SetupOutcome& outcome : outcomes) {
    tracking.add(outcome.tracking);
    tip.add(outcome.tip);
    tip_3d.add(outcome.tip_3d);
    mapping.add(outcome.mapping);
    predicted.add(outcome.predicted);
    for (std::size_t c = 0; c < kComponents; ++c) alone[c].add(outcome.alone[c]);
    result.coverage.points += outcome.coverage.points;
    result.coverage.covered += outcome.coverage.covered;
    result.coverage_all.points += outcome.coverage_all.points;
    result.coverage_all.covered += outcome.coverage_all.covered;
    result.lost += outcome.lost;
    result.jumped += outcome.jumped;
  }
  result.tracking = tracking.statistics();
  result.tip = tip.statistics();
  result.tip_3d = tip_3d.statistics();
  result.mapping = mapping.statistics();
  result.predicted_rms = predicted.statistics();
  for (std::size_t c = 0; c < kComponents; ++c) result.alone[c] = alone[c].statistics();
  result.mapping_errors_mm = mapping.values();
  return result;
}

}  // namespace

Result<SimulationResult> simulate(const EvaluationScene& scene, const SimulationRequest& request,
                                  const std::function<void(int)>& progress) {
  const auto began = std::chrono::steady_clock::now();
  std::vector<SetupOutcome> outcomes(static_cast<std::size_t>(request.setups));
  std::atomic<int> next{0}, done{0};
  const auto work = [&](bool tells) {
    for (int i = next.fetch_add(1, std::memory_order_relaxed); i < request.setups;
         i = next.fetch_add(1, std::memory_order_relaxed)) {
      outcomes[static_cast<std::size_t>(i)] = Setup(scene, request, i).run();
      const int so_far = done.fetch_add(1, std::memory_order_relaxed) + 1;
      if (tells && progress) progress(so_far);
    }
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < request.threads; ++i) helpers.emplace_back(work, false);
  work(true);
  for (std::thread& helper : helpers) helper.join();
  if (progress) progress(request.setups);
  const auto empty = std::count_if(outcomes.begin(), outcomes.end(),
                                   [](const SetupOutcome& outcome) { return !outcome.found; });
  if (2 * empty > request.setups)
    return fail("in " + std::to_string(empty) + " of " + std::to_string(request.setups) +
                " set-ups no view of the surface has 2 mm of room around the scope; a surface with more room "
                "on the side that --seen-from names is expected");
  SimulationResult result = gathered(outcomes);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return result;
}

}  // namespace orcart
