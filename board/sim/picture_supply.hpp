// Where a simulated camera's pictures come from: a movie file on a cart, memory in tests.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "board/ports/frame_source.hpp"
#include "board/sim/exposure_timing.hpp"
#include "realtime/geometry/pose.hpp"

namespace orcart {

/// Reads may come from any thread.
class PictureSupply {
 public:
  virtual ~PictureSupply() = default;
  virtual FrameFormat format() const noexcept = 0;
  virtual ExposureTiming timing() const noexcept = 0;
  virtual std::uint64_t frame_count() const noexcept = 0;
  /// Copies frame k's packed pixels; false where the store fails. Allocates nothing.
  virtual bool read(std::uint64_t frame, std::span<std::byte> into) const noexcept = 0;
};

/// A few pictures in memory, over and over.
class MemoryPictures final : public PictureSupply {
 public:
  MemoryPictures(const FrameFormat& format, const ExposureTiming& timing, std::uint64_t frame_count,
                 std::vector<std::vector<std::byte>> pictures)
      : format_(format), timing_(timing), frame_count_(frame_count), pictures_(std::move(pictures)) {}

  FrameFormat format() const noexcept override { return format_; }
  ExposureTiming timing() const noexcept override { return timing_; }
  std::uint64_t frame_count() const noexcept override { return frame_count_; }
  bool read(std::uint64_t frame, std::span<std::byte> into) const noexcept override;

 private:
  FrameFormat format_;
  ExposureTiming timing_;
  std::uint64_t frame_count_;
  std::vector<std::vector<std::byte>> pictures_;
};

}  // namespace orcart
