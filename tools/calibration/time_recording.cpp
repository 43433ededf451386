// Two sources, one form: the cart's session file, and a folder of pictures with two tables.
#include "tools/calibration/time_recording.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include <opencv2/imgproc.hpp>

#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/text_cursor.hpp"
#include "firmware-host/files/whole_file.hpp"
#include "firmware-host/session/session_reader.hpp"
#include "realtime/optics/scope_turn.hpp"
#include "tools/calibration/load_picture.hpp"
#include "tools/registration/json_text.hpp"
#include "tools/registration/poses_file.hpp"

namespace orcart {
namespace {

constexpr std::uintmax_t kLargestTable_bytes = 64U << 20U;
constexpr const char* kAccepted = "image,time_ms (a name and its mid-exposure) is accepted";

Result<cv::Mat> bgr_of(StoredPicture& stored) {
  const int rows = stored.height_px, columns = stored.width_px;
  cv::Mat bgr;
  switch (stored.format) {
    case PixelFormat::yuyv:
      cv::cvtColor(cv::Mat(rows, columns, CV_8UC2, stored.bytes.data()), bgr, cv::COLOR_YUV2BGR_YUYV);
      return bgr;
    case PixelFormat::uyvy:
      cv::cvtColor(cv::Mat(rows, columns, CV_8UC2, stored.bytes.data()), bgr, cv::COLOR_YUV2BGR_UYVY);
      return bgr;
    case PixelFormat::nv12:
      cv::cvtColor(cv::Mat(rows * 3 / 2, columns, CV_8U, stored.bytes.data()), bgr, cv::COLOR_YUV2BGR_NV12);
      return bgr;
    case PixelFormat::gray8:
      cv::cvtColor(cv::Mat(rows, columns, CV_8U, stored.bytes.data()), bgr, cv::COLOR_GRAY2BGR);
      return bgr;
    case PixelFormat::rgba8888:
      cv::cvtColor(cv::Mat(rows, columns, CV_8UC4, stored.bytes.data()), bgr, cv::COLOR_RGBA2BGR);
      return bgr;
    case PixelFormat::xrgb8888:
      cv::cvtColor(cv::Mat(rows, columns, CV_8UC4, stored.bytes.data()), bgr, cv::COLOR_BGRA2BGR);
      return bgr;
    case PixelFormat::none:
      break;
  }
  return fail("pictures of an unknown format; yuyv, uyvy, nv12, rgba, xrgb and grey are accepted");
}

Result<cv::Mat> of_scope(Result<cv::Mat> picture, const ScopeModel& scope, const std::string& name) {
  if (!picture || (picture->cols == scope.width_px && picture->rows == scope.height_px)) return picture;
  return fail(name + json::format(": %dx%d px; the scope's %dx%d are accepted", picture->cols, picture->rows,
                                  scope.width_px, scope.height_px));
}

Result<TimeRecording> read_session(const std::filesystem::path& file,
                                   const std::filesystem::path& scope_file) {
  auto opened = SessionReader::open(file);
  if (!opened) return tl::unexpected(opened.error());
  const auto session = std::make_shared<SessionReader>(std::move(*opened));
  if (!scope_file.empty())
    return fail(file.string() + ": a session carries its own passport; --scope belongs to a folder");
  const auto calibration = session->calibration();
  if (!calibration) return tl::unexpected(calibration.error());
  auto scope = read_scope_text(calibration->scope_toml, file.string() + " (scope.toml)");
  if (!scope) return tl::unexpected(scope.error());
  const auto meta = session->meta();
  if (!meta) return tl::unexpected(meta.error());
  *scope = turned(*scope, meta->turn_rad);
  auto captures = session->captures();
  if (!captures) return tl::unexpected(captures.error());
  std::erase_if(*captures, [](const StoredCapture& c) { return !c.facts.streaming; });
  std::sort(captures->begin(), captures->end(),
            [](const auto& a, const auto& b) { return a.exposure_start < b.exposure_start; });
  if (captures->empty())
    return fail(file.string() +
                ": holds no stream; hold the pedal for up to 5 s while the scope moves, five times or more");
  TimeRecording recording{.scope = *scope, .recorded_with_s = seconds(meta->tracker_against_video)};
  auto ids = std::make_shared<std::vector<std::int64_t>>();
  for (const StoredCapture& c : *captures) {
    const double at_s =
        seconds(c.exposure_start + (c.exposure_end - c.exposure_start) / 2 - meta->started_at);
    if (!recording.frames_at_s.empty() && at_s <= recording.frames_at_s.back()) continue;
    const Pose<M, S> X_MS = c.facts.X_MC * scope->X_SC.inverse();
    recording.track.push_back(
        {.at_s = at_s, .X_TS = {.rotation = X_MS.rotation, .translation_mm = X_MS.translation_mm}});
    recording.frames_at_s.push_back(at_s);
    ids->push_back(c.id);
  }
  const auto one_at_a_time = std::make_shared<std::mutex>();
  recording.picture = [session, ids, one_at_a_time, file,
                       scope = *scope](std::size_t frame) -> Result<cv::Mat> {
    const std::lock_guard lock(*one_at_a_time);
    auto stored = session->picture((*ids)[frame]);
    if (!stored) return tl::unexpected(stored.error());
    return of_scope(bgr_of(*stored), scope,
                    file.string() + " (capture " + std::to_string((*ids)[frame]) + ")");
  };
  return recording;
}

struct FrameRow {
  std::filesystem::path image;
  double at_s = 0;
};

Result<std::vector<FrameRow>> read_frames(const std::filesystem::path& file) {
  const auto bytes = read_whole_file(file, kLargestTable_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  TextCursor cursor({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  std::vector<FrameRow> rows;
  while (!cursor.at_end()) {
    const std::string_view line = cursor.line();
    if (line.empty() || line.starts_with('#') || line.starts_with("image,")) continue;
    const std::string place = file.string() + ":" + std::to_string(cursor.line_number()) + ": ";
    const auto comma = line.rfind(',');
    const auto at_ms = comma == std::string_view::npos
                           ? std::nullopt
                           : TextCursor::parse_number<double>(line.substr(comma + 1));
    if (!at_ms || !std::isfinite(*at_ms) || comma == 0)
      return fail(place + "\"" + std::string(line) + "\" names no picture with a time; " + kAccepted);
    if (!rows.empty() && 1e-3 * *at_ms <= rows.back().at_s)
      return fail(place + "the time does not rise; frames in the order of their mid-exposures are accepted");
    rows.push_back({file.parent_path() / std::string(line.substr(0, comma)), 1e-3 * *at_ms});
  }
  if (rows.empty()) return fail(file.string() + ": names no picture; " + kAccepted);
  return rows;
}

Result<std::vector<TrackedPose>> read_track(const std::filesystem::path& file,
                                            std::vector<std::string>& notes) {
  const auto poses = read_poses(file);
  if (!poses) return tl::unexpected(poses.error());
  std::vector<TrackedPose> track;
  for (const NamedPose& pose : poses->poses) {
    const auto at_ms = TextCursor::parse_number<double>(pose.name);
    if (!at_ms || !std::isfinite(*at_ms))
      return fail(file.string() + ": the pose \"" + pose.name +
                  "\" has no time; time_ms,m00,...,m23 is accepted");
    if (!track.empty() && 1e-3 * *at_ms <= track.back().at_s)
      return fail(file.string() + ": the time does not rise at " + pose.name +
                  " ms; poses in the order of their times are accepted");
    track.push_back({1e-3 * *at_ms, pose.X_TS});
  }
  notes = poses->notes;
  return track;
}

Result<TimeRecording> read_folder(const std::filesystem::path& folder,
                                  const std::filesystem::path& scope_file) {
  if (scope_file.empty())
    return fail(folder.string() + ": a folder carries no passport; --scope scope.toml is wanted");
  const auto scope = read_scope(scope_file);
  if (!scope) return tl::unexpected(scope.error());
  auto frames = read_frames(folder / "frames.csv");
  if (!frames) return tl::unexpected(frames.error());
  TimeRecording recording{.scope = *scope};
  auto track = read_track(folder / "poses.csv", recording.notes);
  if (!track) return tl::unexpected(track.error());
  recording.track = std::move(*track);
  for (const FrameRow& row : *frames) recording.frames_at_s.push_back(row.at_s);
  recording.picture = [rows = std::move(*frames), scope = *scope](std::size_t frame) -> Result<cv::Mat> {
    cv::Mat picture;
    if (std::filesystem::exists(rows[frame].image)) picture = load_picture(rows[frame].image);
    if (picture.empty())
      return fail(rows[frame].image.string() +
                  ": cannot be read as a picture; PNG, JPEG, TIFF and BMP are accepted");
    return of_scope(std::move(picture), scope, rows[frame].image.string());
  };
  return recording;
}

}  // namespace

Result<TimeRecording> read_time_recording(const std::filesystem::path& recording,
                                          const std::filesystem::path& scope_file) {
  auto read = std::filesystem::is_directory(recording) ? read_folder(recording, scope_file)
                                                       : read_session(recording, scope_file);
  if (!read) return read;
  if (const auto first = read->picture(0); !first) return tl::unexpected(first.error());
  return read;
}

}  // namespace orcart
