// A scope that is moved and rested by hand, as the tracker and the camera have it, with a lag that is known.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "tools/calibration/image_motion.hpp"
#include "tools/calibration/time_lag.hpp"

namespace orcart::testing {

struct SimulatedMoves {
  unsigned seed = 1;
  int movements = 6;
  double lag_s = 0;  ///< what is to be added to the frames' stamps
  double tracker_hz = 60, video_hz = 30;
  double tracker_mm = 0.1, tracker_rad = 0.001;  ///< noise, an axis
  double board_mm = 0.15;                        ///< of a board's sight, an axis
  double feature_rad = 0.001;                    ///< of a feature's direction
  double reach_mm = 10, turn_rad = 0.2;          ///< of the camera in a movement
};

/// To and fro, by minimum-jerk strokes (Flash and Hogan 1985), with rests of uneven length.
inline Pose<S, C> moves_X_SC();
class Hand {
 public:
  explicit Hand(const SimulatedMoves& task) {
    std::mt19937 random(task.seed);
    std::normal_distribution<double> any(0, 1);
    std::uniform_real_distribution<double> part(0, 1);
    double t = 0.6;
    const auto stroke = [&](const Eigen::Vector3d& to_mm, const Eigen::Vector3d& to_turn) {
      const double length_s = 0.35 + 0.35 * part(random);
      strokes_.push_back({t, t + length_s, to_mm, to_turn});
      t += length_s;
    };
    for (int m = 0; m < task.movements; ++m) {
      const Eigen::Vector3d way(any(random), any(random), any(random)),
          turn(any(random), any(random), any(random));
      stroke(task.reach_mm * way.normalized(), task.turn_rad * turn.normalized());
      stroke(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
      t += 0.5 + 0.5 * part(random);
    }
    end_s_ = t + 0.2;
  }
  double end_s() const { return end_s_; }

  Pose<T, S> at(double t) const {
    Eigen::Vector3d place = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();
    for (const Stroke& s : strokes_) {
      if (t <= s.from_s) break;
      const double u = std::min(1.0, (t - s.from_s) / (s.to_s - s.from_s));
      const double share = u * u * u * (10 + u * (-15 + 6 * u));
      place += share * (s.to_mm - place), turn += share * (s.to_turn - turn);
    }
    const Pose<T, C> X_TC{.rotation = rotation(turn),
                          .translation_mm = Eigen::Vector3d(100, -50, -1500) + place};
    return X_TC * moves_X_SC().inverse();
  }
  static Eigen::Matrix3d rotation(const Eigen::Vector3d& turn) {
    const double angle = turn.norm();
    return angle < 1e-12 ? Eigen::Matrix3d::Identity()
                         : Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  }

 private:
  struct Stroke {
    double from_s, to_s;
    Eigen::Vector3d to_mm, to_turn;
  };
  std::vector<Stroke> strokes_;
  double end_s_ = 0;
};

inline Pose<S, C> moves_X_SC() {
  return {.rotation = Hand::rotation({0.1, -0.2, 0.4}), .translation_mm = {6, -48, 260}};
}

inline PoseTrack simulated_track(const Hand& hand, const SimulatedMoves& task) {
  std::mt19937 random(1000 + task.seed);
  std::normal_distribution<double> noise(0, 1);
  const auto three = [&] { return Eigen::Vector3d(noise(random), noise(random), noise(random)); };
  std::vector<TrackedPose> samples;
  for (int i = 0; i / task.tracker_hz < hand.end_s(); ++i) {
    Pose<T, S> X_TS = hand.at(i / task.tracker_hz);
    X_TS.translation_mm += task.tracker_mm * three();
    X_TS.rotation *= Hand::rotation(task.tracker_rad * three());
    samples.push_back({i / task.tracker_hz, X_TS});
  }
  return {std::move(samples), smoothing_s(1 / task.tracker_hz)};
}

/// The instants at which the frames see, by the tracker's clock; their stamps are earlier by the lag.
inline std::vector<double> seen_instants(const Hand& hand, const SimulatedMoves& task) {
  std::vector<double> instants;
  for (int k = 0; 0.003 + k / task.video_hz < hand.end_s(); ++k)
    instants.push_back(0.003 + k / task.video_hz);
  return instants;
}

inline ImageMotion simulated_board_motion(const Hand& hand, const SimulatedMoves& task) {
  std::mt19937 random(2000 + task.seed);
  std::normal_distribution<double> noise(0, task.board_mm);
  const auto three = [&] { return Eigen::Vector3d(noise(random), noise(random), noise(random)); };
  const Pose<M, T> X_BT{.rotation = Hand::rotation({1.0, 0.4, -0.7}), .translation_mm = {900, 300, -1200}};
  ImageMotion motion;
  for (const double t : seen_instants(hand, task)) {
    const Pose<M, S> X_BS = X_BT * hand.at(t);
    motion.board.push_back({.at_s = t - task.lag_s,
                            .marker_mm = X_BS.translation_mm + three(),
                            .camera_mm = (X_BS * moves_X_SC()).translation_mm + three()});
  }
  return motion;
}

/// Features on a wavy wall before the scope's resting place, some 40 mm away; each is followed for up to 40
/// frames.
inline ImageMotion simulated_features(const Hand& hand, const SimulatedMoves& task) {
  constexpr std::size_t kFollowed = 40;
  std::mt19937 random(3000 + task.seed);
  std::normal_distribution<double> noise(0, task.feature_rad);
  std::uniform_real_distribution<double> part(-1, 1);
  const Pose<T, C> rest = hand.at(0) * moves_X_SC();
  const auto instants = seen_instants(hand, task);
  ImageMotion motion;
  for (const double t : instants) motion.frames_at_s.push_back(t - task.lag_s);
  for (int i = 0; i < 60; ++i) {
    const double x = 40 * part(random), y = 40 * part(random);
    const Point<T> p = rest * Point<C>{{x, y, 40 + 3 * std::sin(0.2 * x) * std::cos(0.3 * y)}};
    FeaturePath path;
    for (std::size_t k = 0; k < instants.size(); ++k) {
      const Eigen::Vector3d a = ((hand.at(instants[k]) * moves_X_SC()).inverse() * p).mm;
      const bool seen = a.z() > 5 && a.head<2>().norm() < 0.6 * a.z();
      if ((!seen || path.size() == kFollowed) && !path.empty())
        motion.features.push_back(std::move(path)), path.clear();
      if (seen)
        path.push_back(
            {k, Eigen::Vector2d(a.head<2>() / a.z()) + Eigen::Vector2d(noise(random), noise(random))});
    }
  }
  return motion;
}

}  // namespace orcart::testing
