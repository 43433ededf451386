// What is found below a made-up root, and how it is told.
#include "tools/probe/machine_probe.hpp"

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/board/linux/v4l2/scripted_camera_device.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tools/probe/device_probe.hpp"

namespace orcart::testing {
namespace {

class MachineProbe : public ::testing::Test {
 protected:
  void put(const std::string& file, const std::string& text) const {
    const auto path = root_ / file;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text << "\n";
  }
  std::filesystem::path root() const { return (root_ / "x").parent_path(); }

 private:
  TemporaryFolder root_;
};

TEST_F(MachineProbe, FindsTrackersByTheirUsbIds) {
  put("sys/bus/usb/devices/1-2/idVendor", "0403");
  put("sys/bus/usb/devices/1-2/idProduct", "da70");
  put("sys/bus/usb/devices/1-2/serial", "P6-00123");
  put("sys/bus/usb/devices/1-3/idVendor", "046d");
  put("sys/bus/usb/devices/1-3/idProduct", "c31c");
  const auto found = probe_trackers(root());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "NDI Host USB Converter");
  EXPECT_EQ(found[0].details[0], "USB 0403:da70, port = \"1-2\", serial = \"P6-00123\"");
  EXPECT_EQ(found[0].lack, "");
}

TEST_F(MachineProbe, KnowsEveryTrackerAndBridgeThatTheCartOpens) {
  put("sys/bus/usb/devices/1-2/idVendor", "0403");
  put("sys/bus/usb/devices/1-2/idProduct", "6015");
  put("sys/bus/usb/devices/1-3/idVendor", "23f2");
  put("sys/bus/usb/devices/1-3/idProduct", "0004");
  const auto found = probe_trackers(root());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].name, "FTDI FT-X (a serial bridge, perhaps a tracker's)");
  EXPECT_EQ(found[0].details[0], "USB 0403:6015, port = \"1-2\"");
  EXPECT_EQ(found[1].name, "NDI tracker");
}

TEST_F(MachineProbe, SaysWhatToDoWhereThereIsNoTracker) {
  const auto found = probe_trackers(root());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].lack, "");
  EXPECT_NE(found[0].next, "");
}

TEST_F(MachineProbe, IsContentWithACart) {
  put("proc/sys/kernel/osrelease", "6.1.0-40-rt-amd64");
  put("sys/kernel/realtime", "1");
  put("sys/devices/system/cpu/isolated", "2-3");
  put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
  const auto found = probe_system(root(), {.locked_memory_bytes = ~0ULL, .fifo = true});
  EXPECT_EQ(ProbeReport{found}.lacks(), 0u);
  EXPECT_EQ(found[0].name, "kernel 6.1.0-40-rt-amd64");
  EXPECT_EQ(found[0].details[0], "PREEMPT_RT");
}

TEST_F(MachineProbe, NamesEachLackOfAnOrdinaryMachineWithOneRemedy) {
  put("proc/sys/kernel/osrelease", "6.1.0-40-amd64");
  put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave");
  const auto found = probe_system(root(), {.locked_memory_bytes = 8U << 20, .fifo = false});
  EXPECT_EQ(ProbeReport{found}.lacks(), 4u);
  for (const Finding& finding : found) EXPECT_EQ(finding.lack.empty(), finding.next.empty());
}

TEST_F(MachineProbe, TakesRootForWhatItIs) {
  put("sys/kernel/realtime", "1");
  EXPECT_EQ(ProbeReport{probe_system(root(), {.fifo = true, .root = true})}.lacks(), 0u);
  const auto contained = probe_system(root(), {.root = true});
  EXPECT_EQ(ProbeReport{contained}.lacks(), 1u) << "a container may refuse SCHED_FIFO to root";
  EXPECT_NE(contained.back().next.find("cpu.rt_runtime_us"), std::string::npos);
}

TEST(ProbeReport, TellsLacksWithTheirRemediesAndEscapesNames) {
  const ProbeReport report{{{.area = "camera", .name = "/dev/video0 \"X\"\n", .details = {"yuyv: 640x480"}},
                            {.area = "panel", .lack = "no panel", .next = "plug one in"}}};
  EXPECT_NE(text_of(report).find("1. panel: no panel\n     do: plug one in"), std::string::npos);
  EXPECT_EQ(
      json_of(report),
      "{\"lacks\": 1, \"findings\": [{\"area\": \"camera\", \"name\": \"/dev/video0 \\\"X\\\"\\u000a\", "
      "\"details\": [\"yuyv: 640x480\"], \"lack\": \"\", \"next\": \"\"}, {\"area\": \"panel\", \"name\": "
      "\"\", \"details\": [], \"lack\": \"no panel\", \"next\": \"plug one in\"}]}\n");
}

TEST(DeviceProbe, NamesACameraOfSeveralPlanesAsALackAndPassesOverWhatIsNone) {
  SimulatedClock clock;
  ScriptedCameraDevice device(clock);
  device.capabilities = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
  const auto planes = probe_camera(device, "/dev/video0");
  ASSERT_TRUE(planes);
  EXPECT_EQ(planes->lack, "/dev/video0 captures in several planes only, which orcart does not read");
  EXPECT_EQ(planes->next, "a grabber that uvcvideo drives would do");
  device.capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  EXPECT_FALSE(probe_camera(device, "/dev/video1")) << "a camera's second node";
  device.capabilities = V4L2_CAP_VIDEO_M2M_MPLANE | V4L2_CAP_STREAMING;
  EXPECT_FALSE(probe_camera(device, "/dev/video2")) << "a codec";
  device.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  const auto whole = probe_camera(device, "/dev/video3");
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->lack, "");
}

TEST(DeviceProbe, FindsOrMissesEveryKindOnThisMachine) {
  for (const auto& found : {probe_cameras(), probe_pedals(), probe_panels()}) {
    ASSERT_FALSE(found.empty());
    for (const Finding& finding : found) EXPECT_EQ(finding.lack.empty(), finding.next.empty());
  }
}

}  // namespace
}  // namespace orcart::testing
