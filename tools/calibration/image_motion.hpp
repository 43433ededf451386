// How the scope moved, by its pictures alone: the board's pose in each, or features followed from one to the
// next.
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "realtime/optics/scope_model.hpp"
#include "tools/calibration/board_view.hpp"
#include "tools/calibration/time_lag.hpp"

namespace orcart {

/// A board as one picture shows it; `anchor` tells whether it looks the same when it is turned.
struct SeenBoard {
  BoardSight sight;
  Anchor anchor = Anchor::sure;
  bool coloured = false;  ///< as BoardView::coloured
};

/// Nothing where no board is found, or which of its corners is which cannot be told. Needs a passport with
/// hand-eye pose. Any thread.
std::optional<SeenBoard> sight_of_board(const cv::Mat& picture, double at_s, const Pattern& pattern,
                                        const ScopeModel& scope);

/// Boards that look the same when they are turned are turned so that the scope moves on from picture to
/// picture. Where coloured dots are seen in some, pictures without them are left out.
std::vector<BoardSight> settled(const std::vector<std::optional<SeenBoard>>& seen, const Pattern& pattern);

/// Follows features from picture to picture (Lucas and Kanade 1981, in pyramids, there and back), inside the
/// mask and away from highlights, which go their own ways. One thread, pictures in their order.
class FeatureFollower {
 public:
  explicit FeatureFollower(const ScopeModel& scope) : scope_(scope) {}

  /// The next picture (8 bit, BGR). What is lost is replaced; a path ends after 90 sights, for what is
  /// followed for long drifts.
  void look(const cv::Mat& picture, std::size_t frame);
  /// What comes next does not go on from the last picture.
  void interrupt();
  /// All paths of two sights and more; ends those that are open.
  std::vector<FeaturePath> paths();
  /// How many features were followed into the last picture.
  std::size_t followed() const { return followed_; }

 private:
  struct Open {
    cv::Point2f pixel;
    FeaturePath path;
  };
  void follow(const cv::Mat& grey, std::size_t frame);
  void replenish(const cv::Mat& grey, std::size_t frame);
  void end(Open& one);

  const ScopeModel& scope_;
  cv::Mat last_;
  std::vector<Open> open_;
  std::vector<FeaturePath> ended_;
  std::size_t followed_ = 0;
};

}  // namespace orcart
