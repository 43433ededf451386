// Pictures of every size come back as they were, and damage is noticed.
#include "firmware-host/session/picture_bytes.hpp"

#include <gtest/gtest.h>

#include "tests/firmware-host/session/session_samples.hpp"

namespace orcart {
namespace {

TEST(PictureBytes, ComeBackAsTheyWere) {
  for (const int height_px : {1, 2, 100, 512, 513}) {
    const auto bytes = testing::picture_bytes(7, 64, height_px);
    std::vector<std::byte> buffer;
    const auto back = inflated(deflated(bytes, buffer), bytes.size());
    ASSERT_TRUE(back) << height_px;
    EXPECT_EQ(*back, bytes) << height_px;
  }
}

TEST(PictureBytes, ShrinkWhereNeighboursAreAlike) {
  std::vector<std::byte> ramp(packed_bytes(PixelFormat::yuyv, 256, 64));
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<std::byte>(i / 4);
  std::vector<std::byte> buffer;
  EXPECT_LT(deflated(ramp, buffer).size(), ramp.size() / 6);
}

TEST(PictureBytes, AreRefusedWhereAByteIsWrongOrMissing) {
  const auto bytes = testing::picture_bytes(7);
  std::vector<std::byte> buffer;
  const auto whole = deflated(bytes, buffer);
  EXPECT_FALSE(inflated(whole.first(whole.size() - 1), bytes.size()));
  EXPECT_FALSE(inflated(whole, bytes.size() - 1));
  EXPECT_FALSE(inflated(whole, bytes.size() + 1));
  EXPECT_FALSE(inflated({}, bytes.size()));
  buffer[whole.size() / 2] ^= std::byte{0x10};
  EXPECT_FALSE(inflated(whole, bytes.size()));
}

}  // namespace
}  // namespace orcart
