// The camera's seam: buffers come out filled and stamped, and must be given back.
#pragma once

#include <cstdint>

#include "board/ports/port_fault.hpp"
#include "realtime/base/image.hpp"
#include "realtime/base/result.hpp"
#include "realtime/kernel/wake_source.hpp"

namespace orcart {

/// What a source delivers, fixed while it streams.
struct FrameFormat {
  int width_px = 0, height_px = 0;
  PixelFormat format = PixelFormat::none;
  double rate_hz = 0;
};

/// One filled buffer, on loan until give_back(index).
struct FrameBuffer {
  std::uint32_t index = 0;  ///< names the buffer, 0 .. buffer_count-1
  ImageDescriptor image;
  std::uint32_t sequence = 0;  ///< counted by the driver; a gap is a lost frame
  Instant stamp{};             ///< the driver's stamp; what it means is configuration (StampMeaning)
  Nanos exposure{};            ///< length of the exposure where the driver tells it, else zero
};

/// One thread calls, but for start() and stop(), which come while no thread takes.
class FrameSource : public WakeSource {
 public:
  virtual FrameFormat format() const noexcept = 0;
  virtual std::uint32_t buffer_count() const noexcept = 0;
  virtual Result<void, PortFault> start() noexcept = 0;
  virtual void stop() noexcept = 0;
  /// The oldest filled buffer; nothing_yet where there is none; damaged where the driver marks it so (it was
  /// requeued already).
  virtual Result<FrameBuffer, PortFault> take() noexcept = 0;
  /// After any other fault, which take() repeats until then: tries to make frames flow again. Buffers on loan
  /// stay on loan. May take long; no frame is missed by that, for none comes.
  virtual Result<void, PortFault> recover() noexcept = 0;
  virtual void give_back(std::uint32_t index) noexcept = 0;
};

}  // namespace orcart
