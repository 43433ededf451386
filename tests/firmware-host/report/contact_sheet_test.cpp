// The contact sheet: area averages, rows and columns where they belong.
#include "firmware-host/report/contact_sheet.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

Picture plain(int width_px, int height_px, std::uint8_t grey) {
  Picture picture;
  picture.width_px = width_px;
  picture.height_px = height_px;
  picture.rgba.assign(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * 4, grey);
  return picture;
}

std::uint8_t red_at(const Picture& p, int x, int y) {
  return p.rgba[4 * static_cast<std::size_t>(y * p.width_px + x)];
}

TEST(ContactSheet, AveragesTheAreaBehindEachPixel) {
  Picture half = plain(4, 4, 0);
  for (std::size_t i = 0; i < half.rgba.size(); i += 8) half.rgba[i] = 200;  // every other pixel's red
  const Picture sheet = contact_sheet({half}, {.columns = 1, .thumb_width_px = 2, .gap_px = 0});
  ASSERT_EQ(sheet.width_px, 2);
  EXPECT_EQ(red_at(sheet, 0, 0), 100);
}

TEST(ContactSheet, FillsRowsInOrderWithGaps) {
  const Picture sheet = contact_sheet({plain(8, 4, 10), plain(8, 4, 90), plain(8, 8, 170)},
                                      {.columns = 2, .thumb_width_px = 4, .gap_px = 1});
  EXPECT_EQ(sheet.width_px, 2 * 5 + 1);
  EXPECT_EQ(sheet.height_px, 1 + 2 + 1 + 4 + 1);
  EXPECT_EQ(red_at(sheet, 1, 1), 10);
  EXPECT_EQ(red_at(sheet, 6, 1), 90);
  EXPECT_EQ(red_at(sheet, 1, 4), 170);
  EXPECT_EQ(red_at(sheet, 0, 0), 24);
}

TEST(ContactSheet, OfNothingIsNothing) {
  EXPECT_EQ(contact_sheet({}, {}).width_px, 0);
}

}  // namespace
}  // namespace orcart
