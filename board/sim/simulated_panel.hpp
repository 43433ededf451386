// The simulated panel: three buffers, flips at its own refresh on any clock, and a memory of what was shown
// when.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "board/ports/panel.hpp"
#include "board/sim/panel_observer.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// While it lasts, [from, until): flips do not complete (a hung pipe), or every call says disconnected.
enum class PanelFault : std::uint8_t { flip_stuck, disconnected };
struct PanelFaultPeriod {
  PanelFault fault = PanelFault::flip_stuck;
  Instant from{}, until{};
};

struct SimulatedPanelSetup {
  PanelMode mode;
  Instant first_vblank{};  ///< the panel's own phase: vblank k is at first_vblank + k / refresh_hz, for every
                           ///< whole k
  std::vector<PanelFaultPeriod> faults{};
  std::size_t flips_kept = 16'384;  ///< the newest flips that shown_at() remembers
};

/// One thread calls. acquire() gives the same buffer until it is presented; present() says busy while another
/// picture waits for its flip (the buffer stays acquired). Memory is taken and touched in the constructor.
class SimulatedPanel final : public Panel {
 public:
  SimulatedPanel(Clock& clock, const SimulatedPanelSetup& setup,
                 std::span<PanelObserver* const> observers = {});

  PanelMode mode() const noexcept override { return setup_.mode; }
  Result<ImageDescriptor, PortFault> acquire() noexcept override;
  Result<std::uint64_t, PortFault> present(Instant now) noexcept override;
  std::optional<Flip> take_flip(Instant now) noexcept override;
  Instant next_vblank(Instant now) const noexcept override;

  /// When the next picture comes onto the panel; Instant::max() where none waits.
  Instant next_event() const noexcept;
  /// The picture on the panel at an instant, from the memory of flips; nothing before the first or after
  /// forgetting.
  std::optional<Flip> shown_at(Instant at) const noexcept;
  std::uint64_t flips() const noexcept { return flips_done_; }

 private:
  static constexpr int kBuffers = 3;
  static constexpr int kNone = -1;

  void complete_flip(Instant now) noexcept;
  Instant flip_of_present(Instant now) const noexcept;
  bool faulty(PanelFault fault, Instant at) const noexcept;
  ImageDescriptor image(int buffer) noexcept;

  Clock& clock_;
  SimulatedPanelSetup setup_;
  std::vector<PanelObserver*> observers_;
  std::vector<std::byte> pixels_;
  int drawing_ = kNone, waiting_ = kNone, shown_ = kNone;
  std::uint64_t serial_ = 0;
  Flip waiting_flip_{};
  std::vector<Flip> memory_;  ///< ring of the newest flips
  std::uint64_t flips_done_ = 0, flips_taken_ = 0;
};

}  // namespace orcart
