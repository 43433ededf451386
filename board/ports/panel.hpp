// The panel's seam: buffers to draw into, present, and the instant of each flip.
#pragma once

#include <cstdint>
#include <optional>

#include "board/ports/port_fault.hpp"
#include "realtime/base/image.hpp"
#include "realtime/base/instant.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

struct PanelMode {
  int width_px = 1280, height_px = 800;
  double refresh_hz = 60;
};

/// A buffer became what the panel scans out.
struct Flip {
  std::uint64_t serial = 0;  ///< counts presents; names the picture that is now on the panel
  Instant at{};              ///< start of its scan-out
};

/// One thread calls. At most one picture is waiting for its flip.
class Panel {
 public:
  virtual ~Panel() = default;
  virtual PanelMode mode() const noexcept = 0;
  /// A free buffer to draw into, the same one until it is presented; nothing_yet while all are in use.
  virtual Result<ImageDescriptor, PortFault> acquire() noexcept = 0;
  /// Hands the acquired buffer over for the next vblank after `now`; returns its serial. busy while another
  /// picture waits for its flip: the buffer stays acquired, and what was drawn is kept.
  virtual Result<std::uint64_t, PortFault> present(Instant now) noexcept = 0;
  /// The oldest flip not yet taken.
  virtual std::optional<Flip> take_flip(Instant now) noexcept = 0;
  /// The first vblank after `now`, which may be past, as far as it can be told.
  virtual Instant next_vblank(Instant now) const noexcept = 0;
};

}  // namespace orcart
