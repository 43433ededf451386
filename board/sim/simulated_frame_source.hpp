// The simulated camera: exposures on any clock, kernel-like stamps and sequence numbers, a bounded pool, and
// faults.
#pragma once

#include <optional>
#include <vector>

#include "board/ports/frame_source.hpp"
#include "board/sim/picture_supply.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// What can be wrong with a camera while a fault lasts.
enum class CameraFault : std::uint8_t {
  off,           ///< no frames, and the sequence stands still
  stuck,         ///< the same image over and over, sequence and stamps advancing
  garbage,       ///< pictures of nonsense
  dropped,       ///< frames are lost: the sequence has a gap
  delayed,       ///< frames are ready later by `amount`
  future_stamp,  ///< stamps lie ahead by `amount`
  damaged,       ///< the driver marks each frame as bad
  io,            ///< from then on transfers fail, until the source recovers after the fault
  disconnected,  ///< the same, because the device is gone
};

/// Strikes the frames whose exposure begins in [from, until) of the procedure; io and disconnected strike at
/// `from`.
struct CameraFaultPeriod {
  CameraFault fault = CameraFault::off;
  Nanos from{}, until{};
  Nanos amount{};
};

enum class StampAt : std::uint8_t { exposure_start, exposure_end };

struct SimulatedCameraSetup {
  Instant start{};  ///< the procedure's start
  StampAt stamp_at = StampAt::exposure_end;
  Nanos readout = 6ms;  ///< from the exposure's end to the filled buffer
  std::uint32_t buffers = 10;
  std::vector<CameraFaultPeriod> faults{};
};

/// Memory is taken and touched in the constructor. Pictures are read ahead in wait(), so that take() finds
/// them ready. A frame that finds no free buffer is lost and leaves a gap in the sequence, as with V4L2.
class SimulatedFrameSource final : public FrameSource {
 public:
  SimulatedFrameSource(Clock& clock, const PictureSupply& pictures, const SimulatedCameraSetup& setup);

  void wait(Instant deadline) noexcept override;
  Instant next_event() const noexcept override;
  FrameFormat format() const noexcept override { return pictures_.format(); }
  std::uint32_t buffer_count() const noexcept override { return setup_.buffers; }
  Result<void, PortFault> start() noexcept override;
  void stop() noexcept override;
  Result<FrameBuffer, PortFault> take() noexcept override;
  Result<void, PortFault> recover() noexcept override;
  void give_back(std::uint32_t index) noexcept override;

 private:
  enum class Place : std::uint8_t { free, filled, lent };
  struct Buffer {
    Place place = Place::free;
    std::uint64_t frame = 0;  ///< where filled or lent: which one
    std::uint32_t sequence = 0;
    std::uint64_t picture = kNoPicture;  ///< which picture the pixels hold
  };
  static constexpr std::uint64_t kNoPicture = ~0ULL;

  const CameraFaultPeriod* fault_of(std::uint64_t frame, CameraFault fault) const noexcept;
  bool comes(std::uint64_t frame) const noexcept;
  std::uint64_t first_frame_from(Nanos since_start) const noexcept;
  std::uint64_t picture_of(std::uint64_t frame) const noexcept;
  Instant ready_at(std::uint64_t frame) const noexcept;
  void find_break(Instant after) noexcept;
  void catch_up(Instant now) noexcept;
  void fill(std::uint64_t frame) noexcept;
  Buffer* oldest_filled() noexcept;
  Buffer* free_buffer(std::uint64_t picture) noexcept;
  bool load(Buffer& buffer, std::uint64_t frame) noexcept;
  void read_ahead() noexcept;
  std::span<std::byte> pixels_of(const Buffer& buffer) noexcept;

  Clock& clock_;
  const PictureSupply& pictures_;
  SimulatedCameraSetup setup_;
  ExposureTiming timing_;
  std::size_t frame_bytes_;
  std::vector<std::byte> pixels_;
  std::vector<Buffer> buffers_;
  std::uint64_t next_ = 0;      ///< the next frame to be filled into a buffer
  std::uint32_t sequence_ = 0;  ///< its sequence number
  bool streaming_ = false;
  std::optional<PortFault> broken_;    ///< the stream failed and waits for stop() and start()
  Instant break_at_ = Instant::max();  ///< when the next such fault strikes
  PortFault break_fault_ = PortFault::io;
};

}  // namespace orcart
