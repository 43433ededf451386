// [camera], [pedal] and [panel]: each kind's keys are read, the other kind's are refused, and mixed carts say
// what they are.
#include "firmware-host/app/device_config.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "firmware-host/app/cart.hpp"
#include "firmware-host/app/device_log.hpp"
#include "tests/firmware-host/app/demo_cart.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart::testing {
namespace {

/// The demo's cart with another [camera] and with more sections behind it; its files stay where they are.
Result<CartConfig> cart_with(const std::string& camera, const std::string& more = "") {
  std::string text = text_of(demo_cart());
  const auto begin = text.find("[camera]"), end = text.find("[panel]");
  if (!camera.empty()) text.replace(begin, end - begin, "[camera]\n" + camera + "\n");
  const TemporaryFolder folder;
  return read_cart(folder.write("cart.toml", text + "\n" + more + "\n"));
}

std::string complaint(const std::string& camera, const std::string& more = "") {
  const auto config = cart_with(camera, more);
  return config ? "" : config.error().message;
}

TEST(DeviceConfig, ReadsACameraOfTheKernel) {
  const auto config = cart_with(
      "kind = \"v4l2\"\ndevice = \"/dev/video3\"\nwidth_px = 720\nheight_px = 288\nrate_hz = 25\n"
      "format = \"uyvy\"\nfield = \"top\"\nstamp = \"end_of_readout\"\nafter_exposure_ms = 20\n"
      "controls = [\"auto_exposure=1\", \"gain=-4\"]");
  ASSERT_TRUE(config) << config.error().message;
  const CameraConfig& camera = config->camera;
  EXPECT_EQ(camera.kind, CameraKind::v4l2);
  EXPECT_EQ(camera.format, PixelFormat::uyvy);
  EXPECT_EQ(camera.device.device, "/dev/video3");
  EXPECT_EQ(camera.device.height_px, 288);
  EXPECT_EQ(camera.device.field, FieldChoice::top);
  EXPECT_EQ(camera.stamp, StampMeaning::end_of_readout);
  EXPECT_EQ(camera.after_exposure_ms, 20);
  ASSERT_EQ(camera.device.controls.size(), 2u);
  EXPECT_EQ(camera.device.controls[1].name, "gain");
  EXPECT_EQ(camera.device.controls[1].value, -4);
  EXPECT_TRUE(config->simulated()) << "its tracker still is";
}

TEST(DeviceConfig, DecodesMotionJpegIntoRgba) {
  const auto config =
      cart_with("kind = \"v4l2\"\ndevice = \"/dev/video0\"\nformat = \"mjpeg\"\nstamp = \"dequeued\"");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->camera.format, PixelFormat::rgba8888);
}

TEST(DeviceConfig, WantsToBeToldWhatARealCamerasStampMeans) {
  EXPECT_NE(complaint("kind = \"v4l2\"\ndevice = \"/dev/video0\"").find("stamp"), std::string::npos);
}

TEST(DeviceConfig, RefusesKeysOfAnotherKindAndWrongValues) {
  EXPECT_NE(complaint("kind = \"simulated\"\ndevice = \"/dev/video0\"").find("device"), std::string::npos);
  const std::string real = "kind = \"v4l2\"\ndevice = \"/dev/video0\"\nstamp = \"dequeued\"\n";
  EXPECT_NE(complaint(real + "controls = [\"gain\"]").find("NAME=NUMBER"), std::string::npos);
  EXPECT_NE(complaint(real + "controls = [\"gain=loud\"]").find("gain=loud"), std::string::npos);
  EXPECT_NE(complaint(real + "format = \"mjpeg\"\nfield = \"top\"").find("progressive"), std::string::npos);
  EXPECT_NE(complaint("", "[pedal]\nkind = \"gpio\"\nchip = \"gpiochip0\"").find("line"), std::string::npos);
  EXPECT_NE(complaint("", "[pedal]\nkind = \"keyboard\"\ndevice = \"/dev/input/event1\"\nkey = \"foot\"")
                .find("space"),
            std::string::npos);
}

TEST(DeviceConfig, ReadsPedals) {
  const auto gpio =
      cart_with("",
                "[pedal]\nkind = \"gpio\"\nchip = \"cart\"\nline = \"pedal\"\nbias = \"pull_up\"\n"
                "pressed = \"low\"\ntrigger_line = \"5\"");
  ASSERT_TRUE(gpio) << gpio.error().message;
  EXPECT_EQ(gpio->pedal.gpio.bias, LineBias::pull_up);
  EXPECT_EQ(gpio->pedal.gpio.pressed, ActiveLevel::low);
  EXPECT_EQ(gpio->pedal.gpio.trigger_line, "5");
  EXPECT_TRUE(gpio->any_device());
  const auto keyboard =
      cart_with("", "[pedal]\nkind = \"keyboard\"\ndevice = \"/dev/input/by-id/pedal\"\nkey = \"f13\"");
  ASSERT_TRUE(keyboard) << keyboard.error().message;
  EXPECT_EQ(keyboard->pedal.keyboard.key, "f13");
  EXPECT_EQ(cart_with("")->pedal.kind, PedalKind::simulated);
  EXPECT_FALSE(cart_with("")->any_device());
}

TEST(DeviceConfig, ReadsAPanel) {
  std::string text = text_of(demo_cart());
  const std::string panel =
      "[panel]\ndevice = \"/dev/dri/card1\"\nconnector = \"HDMI-A-1\"\ntty = \"/dev/tty7\"\n"
      "rotation_deg = 90\nbuffers = \"mapped\"\n";
  text.replace(text.find("[panel]\n"), 8, panel);
  const TemporaryFolder folder;
  const auto config = read_cart(folder.write("cart.toml", text));
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->panel.device.connector, "HDMI-A-1");
  EXPECT_EQ(config->panel.device.rotation, Rotation::quarter);
  EXPECT_EQ(config->panel.device.width_px, 1280);
  EXPECT_EQ(config->panel.buffers, PanelBuffersWish::mapped);
  text = replaced(text, "rotation_deg = 90", "rotation_deg = 45");
  const auto refused = read_cart(folder.write("cart.toml", text));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("180"), std::string::npos);
}

TEST(DeviceConfig, RefusesAScriptedPedalBesideRealDevicesAndTakesNone) {
  std::string text = text_of(demo_cart());
  text =
      replaced(text, "kind = \"simulated\"\nrate_hz", "kind = \"tty\"\ndevice = \"/dev/ttyUSB0\"\nrate_hz");
  const auto begin = text.find("[camera]"), end = text.find("[panel]");
  ASSERT_NE(begin, std::string::npos);
  text.replace(begin, end - begin,
               "[camera]\nkind = \"v4l2\"\ndevice = \"/dev/video0\"\nstamp = \"dequeued\"\n");
  const TemporaryFolder folder;
  const auto refused = read_cart(folder.write("cart.toml", text));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("gpio, keyboard or none"), std::string::npos)
      << refused.error().message;
  const auto real = read_cart(folder.write("cart.toml", text + "\n[pedal]\nkind = \"none\"\n"));
  ASSERT_TRUE(real) << real.error().message;
  EXPECT_FALSE(real->simulated());
  EXPECT_TRUE(real->any_device());
}

TEST(DeviceLog, SaysOnceThatADeviceIsGoneAndOnceThatItIsBack) {
  DeviceLog log;
  EXPECT_EQ(log.news({}), "");
  const std::string gone = log.news({.camera = PortFault::disconnected});
  EXPECT_NE(gone.find("camera: disconnected"), std::string::npos);
  EXPECT_EQ(log.news({.camera = PortFault::disconnected}), "");
  EXPECT_EQ(log.news({}), "camera: works again\n");
}

TEST(DeviceConfig, OfAMistypedKindComplainsOnceAndOfNoneOfItsKeys) {
  const std::string camera =
      "kind = \"v4l\"\ndevice = \"/dev/video3\"\nstamp = \"dequeued\"\nfield = \"top\"";
  const std::string pedal = "[pedal]\nkind = \"gpi\"\nchip = \"gpiochip0\"\nline = \"4\"";
  for (const std::string& words : {complaint(camera), complaint("", pedal)}) {
    EXPECT_EQ(std::count(words.begin(), words.end(), '\n'), 0) << words;
    EXPECT_NE(words.find("] kind is \""), std::string::npos) << words;
  }
}

}  // namespace
}  // namespace orcart::testing
