// In the guest: what is drawn into the panel's buffer is what comes out of the display card, to the pixel.
#include <cstdlib>

#include <gtest/gtest.h>

#include "board/linux/kms/drm_scan_out.hpp"
#include "board/linux/kms/kms_panel.hpp"
#include "firmware-host/files/picture_file.hpp"
#include "tests/hardware/environment.hpp"

namespace orcart::testing {
namespace {

struct Colour {
  std::uint8_t red, green, blue;
};

/// Different in every pixel of a row and of a column, so that a shift, a stride or an order of bytes shows.
Colour colour_at(int x_px, int y_px, int shown) {
  return {.red = static_cast<std::uint8_t>(x_px),
          .green = static_cast<std::uint8_t>(y_px + shown),
          .blue = static_cast<std::uint8_t>((x_px >> 8) * 40 + (y_px >> 8) * 10)};
}

void draw(const ImageDescriptor& image, int shown) {
  for (int y = 0; y < image.height_px; ++y) {
    std::byte* pixel = image.planes[0].data + static_cast<std::size_t>(y) * image.planes[0].stride_bytes;
    for (int x = 0; x < image.width_px; ++x, pixel += 4) {
      const Colour colour = colour_at(x, y, shown);
      pixel[0] = std::byte{colour.blue};
      pixel[1] = std::byte{colour.green};
      pixel[2] = std::byte{colour.red};
      pixel[3] = std::byte{0};
    }
  }
}

int pixels_that_differ(const Picture& picture, int shown) {
  int differ = 0;
  for (int y = 0; y < picture.height_px; ++y) {
    for (int x = 0; x < picture.width_px; ++x) {
      const Colour colour = colour_at(x, y, shown);
      const std::uint8_t* rgba = &picture.rgba[4 * (static_cast<std::size_t>(y) * picture.width_px + x)];
      differ += rgba[0] != colour.red || rgba[1] != colour.green || rgba[2] != colour.blue ? 1 : 0;
    }
  }
  return differ;
}

class PanelPicture : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto card = device_named("ORCART_TEST_PANEL");
    if (!card) GTEST_SKIP() << not_set("ORCART_TEST_PANEL");
    auto scan_out = DrmScanOut::open({.device = *card, .width_px = 1280, .height_px = 800});
    ASSERT_TRUE(scan_out) << scan_out.error().message;
    const auto made = (*scan_out)->make_buffers(PanelBuffers::mapped);
    ASSERT_TRUE(made) << made.error().message;
    auto started = KmsPanel::start(std::move(*scan_out), clock);
    ASSERT_TRUE(started) << word_for(started.error());
    panel = std::move(*started);
  }
  /// Draws, hands over, waits for the flip.
  bool show(int picture) {
    const auto image = panel->acquire();
    if (!image) return false;
    draw(*image, picture);
    if (!panel->present(clock.now())) return false;
    const Instant end = clock.now() + 5s;
    while (clock.now() < end) {
      if (panel->take_flip(clock.now())) return true;
      clock.sleep_until(clock.now() + 2ms);
    }
    return false;
  }

  RealClock clock;
  std::unique_ptr<KmsPanel> panel;
};

TEST_F(PanelPicture, ComesOutOfTheCardToThePixelAndSoDoesTheNext) {
  for (int shown = 0; shown < 4; ++shown) {
    ASSERT_TRUE(show(shown));
    ASSERT_EQ(std::system("vm-host screendump panel.png"), 0);
    const auto picture = read_picture("/vm/panel.png");
    ASSERT_TRUE(picture) << picture.error().message;
    ASSERT_EQ(picture->width_px, 1280);
    ASSERT_EQ(picture->height_px, 800);
    EXPECT_EQ(pixels_that_differ(*picture, shown), 0) << "picture " << shown;
  }
}

}  // namespace
}  // namespace orcart::testing
