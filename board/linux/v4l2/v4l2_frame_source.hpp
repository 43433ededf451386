// The real camera: a V4L2 device that streams into mapped buffers, recovers by itself when told to, and tells
// its faults.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "board/linux/v4l2/camera_query.hpp"
#include "board/linux/v4l2/kernel_buffers.hpp"
#include "board/linux/v4l2/mjpeg_decoder.hpp"
#include "board/ports/frame_source.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// Raw pictures are lent where the driver wrote them; MJPEG is decoded in take() into a pool of the same
/// number of pictures. Both sets of memory are taken in open(); recover() alone takes more.
class V4l2FrameSource final : public FrameSource {
 public:
  struct Setup {
    CameraWish wish;
    std::uint32_t buffers = 10;  ///< wanted; a driver may give fewer
    Clock& clock;
    DeviceCalls& calls = system_calls();
  };
  /// Refused in one sentence: absent, busy, no permission, a mode that the device does not have (with those
  /// it has), a control out of range.
  static Result<std::unique_ptr<V4l2FrameSource>> open(const Setup& setup);
  ~V4l2FrameSource() override;

  void wait(Instant deadline) noexcept override;
  FrameFormat format() const noexcept override { return format_; }
  std::uint32_t buffer_count() const noexcept override { return static_cast<std::uint32_t>(slots_.size()); }
  Result<void, PortFault> start() noexcept override;
  void stop() noexcept override;
  Result<FrameBuffer, PortFault> take() noexcept override;
  void give_back(std::uint32_t index) noexcept override;
  Result<void, PortFault> recover() noexcept override;

  /// False where the driver's stamps belong to no known clock: the only meaning left is `dequeued`.
  bool stamps_are_monotonic() const noexcept { return monotonic_stamps_; }
  /// Whether every buffer came with a dma-buf.
  bool exports_dma_bufs() const noexcept;
  const std::string& card() const noexcept { return card_; }
  /// Why the newest recover() failed, for the log; empty after one that succeeded.
  const std::string& trouble() const noexcept { return trouble_; }

  /// No frame for this long, though there is a buffer for it: the driver has stopped.
  static constexpr Nanos kSilence = 500ms;
  /// The same for the first frame: a camera's sensor has to wake up.
  static constexpr Nanos kFirstFrame = 3s;

 private:
  enum class Place : std::uint8_t { home, queued, lent };
  struct Slot {
    BufferMapping memory;
    BufferMapping next;  ///< of the device that was opened anew while this buffer was lent
    Place place = Place::home;
  };
  explicit V4l2FrameSource(const Setup& setup) : setup_(setup) {}

  Result<void, CameraTrouble> open_device() noexcept;
  Result<void, CameraTrouble> adopt(KernelBuffers&& buffers) noexcept;
  Result<void, PortFault> start_stream() noexcept;
  void end_stream() noexcept;
  void queue(std::uint32_t index) noexcept;
  tl::unexpected<PortFault> fail_with(PortFault fault) noexcept;
  Result<FrameBuffer, PortFault> accept(const FilledBuffer& filled) noexcept;
  ImageDescriptor picture_in(const BufferMapping& memory) const noexcept;
  Result<FrameBuffer, PortFault> decode(const FilledBuffer& filled) noexcept;
  bool was_queued(std::uint32_t index) const noexcept;
  bool is_other_field(const FilledBuffer& filled) const noexcept;
  std::size_t free_picture() const noexcept;
  bool decodes() const noexcept { return setup_.wish.format == WireFormat::mjpeg; }

  Setup setup_;
  OpenDevice device_;
  CameraAgreement agreed_;
  FrameFormat format_;
  std::string card_, trouble_;
  std::vector<Slot> slots_;          ///< what is lent: the driver's buffers, or the pool's pictures
  std::vector<BufferMapping> wire_;  ///< MJPEG only: the driver's buffers
  std::vector<std::byte> pool_;      ///< MJPEG only
  std::optional<MjpegDecoder> decoder_;
  bool monotonic_stamps_ = false;
  bool streaming_ = false, poll_failed_ = false;
  std::size_t queued_ = 0;
  std::optional<PortFault> fault_;
  Instant silent_at_{};  ///< when the driver counts as stopped
};

}  // namespace orcart
