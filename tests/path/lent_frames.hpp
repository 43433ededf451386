// A camera port that counts its loans: what is out must come home.
#pragma once

#include <set>

#include "board/ports/frame_source.hpp"

namespace orcart::testing {

/// Hands everything on to the camera behind it. Same thread rules.
class LentFrames final : public FrameSource {
 public:
  explicit LentFrames(FrameSource& camera) : camera_(camera) {}

  void wait(Instant deadline) noexcept override { camera_.wait(deadline); }
  Instant next_event() const noexcept override { return camera_.next_event(); }
  FrameFormat format() const noexcept override { return camera_.format(); }
  std::uint32_t buffer_count() const noexcept override { return camera_.buffer_count(); }
  Result<void, PortFault> start() noexcept override { return camera_.start(); }
  void stop() noexcept override { camera_.stop(); }
  Result<FrameBuffer, PortFault> take() noexcept override {
    auto buffer = camera_.take();
    if (buffer) lent_twice_ += out_.insert(buffer->index).second ? 0 : 1;
    if (buffer && black_from_ <= buffer->stamp && buffer->stamp < black_until_) blacken(buffer->image);
    return buffer;
  }
  Result<void, PortFault> recover() noexcept override { return camera_.recover(); }
  void give_back(std::uint32_t index) noexcept override {
    returned_twice_ += out_.erase(index) == 1 ? 0 : 1;
    camera_.give_back(index);
  }

  /// Frames with a stamp in [from, until) come black.
  void blacken(Instant from, Instant until) { black_from_ = from, black_until_ = until; }

  std::size_t out() const { return out_.size(); }
  int lent_twice() const { return lent_twice_; }
  int returned_twice() const { return returned_twice_; }

 private:
  static void blacken(const ImageDescriptor& image) {
    const auto bytes = packed_bytes(image.format, image.width_px, image.height_px);
    for (std::size_t i = 0; i < bytes; ++i)
      image.planes[0].data[i] = std::byte(i % 2 == 0 ? 16 : 128);  // YUYV
  }

  FrameSource& camera_;
  Instant black_from_ = Instant::max(), black_until_ = Instant::max();
  std::set<std::uint32_t> out_;
  int lent_twice_ = 0, returned_twice_ = 0;
};

}  // namespace orcart::testing
