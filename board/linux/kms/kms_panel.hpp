// The real panel: three buffers that go round, flips as the kernel stamps them, a pipe that hangs and a cable
// that is pulled.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "board/linux/kms/scan_out.hpp"
#include "board/ports/panel.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// One thread. A flip that does not come within kFlipPatience sets the mode anew; when the pipe hangs for
/// kHangPatience the panel is given up: every call says io, and the program ends to be started again.
/// Unplugged, every call says disconnected until a panel is back.
class KmsPanel final : public Panel {
 public:
  /// Sets the mode with a black picture.
  static Result<std::unique_ptr<KmsPanel>, PortFault> start(std::unique_ptr<ScanOut> scan_out, Clock& clock);

  PanelMode mode() const noexcept override { return scan_out_->mode(); }
  Result<ImageDescriptor, PortFault> acquire() noexcept override;
  Result<std::uint64_t, PortFault> present(Instant now) noexcept override;
  std::optional<Flip> take_flip(Instant now) noexcept override;
  Instant next_vblank(Instant now) const noexcept override;

  bool given_up() const noexcept { return given_up_; }
  std::uint32_t modes_set_anew() const noexcept { return modes_set_anew_; }

  static constexpr Nanos kFlipPatience = 50ms;
  static constexpr Nanos kHangPatience = 1s;
  static constexpr Nanos kLook = 250ms;  ///< between two looks at the connector

 private:
  static constexpr int kNone = -1;

  KmsPanel(std::unique_ptr<ScanOut> scan_out, Clock& clock) : scan_out_(std::move(scan_out)), clock_(clock) {}
  std::optional<PortFault> trouble(Instant now) noexcept;
  void look_at_connector(Instant now) noexcept;
  void collect_flips() noexcept;
  void came_onto_panel(Instant at) noexcept;
  void free_a_hung_pipe(Instant now) noexcept;
  bool show_again(int buffer, Instant now) noexcept;
  int free_buffer() const noexcept;

  std::unique_ptr<ScanOut> scan_out_;
  Clock& clock_;
  int drawing_ = kNone, waiting_ = kNone, shown_ = 0;
  std::uint64_t serial_ = 0, waiting_serial_ = 0;
  Instant handed_over_at_{}, last_vblank_{}, look_at_{}, try_at_{};
  std::array<Flip, 4> flips_{};  ///< come and not yet taken; the oldest is forgotten for a fifth
  std::size_t first_flip_ = 0, flip_count_ = 0;
  bool unplugged_ = false, given_up_ = false;
  std::uint32_t modes_set_anew_ = 0;
};

}  // namespace orcart
