// Reads the recording, asks each picture how the scope moved, and fits the lag.
#include "tools/calibration/time_command.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <mutex>

#include "tools/calibration/image_motion.hpp"
#include "tools/calibration/time_recording.hpp"
#include "tools/registration/json_text.hpp"

namespace orcart {
namespace {

constexpr double kLongestPair_s = 0.12;  ///< from one frame to the next

/// `work` for every number below `count`, on two threads; the first error.
Result<void> for_each_frame(std::size_t count, const Progress& progress,
                            const std::function<Result<void>(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0, done = 0;
  std::mutex telling;
  Result<void> first_error;
  const auto loop = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      auto result = work(i);
      const std::lock_guard lock(telling);
      if (!result && first_error) first_error = std::move(result);
      if (!first_error) next = count;
      if (progress) progress(++done, count, "pictures");
    }
  };
  auto other = std::async(std::launch::async, loop);
  loop();
  other.wait();
  return first_error;
}

Result<ImageMotion> by_board(const TimeRecording& recording, const Pattern& pattern,
                             const Progress& progress) {
  std::vector<std::optional<SeenBoard>> seen(recording.frames_at_s.size());
  auto looked = for_each_frame(seen.size(), progress, [&](std::size_t i) -> Result<void> {
    const auto picture = recording.picture(i);
    if (!picture) return tl::unexpected(picture.error());
    seen[i] = sight_of_board(*picture, recording.frames_at_s[i], pattern, recording.scope);
    return {};
  });
  if (!looked) return tl::unexpected(looked.error());
  ImageMotion motion{.board = settled(seen, pattern), .features = {}, .frames_at_s = {}};
  if (3 * motion.board.size() < seen.size())
    return fail(
        json::format("the pattern %s was found in %zu of %zu pictures; a third or more is accepted: keep the "
                     "board in view "
                     "while moving, move less swiftly where pictures blur, or leave --pattern out",
                     text_of(pattern).c_str(), motion.board.size(), seen.size()));
  return motion;
}

Result<ImageMotion> by_features(const TimeRecording& recording, const Progress& progress) {
  constexpr std::size_t kEnough = 15;
  FeatureFollower follower(recording.scope);
  const std::vector<double>& at_s = recording.frames_at_s;
  std::size_t near = 0, followed = 0;
  for (std::size_t i = 0; i < at_s.size(); ++i) {
    const bool goes_on = i > 0 && at_s[i] - at_s[i - 1] <= kLongestPair_s;
    if (!goes_on) follower.interrupt();
    const auto picture = recording.picture(i);
    if (!picture) return tl::unexpected(picture.error());
    follower.look(*picture, i);
    if (goes_on) ++near;
    if (goes_on && follower.followed() >= kEnough) ++followed;
    if (progress) progress(i + 1, at_s.size(), "pictures");
  }
  if (2 * followed < near || near == 0)
    return fail(json::format(
        "features could be followed in %zu of %zu pictures; half is accepted: point the scope at something "
        "with texture, in focus and well lit, or at a board with --pattern",
        followed, near));
  return ImageMotion{.board = {}, .features = follower.paths(), .frames_at_s = at_s};
}

/// Paces for the page: between neighbouring samples.
void fill_paces(const PoseTrack& track, const ImageMotion& motion, TimeCalibration& result) {
  for (std::size_t i = 1; i < motion.board.size(); ++i) {
    const BoardSight &a = motion.board[i - 1], &b = motion.board[i];
    if (b.at_s - a.at_s < kLongestPair_s)
      result.picture_pace.emplace_back(0.5 * (a.at_s + b.at_s),
                                       (b.marker_mm - a.marker_mm).norm() / (b.at_s - a.at_s));
  }
  std::vector<std::vector<double>> paces(motion.frames_at_s.size());
  for (const FeaturePath& path : motion.features)
    for (std::size_t k = 1; k < path.size(); ++k) {
      const double length_s = motion.frames_at_s[path[k].frame] - motion.frames_at_s[path[k - 1].frame];
      paces[path[k].frame].push_back((path[k].flat - path[k - 1].flat).norm() / length_s);
    }
  for (std::size_t f = 1; f < paces.size(); ++f) {
    if (paces[f].empty()) continue;
    const auto middle = paces[f].begin() + static_cast<std::ptrdiff_t>(paces[f].size() / 2);
    std::nth_element(paces[f].begin(), middle, paces[f].end());
    result.picture_pace.emplace_back(0.5 * (motion.frames_at_s[f] + motion.frames_at_s[f - 1]), *middle);
  }
  constexpr double kStep_s = 0.02;
  double largest = 1e-9, largest_picture = 1e-9;
  const double first = track.samples().front().at_s;
  const auto steps = static_cast<int>((track.samples().back().at_s - first) / kStep_s);
  for (int i = 0; i <= steps; ++i) {
    const double t = first + kStep_s * i;
    const auto a = track.at(t), b = track.at(t + kStep_s);
    if (!a || !b) continue;
    const double pace = (b->translation_mm - a->translation_mm).norm() / kStep_s;
    result.tracker_pace.emplace_back(t + 0.5 * kStep_s - result.fit.lag_s, pace);
    largest = std::max(largest, pace);
  }
  if (!motion.board.empty()) return;
  for (const auto& p : result.picture_pace) largest_picture = std::max(largest_picture, p.y());
  for (auto& p : result.picture_pace) p.y() *= largest / largest_picture;
}

}  // namespace

Result<TimeCalibration> calibrate_time(const TimeCommand& command, const Progress& progress) {
  const auto recording = read_time_recording(command.recording, command.scope);
  if (!recording) return tl::unexpected(recording.error());
  const Pose<S, C>& X_SC = recording->scope.X_SC;
  if (X_SC.rotation.isIdentity(0) && X_SC.translation_mm.isZero(0))
    return fail(command.recording.string() +
                ": its passport's X_SC is the identity, so nobody knows where the camera sits on its marker; "
                "run orcart calibrate handeye first");
  const double period_s = usual_period_s(recording->track);
  if (recording->track.size() < 20 || period_s > 0.1)
    return fail(command.recording.string() +
                json::format(": %zu poses, %.0f ms apart; 10 a second or more are accepted",
                             recording->track.size(), 1e3 * period_s));
  const PoseTrack track(recording->track, smoothing_s(period_s));
  const auto motion =
      command.pattern ? by_board(*recording, *command.pattern, progress) : by_features(*recording, progress);
  if (!motion) return fail(command.recording.string() + ": " + motion.error().message);
  auto fit = fit_lag(track, *motion,
                     {.search_s = command.search_s,
                      .X_SC = recording->scope.X_SC,
                      .least_explained = command.pattern ? 0.8 : 0.5});
  if (!fit) return fail(command.recording.string() + ": " + fit.error().message);
  TimeCalibration result{.fit = std::move(*fit),
                         .from = command.pattern ? MotionFrom::board : MotionFrom::features,
                         .recorded_with_s = recording->recorded_with_s,
                         .frames = recording->frames_at_s.size(),
                         .used = command.pattern ? motion->board.size() : recording->frames_at_s.size(),
                         .notes = recording->notes};
  result.tracker_against_video_s = result.recorded_with_s + result.fit.lag_s;
  fill_paces(track, *motion, result);
  return result;
}

}  // namespace orcart
