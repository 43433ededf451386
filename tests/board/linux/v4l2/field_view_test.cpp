// Fields by hand: where their lines lie and when they were taken.
#include "board/linux/v4l2/field_view.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

const ImageDescriptor kWhole = packed_image(nullptr, PixelFormat::nv12, 8, 4);

TEST(FieldView, TakesEverySecondLineOfAWovenPicture) {
  const auto bottom = field_of(kWhole, FieldLayout::woven_top_first, FieldChoice::bottom);
  EXPECT_EQ(bottom.height_px, 2);
  EXPECT_EQ(bottom.planes[0].offset_bytes, 8u);
  EXPECT_EQ(bottom.planes[0].stride_bytes, 16u);
  EXPECT_EQ(bottom.planes[1].offset_bytes, 32u + 8u) << "chroma lines belong to fields too";
  EXPECT_EQ(bottom.planes[1].stride_bytes, 16u);
  EXPECT_EQ(field_of(kWhole, FieldLayout::woven_bottom_first, FieldChoice::top).planes[0].offset_bytes, 0u)
      << "the top field's lines are the even ones, whichever is older";
}

TEST(FieldView, TakesOneHalfOfAStackedPicture) {
  const auto top = field_of(kWhole, FieldLayout::stacked_bottom_first, FieldChoice::top);
  EXPECT_EQ(top.height_px, 2);
  EXPECT_EQ(top.planes[0].offset_bytes, 16u);
  EXPECT_EQ(top.planes[0].stride_bytes, 8u);
  EXPECT_EQ(top.planes[1].offset_bytes, 32u + 8u);
}

TEST(FieldView, LeavesWholePicturesAndSingleFieldsAlone) {
  for (const FieldLayout layout : {FieldLayout::whole, FieldLayout::one_at_a_time}) {
    const auto same = field_of(kWhole, layout, FieldChoice::bottom);
    EXPECT_EQ(same.height_px, 4);
    EXPECT_EQ(same.planes[0].offset_bytes, 0u);
    EXPECT_EQ(field_delay(layout, FieldChoice::bottom, StampedAt::end_of_frame, 40ms), 0ns);
  }
}

TEST(FieldView, MovesTheStampByHalfAFrameWhereItIsTheOtherFields) {
  const auto delay = [](FieldChoice field, StampedAt at) {
    return field_delay(FieldLayout::woven_top_first, field, at, 40ms);
  };
  EXPECT_EQ(delay(FieldChoice::top, StampedAt::end_of_frame), -20ms);
  EXPECT_EQ(delay(FieldChoice::bottom, StampedAt::end_of_frame), 0ms);
  EXPECT_EQ(delay(FieldChoice::top, StampedAt::start_of_exposure), 0ms);
  EXPECT_EQ(delay(FieldChoice::bottom, StampedAt::start_of_exposure), 20ms);
}

}  // namespace
}  // namespace orcart
