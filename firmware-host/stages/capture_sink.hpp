// Where captures go to be kept: a seam, so that the painter stage knows nothing of files.
#pragma once

#include "firmware-host/stages/frame_ledger.hpp"

namespace orcart {

/// keep() and undone() are called on the render thread: each copies what it wants and returns at once. Full:
/// counts, and the live view goes on.
class CaptureSink {
 public:
  virtual ~CaptureSink() = default;
  virtual void keep(const CapturedFrame& frame, const CaptureRecord& record) noexcept = 0;
  virtual void undone(std::uint32_t unit) noexcept = 0;
  /// Any thread: captures that are not kept, and never will be.
  virtual std::uint64_t lost() const noexcept = 0;
  /// Any thread: the newest write failed; what comes will be lost too until one succeeds.
  virtual bool failing() const noexcept = 0;
};

}  // namespace orcart
