// What a connector's modes come to, from timings as panels state them.
#include "board/linux/kms/drm_card.hpp"

#include <array>

#include <drm_mode.h>
#include <gtest/gtest.h>

namespace orcart {
namespace {

drmModeModeInfo full_hd(std::uint32_t flags = 0) {
  drmModeModeInfo mode{};
  mode.clock = 148500;  // kHz; CTA-861 format 16
  mode.htotal = 2200;
  mode.vtotal = 1125;
  mode.vrefresh = 60;
  mode.flags = flags;
  return mode;
}

TEST(DrmCard, TellsTheRefreshByTheTimings) {
  EXPECT_DOUBLE_EQ(refresh_of(full_hd()), 60);
  EXPECT_DOUBLE_EQ(refresh_of(full_hd(DRM_MODE_FLAG_DBLSCAN)), 30) << "each line is shown twice";
  drmModeModeInfo ntsc = full_hd();
  ntsc.clock = 148352;
  EXPECT_NEAR(refresh_of(ntsc), 59.94, 1e-3);
  drmModeModeInfo untold = full_hd();
  untold.clock = 0;
  untold.vrefresh = 50;
  EXPECT_EQ(refresh_of(untold), 50);
}

TEST(DrmCard, LeavesInterlacedModesOutAndKeepsTheOrder) {
  std::array modes{full_hd(DRM_MODE_FLAG_INTERLACE), full_hd(), full_hd(DRM_MODE_FLAG_INTERLACE), full_hd()};
  modes[1].hdisplay = 1920;
  modes[3].hdisplay = 1280;
  drmModeConnector connector{};
  connector.count_modes = static_cast<int>(modes.size());
  connector.modes = modes.data();
  const auto usable = usable_modes(connector);
  ASSERT_EQ(usable.size(), 2u);
  EXPECT_EQ(usable[0].hdisplay, 1920);
  EXPECT_EQ(usable[1].hdisplay, 1280);
}

}  // namespace
}  // namespace orcart
