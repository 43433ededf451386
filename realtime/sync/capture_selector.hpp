// Which frame a press means: the first good one whose mid-exposure is not before the edge.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "realtime/sync/captured_frame.hpp"
#include "realtime/sync/frame_matcher.hpp"

namespace orcart {

struct CaptureSelectorSettings {
  Nanos patience = 200ms;       ///< from the edge; then the capture has failed
  Nanos press_arrives = 5ms;    ///< a press may be known this long after its stamp (the pedal's hard bound)
  Nanos release_stable = 20ms;  ///< a release is known this much later still
};

/// Decides by stamps alone: frames are offered in order of mid-exposure, each not before edge_grace() has
/// passed since, so whatever the order in which edge and frame arrive, the answer is the same. One thread;
/// fixed memory.
class CaptureSelector {
 public:
  static constexpr std::size_t kMostWaiting = 8;

  explicit CaptureSelector(const CaptureSelectorSettings& settings = {}) : settings_(settings) {}

  /// A press. False: kMostWaiting wait already, and this one has failed.
  [[nodiscard]] bool request(const CaptureRequest& request) noexcept;
  /// The stream's first picture, the press's, was asked for by request(); from now on every good frame with
  /// mid-exposure from `edge_at` on belongs to it, until the stream's end.
  void begin_stream(const CaptureRequest& request) noexcept;
  /// The last frame of the stream is the last one whose mid-exposure is not after `released_at`.
  void end_stream(Instant released_at) noexcept;
  /// Takes back what still waits of this unit, and its stream. False: nothing did; what was painted is the
  /// painter's to undo.
  bool cancel(std::uint32_t unit) noexcept;

  /// The next frame, as the matcher answered it: what it is to be painted for, if anything. A refused frame
  /// answers no press, but its reason is kept for those that wait.
  std::optional<CaptureRequest> claim(const MatchedFrame& matched) noexcept;

  /// A press that found no good frame in its time; to be shown to the person at once. Call until nothing
  /// comes.
  struct Failed : CaptureRequest {
    Refusal reason = Refusal::no_frame;  ///< of the newest frame it could have been
  };
  std::optional<Failed> next_failed(Instant now) noexcept;

  /// How long after its mid-exposure a frame is to be offered.
  Nanos edge_grace() const noexcept {
    return settings_.press_arrives + (streaming() ? settings_.release_stable : Nanos{0});
  }
  std::size_t waiting() const noexcept { return count_; }
  bool streaming() const noexcept { return stream_.has_value(); }
  /// Presses that came after a frame they meant had been offered: each takes a later frame than it should.
  std::uint32_t late_edges() const noexcept { return late_edges_; }

 private:
  Failed remove(std::size_t index) noexcept;

  CaptureSelectorSettings settings_;
  std::array<Failed, kMostWaiting> waiting_{};  ///< oldest first, each with its reason so far
  std::size_t count_ = 0;
  std::optional<CaptureRequest> stream_;
  Instant stream_until_ = Instant::max();
  Instant last_unclaimed_{};  ///< mid-exposure of the newest good frame that nobody wanted
  std::uint32_t late_edges_ = 0;
};

}  // namespace orcart
