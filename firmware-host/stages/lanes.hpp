// Every channel between the threads, in one place: who writes, who reads, and what is in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "firmware-host/pedal/pedal_gestures.hpp"
#include "firmware-host/stages/paint_order.hpp"
#include "realtime/kernel/mailbox.hpp"
#include "realtime/kernel/spsc_queue.hpp"
#include "realtime/mapper/cutout_patch.hpp"
#include "realtime/sync/captured_frame.hpp"
#include "realtime/sync/encoder_turn.hpp"
#include "realtime/sync/frame_matcher.hpp"
#include "realtime/sync/pose_sample.hpp"

namespace orcart {

/// The tracker as its driver sees it, for the panel.
struct TrackerNews {
  Instant last_reply{};
  Instant last_complete{};  ///< newest sample in which scope and reference were both seen
  bool refuses = false;     ///< it answers, but will not do as it is told
  ToolState scope = ToolState::unseen;
  ToolState reference = ToolState::unseen;
  Instant bumped_at{};    ///< when the sensor was last knocked; zero where never
  bool infrared = false;  ///< too much light of other sources
};

/// The camera as its stage sees it, for the panel.
struct CameraNews {
  Instant last_frame{};     ///< exposure end of the newest frame
  Instant last_dequeued{};  ///< when that was taken from the source
  std::uint32_t damaged = 0;
  bool frozen = false;
  bool connected = true;
  bool stamps_wrong = false;  ///< CameraHealth::stamps_faulty: frames come, and none is painted
};

/// The pedal as its stage sees it, for the panel.
struct PedalNews {
  bool connected = true;
};

/// The turn encoder as its stage sees it.
struct EncoderNews {
  Instant heard_until{};  ///< every angle until then has been handed on
  bool connected = false;
};

/// Why the turn of a scope that is followed is not known now.
enum class TurnLack : std::uint8_t {
  none,
  second_marker,  ///< not seen, or bent
  notch,          ///< none in the picture
  encoder,        ///< not there
  encoder_zero,   ///< there, but nobody said where it is 0
  mismatch,       ///< the pictures' notch says another one
};

/// Where the scope is now, for the outline.
struct ScopeNow {
  Instant at{};
  PoseAnswer pose;
  Pose<M, C> X_MC;
  double turn_rad = 0;                  ///< of the light post since the passport's turn
  TurnLack turn_lack = TurnLack::none;  ///< else the turn is not known, and pose.kind is none
  int mismatch_deg = 0;                 ///< mismatch: by how much the notch is further round
};

/// A frame that is to be painted, for whom, and since when that is known.
struct Selection {
  MatchedFrame matched;
  CaptureRequest request;
  Instant decided_at{};
  std::optional<Twist>
      velocity;  ///< of the scope marker in the reference, a second, in S; nothing: not known
};

struct LaneDepths {
  std::size_t poses, pedal, frames, orders, patches;
  std::size_t encoder_angles = 64;
};

/// Built before arming, lent to the stages by reference.
struct Lanes {
  explicit Lanes(const LaneDepths& d)
      : poses(d.poses),
        pedal(d.pedal),
        encoder_angles(d.encoder_angles),
        frames(d.frames),
        frames_home(d.frames),
        selected(d.frames),
        orders(d.orders),
        patches_home(d.patches) {}

  SpscQueue<PoseSample> poses;             ///< tracker -> mapping
  SpscQueue<PedalEvent> pedal;             ///< pedal -> mapping
  SpscQueue<EncoderAngle> encoder_angles;  ///< encoder -> mapping
  SpscQueue<CapturedFrame> frames;         ///< camera -> mapping; as deep as there are buffers
  SpscQueue<std::uint32_t> frames_home;    ///< render -> camera: the buffers' way home
  SpscQueue<Selection> selected;           ///< sync -> mapper, on one thread
  SpscQueue<PaintOrder> orders;  ///< mapping -> render; deep enough for two orders a buffer and the pedal
  SpscQueue<std::uint32_t> patches_home;    ///< render -> mapping: the patch slots' way home
  LatestMailbox<TrackerNews> tracker_news;  ///< tracker -> render
  LatestMailbox<CameraNews> camera_news;    ///< camera -> render
  LatestMailbox<PedalNews> pedal_news;      ///< pedal -> render
  LatestMailbox<EncoderNews> encoder_news;  ///< encoder -> mapping
  LatestMailbox<ScopeNow> scope_now;        ///< mapping -> render
};

}  // namespace orcart
