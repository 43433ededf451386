// What a panel needs of a display card: buffers that can be shown, flips, and whether somebody still looks.
#pragma once

#include <cstdint>
#include <optional>

#include "board/linux/kms/flip_events.hpp"
#include "board/ports/panel.hpp"
#include "board/ports/port_fault.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// One thread. Buffers are named 0 .. kBuffers-1 and exist from the start.
class ScanOut {
 public:
  static constexpr int kBuffers = 3;  ///< one shown, one waiting for its flip, one being drawn

  virtual ~ScanOut() = default;
  virtual PanelMode mode() const noexcept = 0;
  virtual ImageDescriptor buffer(int index) noexcept = 0;
  /// Before a buffer is handed over: whatever must still be copied or turned.
  virtual void finish_drawing(int index) noexcept = 0;
  /// Asks for the next vblank and returns; next_flip() tells when it came. busy while one is under way.
  virtual Result<void, PortFault> flip(int index, std::uint64_t serial) noexcept = 0;
  virtual std::optional<FlipEvent> next_flip() noexcept = 0;
  /// Sets the mode anew with this buffer; waits for it. Flips under way are void.
  virtual Result<void, PortFault> set_mode(int index) noexcept = 0;
  /// The newest vblank, so that the pipe's phase is known before the first flip; nothing where it is not
  /// told.
  virtual std::optional<Instant> newest_vblank() noexcept { return std::nullopt; }
  /// Whether a panel is on the connector; cheap, no probing.
  virtual bool connected() noexcept = 0;
};

}  // namespace orcart
