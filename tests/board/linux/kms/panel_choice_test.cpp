// Connectors and modes: chosen, or refused with what there is; events and turned pictures by hand.
#include "board/linux/kms/panel_choice.hpp"

#include <cstring>

#include <drm.h>
#include <gtest/gtest.h>

#include "board/linux/kms/flip_events.hpp"
#include "board/linux/kms/turned_copy.hpp"

namespace orcart {
namespace {

const std::vector<DisplayConnector> kCard{{.id = 1, .name = "DP-1", .connected = false, .modes = {}},
                                          {.id = 2,
                                           .name = "HDMI-A-1",
                                           .connected = true,
                                           .modes = {{1280, 800, 59.8, false},
                                                     {1920, 1080, 60, true},
                                                     {1920, 1080, 50, false},
                                                     {1920, 1080, 75, false}}}};

std::string refusal(const PanelWish& wish, const std::vector<DisplayConnector>& offered = kCard) {
  const auto choice = choose(wish, offered);
  return choice ? "" : choice.error().message;
}

TEST(PanelChoice, TakesTheConnectedPanelAndItsPreferredMode) {
  const auto choice = choose({.device = "/dev/dri/card0"}, kCard);
  ASSERT_TRUE(choice);
  EXPECT_EQ(choice->connector, 1u);
  EXPECT_EQ(choice->mode, 1u);
}

TEST(PanelChoice, TakesTheFastestOfASizeOrTheNearestToARefresh) {
  EXPECT_EQ(choose({.width_px = 1920, .height_px = 1080}, kCard)->mode, 3u);
  EXPECT_EQ(choose({.width_px = 1920, .height_px = 1080, .refresh_hz = 50}, kCard)->mode, 2u);
  EXPECT_EQ(choose({.width_px = 1280, .height_px = 800, .refresh_hz = 60}, kCard)->mode, 0u);
}

TEST(PanelChoice, LooksForTheTurnedModeOfATurnedPanel) {
  EXPECT_EQ(choose({.width_px = 800, .height_px = 1280, .rotation = Rotation::quarter}, kCard)->mode, 0u);
  EXPECT_NE(refusal({.width_px = 800, .height_px = 1280, .rotation = Rotation::half}), "");
}

TEST(PanelChoice, RefusesWithWhatThereIs) {
  EXPECT_EQ(refusal({.device = "/dev/dri/card0", .connector = "VGA-1"}),
            "panel connector VGA-1 is not on /dev/dri/card0; it has DP-1, HDMI-A-1");
  EXPECT_NE(refusal({.connector = "DP-1"}).find("has no panel"), std::string::npos);
  EXPECT_NE(refusal({.width_px = 1280, .height_px = 800, .refresh_hz = 75}).find("1280x800 at 59.8 Hz"),
            std::string::npos);
  EXPECT_NE(refusal({}, {kCard[0]}).find("no panel is connected"), std::string::npos);
}

std::vector<std::byte> flip_event(std::uint64_t serial, std::uint32_t type = DRM_EVENT_FLIP_COMPLETE) {
  drm_event_vblank event{};
  event.base = {.type = type, .length = sizeof event};
  event.user_data = serial;
  event.tv_sec = 2;
  event.tv_usec = 500'000;
  std::vector<std::byte> bytes(sizeof event);
  std::memcpy(bytes.data(), &event, sizeof event);
  return bytes;
}

TEST(FlipEvents, ReadsSerialAndInstantAndGoesOn) {
  auto bytes = flip_event(7);
  const auto more = flip_event(8);
  bytes.insert(bytes.end(), more.begin(), more.end());
  std::span<const std::byte> rest(bytes);
  const auto first = take_flip_event(rest), second = take_flip_event(rest);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->serial, 7u);
  EXPECT_EQ(first->at, instant_from_nanos(2'500'000'000));
  EXPECT_EQ(second->serial, 8u);
  EXPECT_TRUE(rest.empty());
}

TEST(FlipEvents, SkipsOtherEventsAndSurvivesAnyCut) {
  auto bytes = flip_event(1, DRM_EVENT_VBLANK);
  const auto flip = flip_event(2);
  bytes.insert(bytes.end(), flip.begin(), flip.end());
  std::span<const std::byte> rest(bytes);
  EXPECT_FALSE(take_flip_event(rest));
  EXPECT_EQ(take_flip_event(rest)->serial, 2u);
  for (std::size_t length = 0; length < flip.size(); ++length) {
    std::span<const std::byte> cut(flip.data(), length);
    EXPECT_FALSE(take_flip_event(cut));
    EXPECT_TRUE(cut.empty()) << "nothing is left to loop over";
  }
  std::vector<std::byte> zeros(64);
  std::span<const std::byte> endless(zeros);
  EXPECT_FALSE(take_flip_event(endless));
  EXPECT_TRUE(endless.empty()) << "a length of 0 would never end";
}

/// A picture of 3 x 2 pixels 0..5 seen on a panel that is turned by `rotation`.
std::vector<std::uint32_t> turned(Rotation rotation, int panel_width, int panel_height) {
  std::vector<std::uint32_t> picture{0, 1, 2, 3, 4, 5}, panel(6, 99);
  copy_turned(packed_image(reinterpret_cast<std::byte*>(picture.data()), PixelFormat::xrgb8888, 3, 2),
              packed_image(reinterpret_cast<std::byte*>(panel.data()), PixelFormat::xrgb8888, panel_width,
                           panel_height),
              rotation);
  return panel;
}

TEST(TurnedCopy, PutsThePictureUprightOnATurnedPanel) {
  EXPECT_EQ(turned(Rotation::none, 3, 2), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(turned(Rotation::half, 3, 2), (std::vector<std::uint32_t>{5, 4, 3, 2, 1, 0}));
  // Turned clockwise, the panel's first row is what one sees as the right column, from top to bottom.
  EXPECT_EQ(turned(Rotation::quarter, 2, 3), (std::vector<std::uint32_t>{2, 5, 1, 4, 0, 3}));
  EXPECT_EQ(turned(Rotation::three_quarters, 2, 3), (std::vector<std::uint32_t>{3, 0, 4, 1, 5, 2}));
}

}  // namespace
}  // namespace orcart
