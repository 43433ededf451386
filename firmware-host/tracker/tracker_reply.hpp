// What one completed poll of the tracker says, tool by tool, in the order of the configuration.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>

#include "realtime/base/instant.hpp"
#include "realtime/sync/pose_sample.hpp"

namespace orcart {

inline constexpr std::size_t kMaxTools = 8;

/// Rotation and translation take the tool's own frame to tracker space T; they mean something only where
/// `seen`.
struct ToolReading {
  ToolState state = ToolState::unseen;
  Eigen::Quaterniond quaternion = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();
  float error_mm = 0;              ///< RMS of the device's marker fit
  std::uint32_t port_status = 0;   ///< as in ndi::port_status_words()
  std::uint32_t device_frame = 0;  ///< devices that measure kinds of tools in turn have one for each
};

struct TrackerReply {
  std::uint32_t device_frame = 0;  ///< the newest of the tools'
  Instant arrived_at{};            ///< host time of the reply's last byte
  Instant asked_at{};              ///< host time at which the poll was handed to the link
  Nanos wire_time{};  ///< what the reply's bytes took over the line at its rate; 0 without a line
  std::array<ToolReading, kMaxTools> tools;
  int tool_count = 0;
  std::uint16_t system_status = 0;

  std::span<const ToolReading> readings() const noexcept {
    return {tools.data(), static_cast<std::size_t>(tool_count)};
  }
};

}  // namespace orcart
