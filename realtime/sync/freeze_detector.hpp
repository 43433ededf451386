// Notices a picture that stands still though its sequence number goes on.
#pragma once

#include <cstdint>

#include "realtime/base/instant.hpp"

namespace orcart {

/// VIDEO FROZEN?: the same picture for 1 s while its sequence number advances. Sensor noise makes two
/// exposures differ, so equal checksums mean that some part of the chain repeats itself. One thread.
class FreezeDetector {
 public:
  static constexpr Nanos kFrozenAfter = 1s;

  /// `stamp`: of the frame; `checksum`: of its pixels. True: frozen.
  bool see(std::uint32_t sequence, Instant stamp, std::uint32_t checksum) noexcept {
    if (have_ && sequence == sequence_) return frozen_;
    const bool same = have_ && checksum == checksum_;
    if (same)
      ++repeats_;
    else
      since_ = stamp;
    have_ = true;
    sequence_ = sequence;
    checksum_ = checksum;
    frozen_ = stamp - since_ >= kFrozenAfter;
    return frozen_;
  }

  bool frozen() const noexcept { return frozen_; }
  /// Frames that repeated their predecessor's picture.
  std::uint32_t repeats() const noexcept { return repeats_; }

 private:
  bool have_ = false, frozen_ = false;
  std::uint32_t checksum_ = 0, sequence_ = 0;
  Instant since_{};
  std::uint32_t repeats_ = 0;
};

}  // namespace orcart
