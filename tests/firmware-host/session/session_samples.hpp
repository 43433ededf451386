// Captures whose every byte follows from their number, and a folder that goes away with the test.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "firmware-host/session/session_records.hpp"

namespace orcart::testing {

inline constexpr int kWidth_px = 48, kHeight_px = 32;

/// A private folder, removed at the end.
class SessionFolder {
 public:
  SessionFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "orcart-session-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~SessionFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  SessionFolder(const SessionFolder&) = delete;
  SessionFolder& operator=(const SessionFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Neither even nor compressible to nothing.
inline std::vector<std::byte> picture_bytes(std::uint32_t number, int width_px = kWidth_px,
                                            int height_px = kHeight_px) {
  std::vector<std::byte> bytes(packed_bytes(PixelFormat::yuyv, width_px, height_px));
  std::uint32_t state = number * 2654435761U + 1;
  for (std::byte& b : bytes) {
    state = state * 1664525U + 1013904223U;
    b = static_cast<std::byte>(state >> 27);
  }
  return bytes;
}

inline CapturedFrame frame_number(std::uint32_t number, std::vector<std::byte>& bytes) {
  CapturedFrame frame{.buffer = number % 7, .sequence = 1000 + number};
  frame.image = packed_image(bytes.data(), PixelFormat::yuyv, kWidth_px, kHeight_px);
  frame.exposure_start = instant_from_nanos(1'000'000'000LL * number + 1);
  frame.exposure_end = frame.exposure_start + 8ms;
  frame.dequeued_at = frame.exposure_end + 2ms;
  return frame;
}

inline CaptureFacts facts_number(std::uint32_t number) {
  CaptureFacts facts{.unit = number, .streaming = number % 2 == 0};
  facts.edge_at = instant_from_nanos(1'000'000'000LL * number);
  facts.matched_at = facts.edge_at + 20ms;
  facts.painted_at = facts.edge_at + 40ms;
  facts.X_MC.rotation =
      Eigen::AngleAxisd(0.01 * number, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  facts.X_MC.translation_mm = {1.0 / 3 * number, -2, 1e-9};
  facts.turn_rad = 0.1 * number;
  facts.pose_kind = PoseKind::interpolated;
  facts.pose_distance = Nanos{number};
  if (number % 2 == 1) {
    facts.velocity.emplace();
    *facts.velocity << 1, -2, 3, 0.1 * number, -0.2, 1.0 / 3;
  }
  return facts;
}

}  // namespace orcart::testing
