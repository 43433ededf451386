// A driver, an emulated tracker and a clock between them, for tests of the driver.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "board/sim/ndi/simulated_byte_link.hpp"
#include "firmware-host/tracker/ndi/tool_definition_writer.hpp"
#include "firmware-host/tracker/ndi_driver.hpp"
#include "tests/firmware-host/tracker/link_between.hpp"

namespace orcart::testing {

/// Two tools on circles of 50 mm, 1.5 m in front of the sensor; either may be hidden.
class CirclingTools final : public ToolMotion {
 public:
  TrueToolPose pose_of(int tool, Instant at) const noexcept override {
    const double turn = seconds(at - Instant{}) * 0.5 + tool;
    TrueToolPose pose;
    pose.rotation = Eigen::AngleAxisd(0.4 * turn, Eigen::Vector3d(1, 2, 3).normalized());
    pose.translation_mm = {50 * std::cos(turn), 50 * std::sin(turn), -1500.0 + 10 * tool};
    pose.visible = tool != hidden;
    return pose;
  }
  int hidden = -1;
};

inline ndi::ToolDefinition simulated_tool(std::string_view part, std::uint8_t main_type) {
  constexpr std::array<std::array<float, 3>, 4> kMarkers{
      {{0, 0, 0}, {0, 28.59F, 41.02F}, {0, 0, 88}, {0, -44.32F, 40.45F}}};
  const auto file =
      ndi::encode_tool_definition({.markers_mm = kMarkers, .part_number = part, .main_type = main_type});
  return ndi::parse_tool_definition(file, part).value();
}

inline NdiSettings two_tools(std::uint32_t baud = 115200) {
  return {.tools = {simulated_tool("SCOPE", 2), simulated_tool("REFERENCE", 1)}, .baud = baud};
}

struct TrackerRig {
  explicit TrackerRig(NdiSettings driver_settings = two_tools(), NdiEmulatorSettings device_settings = {})
      : device(device_settings, motion),
        cable(device, clock),
        link(cable, clock),
        driver(std::move(driver_settings), link) {}

  /// Steps the driver whenever input or its own plan wants it, until `at`. Each report goes to `see`.
  void run_until(Instant at, const std::function<void(const DriverReport&)>& see = {}) {
    while (clock.now() < at) {
      link.wait(std::min(at, driver.next_due()));
      const DriverReport report = driver.step(clock.now());
      if (see) see(report);
    }
  }
  void run_for(Nanos time, const std::function<void(const DriverReport&)>& see = {}) {
    run_until(clock.now() + time, see);
  }
  /// Runs until the tracker is live; fails the test after `most`.
  void start(Nanos most = 10s) {
    const Instant end = clock.now() + most;
    while (driver.health() != TrackerHealth::live && clock.now() < end)
      run_until(std::min(end, driver_due()));
    ASSERT_EQ(driver.health(), TrackerHealth::live) << driver.trouble_sentence();
  }
  Instant driver_due() const {
    return std::max(clock.now() + Nanos{1}, std::min(driver.next_due(), link.next_event()));
  }

  CirclingTools motion;
  SimulatedClock clock;
  NdiEmulator device;
  SimulatedByteLink cable;
  LinkBetween link;
  NdiDriver driver;
};

}  // namespace orcart::testing
