// Debounces the pedal and reads its gestures: press, press twice, hold. Thread: pedal. All instants are the
// kernel's.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "board/ports/gpio_lines.hpp"

namespace orcart {

enum class PedalEventKind : std::uint8_t {
  capture,       ///< a press: take a picture; at: its edge
  cancel,        ///< a second press: the capture of `unit` was not meant; at: the second edge
  undo,          ///< follows cancel: the newest unit before it goes as well
  stream_begin,  ///< held: from now on every frame belongs to `unit`; at: the edge of the press
  stream_end,    ///< released: no frame after `at` belongs to `unit`
  stuck,         ///< warning: held for too long; ignored until it is released
  lost_edge,     ///< warning: an edge went missing; ignored until the line is up again
};

struct PedalEvent {
  PedalEventKind kind = PedalEventKind::capture;
  std::uint32_t unit = 0;  ///< undo unit of the newest capture, from 1
  Instant at{};
};

struct PedalSettings {
  Nanos lock_out = 40ms;        ///< after a press no other counts: bounce
  Nanos release_stable = 20ms;  ///< a release counts when the line has been quiet for this long
  Nanos second_press = 350ms;   ///< a press sooner than this after a capture takes it back
  Nanos hold = 500ms;           ///< held for this long: a stream
  Nanos stuck = 5s;             ///< held for this long: a fault
};

/// A press acts on its leading edge, at once. The events and their stamps depend on the edges' stamps alone,
/// not on when they are handed over, as long as edge() and advance() are called in order of time. One thread;
/// fixed memory.
class PedalGestures {
 public:
  explicit PedalGestures(const PedalSettings& settings = {}) : settings_(settings) {}

  /// The next edge; whatever time alone brought about before it comes first.
  void edge(const PedalEdge& edge) noexcept;
  /// Time goes on. Every edge stamped up to `now` must have been handed over: read the clock, drain the line,
  /// then call this.
  void advance(Instant now) noexcept;
  /// The oldest event; call until nothing comes, after each call of the two above.
  std::optional<PedalEvent> next() noexcept;
  /// When advance() next has something to say if no edge comes; Instant::max() where never.
  Instant due() const noexcept;

 private:
  enum class State : std::uint8_t {
    up,
    down,  ///< pressed for a capture; may become a stream
    streaming,
    down_idle,  ///< the second press of a pair: only its release counts
    ignoring,   ///< stuck, or an edge was lost
  };
  void press(Instant at) noexcept;
  void release(Instant at) noexcept;
  void ignore(PedalEventKind why, Instant at) noexcept;
  void emit(PedalEventKind kind, Instant at) noexcept;
  Instant release_due() const noexcept;

  PedalSettings settings_;
  State state_ = State::up;
  bool line_pressed_ = false, have_edge_ = false;
  std::uint32_t sequence_ = 0;
  Instant pressed_at_{};  ///< edge of the newest accepted press
  Instant line_changed_at_{};
  std::optional<Instant> captured_at_;  ///< the press that a second one would take back
  std::uint32_t unit_ = 0;
  std::array<PedalEvent, 16> events_{};
  std::size_t first_ = 0, size_ = 0;
};

}  // namespace orcart
