// Slices are stacked by what they say of themselves; what is no single volume is refused with its list.
#include <cmath>

#include <gtest/gtest.h>

#include "tools/volume/dicom_slice.hpp"

namespace orcart {
namespace {

DicomSlice slice(double z_mm, const std::string& series = "1.2.3") {
  return {.file = "z" + std::to_string(z_mm) + ".dcm",
          .series = series,
          .columns = 4,
          .rows = 3,
          .has_position = true,
          .position_mm = {-10, -20, z_mm},
          .column_step_mm = 0.5,
          .row_step_mm = 0.75,
          .thickness_mm = 1};
}

std::vector<DicomSlice> slices(std::initializer_list<double> heights_mm) {
  std::vector<DicomSlice> all;
  for (const double z : heights_mm) all.push_back(slice(z));
  return all;
}

Result<DicomStack> chosen(std::vector<DicomSlice> all, int wanted = 0) {
  auto stacks = stack_slices("folder", std::move(all));
  if (!stacks) return tl::unexpected(stacks.error());
  return choose_stack("folder", *std::move(stacks), wanted);
}

void expect_refused(const Result<DicomStack>& stack, const std::string& why) {
  ASSERT_FALSE(stack);
  EXPECT_NE(stack.error().message.find(why), std::string::npos) << stack.error().message;
}

TEST(DicomStacks, SortsByPositionNotByName) {
  const auto stack = chosen(slices({5, 1, 3, 7}));
  ASSERT_TRUE(stack) << stack.error().message;
  EXPECT_EQ(stack->lattice.size, (std::array{4, 3, 4}));
  EXPECT_EQ(stack->lattice.origin_mm, (PlainPoint{-10, -20, 1}));
  EXPECT_EQ(stack->lattice.step_mm[0], (PlainPoint{0.5, 0, 0}));
  EXPECT_EQ(stack->lattice.step_mm[1], (PlainPoint{0, 0.75, 0}));
  EXPECT_EQ(stack->lattice.step_mm[2], (PlainPoint{0, 0, 2}));
  EXPECT_TRUE(stack->notes.empty());
}

TEST(DicomStacks, AnObliqueStackStepsAlongItsNormal) {
  std::vector<DicomSlice> all;
  for (int i = 0; i < 4; ++i) {
    DicomSlice one = slice(0);
    one.along_columns = {0, 0.8, 0.6};
    one.along_rows = {0, -0.6, 0.8};
    one.position_mm = {2.0 * i, 0, 0};
    all.push_back(one);
  }
  const auto stack = chosen(std::move(all));
  ASSERT_TRUE(stack) << stack.error().message;
  EXPECT_EQ(stack->lattice.step_mm[2], (PlainPoint{2, 0, 0}));
}

TEST(DicomStacks, AMissingSliceIsNoticed) {
  expect_refused(chosen(slices({1, 2, 3, 5, 6, 7})), "2 stacks (slices missing between them");
  const auto upper = chosen(slices({1, 2, 3, 5, 6, 7}), 2);
  ASSERT_TRUE(upper);
  EXPECT_EQ(upper->lattice.origin_mm[2], 5);
  expect_refused(chosen(slices({1, 2, 3, 5, 6, 7}), 3), "with N up to 2");
}

TEST(DicomStacks, TwoSeriesAreListedAndOneMayBeTaken) {
  auto all = slices({1, 2, 3});
  for (const double z : {1, 2, 3, 4}) all.push_back(slice(z, "9.8.7"));
  expect_refused(chosen(all), "1: 4 slices 1 mm apart, from 1 to 4 mm along their normal, series ...9.8.7");
  const auto larger = chosen(all, 1);
  ASSERT_TRUE(larger);
  EXPECT_EQ(larger->slices.front().series, "9.8.7");
}

TEST(DicomStacks, ALocalizerIsLeftOut) {
  auto all = slices({1, 2, 3});
  DicomSlice localizer = slice(2);
  localizer.along_rows = {0, 0, -1};
  all.push_back(localizer);
  const auto stack = chosen(all);
  ASSERT_TRUE(stack) << stack.error().message;
  EXPECT_EQ(stack->slices.size(), 3U);
  EXPECT_EQ(stack->notes.size(), 1U);
}

TEST(DicomStacks, TwoEchoesAreTwoStacksAndTheSameTwiceIsRefused) {
  auto all = slices({1, 2, 3});
  for (DicomSlice one : slices({1, 2, 3})) {
    one.variant = "echo 2";
    all.push_back(one);
  }
  expect_refused(chosen(all), "(echo 2)");
  auto twice = slices({1, 2, 3, 2});
  expect_refused(chosen(twice), "lie at the same place and nothing in them says why");
}

TEST(DicomStacks, ASecondCopyOfAnImageIsLeftOutAndTold) {
  auto all = slices({1, 2, 3});
  for (DicomSlice& one : all) one.instance = "1.2.3." + std::to_string(one.position_mm[2]);
  all.push_back(all[1]);
  all.back().file = "Copy of z2.dcm";
  const auto stack = chosen(all);
  ASSERT_TRUE(stack) << stack.error().message;
  EXPECT_EQ(stack->slices.size(), 3U);
  EXPECT_NE(stack->notes.at(0).find("1 images are in the folder twice"), std::string::npos);
  for (DicomSlice& one : all) one.instance = "0";  // an anonymiser's
  EXPECT_EQ(chosen(all)->slices.size(), 3U);
}

TEST(DicomStacks, AcquisitionsThatGoOnWhereTheLastEndedAreOneVolume) {
  auto steps = slices({1, 2, 3, 4, 5});
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i].acquisition = std::to_string(10 - i);
  const auto one = chosen(steps);
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->slices.size(), 5U);
  auto twice = slices({1, 3, 5, 2, 4, 6});  // interleaved: before and after contrast
  for (std::size_t i = 0; i < twice.size(); ++i) twice[i].acquisition = i < 3 ? "1" : "2";
  expect_refused(chosen(twice), "(acquisition 1)");
}

TEST(DicomStacks, TwoPatientsAreRefused) {
  auto all = slices({1, 2, 3});
  all[1].patient = 7;
  expect_refused(chosen(all), "images of 2 patients; the images of one are expected");
}

TEST(DicomStacks, ASliceWithoutAPlaceIsLeftOutAndToldUnlessNothingIsLeft) {
  auto all = slices({1, 2, 3});
  all[2].has_position = false;
  const auto stack = chosen(all);
  ASSERT_TRUE(stack) << stack.error().message;
  EXPECT_EQ(stack->slices.size(), 2U);
  ASSERT_EQ(stack->notes.size(), 1U);
  EXPECT_NE(stack->notes[0].find("1 images that do not say where they lie"), std::string::npos);
  for (DicomSlice& one : all) one.has_position = false;
  expect_refused(chosen(all), "z1.000000.dcm: states no ImagePositionPatient");
}

TEST(DicomStacks, TwoSpacingsInOneSeriesAreRefused) {
  std::vector<DicomSlice> few_thin, few_thick;
  for (int i = 0; i < 12; ++i) few_thin.push_back(slice(2.5 * i));
  for (int i = 1; i <= 20; ++i) few_thin.push_back(slice(27.5 + 5 * i));
  expect_refused(chosen(few_thin), "its slices are 2.5 mm to 5 mm apart");
  expect_refused(chosen(few_thin, 1), "stack 1: its slices are 2.5 mm to 5 mm apart");
  for (int i = 0; i < 30; ++i) few_thick.push_back(slice(2.5 * i));
  for (int i = 1; i <= 15; ++i) few_thick.push_back(slice(72.5 + 5 * i));
  expect_refused(chosen(few_thick), "is no single volume but 16 stacks (slices missing between them");
  EXPECT_EQ(chosen(few_thick, 1)->slices.size(), 30U);
}

TEST(DicomStacks, ALoneImageOfTheSeriesBeyondAGapIsNotLeftOut) {
  expect_refused(chosen(slices({1, 2, 3, 9})), "2 stacks (slices missing between them");
}

TEST(DicomStacks, ASeriesThatIsNoVolumeHindersNoOther) {
  auto all = slices({1, 2, 3});
  for (const double z : {1, 5, 9, 1, 5, 9}) all.push_back(slice(z, "9.8.7"));
  const auto stack = chosen(all);
  ASSERT_TRUE(stack) << stack.error().message;
  EXPECT_EQ(stack->slices.size(), 3U);
  ASSERT_EQ(stack->notes.size(), 1U);
  EXPECT_NE(stack->notes[0].find("6 images of another series were left out: z1.0"), std::string::npos)
      << stack->notes[0];
  EXPECT_TRUE(chosen(all, 2));
  expect_refused(chosen(all, 1), "stack 1: z1.000000.dcm and z1.000000.dcm lie at the same place");
}

TEST(DicomStacks, ATiltedGantryIsKeptAndTold) {
  std::vector<DicomSlice> all;
  for (int i = 0; i < 5; ++i) {
    all.push_back(slice(2.0 * i));
    all.back().position_mm[1] += 0.5 * i;
  }
  const auto stack = chosen(std::move(all));
  ASSERT_TRUE(stack);
  EXPECT_EQ(stack->lattice.step_mm[2], (PlainPoint{0, 0.5, 2}));
  ASSERT_EQ(stack->notes.size(), 1U);
  EXPECT_NE(stack->notes[0].find("leans by 14"), std::string::npos) << stack->notes[0];
}

TEST(DicomStacks, UnevenSpacingIsTold) {
  const auto stack = chosen(slices({0, 2, 4.2, 6, 8}));
  ASSERT_TRUE(stack);
  ASSERT_EQ(stack->notes.size(), 1U);
  EXPECT_NE(stack->notes[0].find("up to 0.2 mm from an even spacing of 2 mm"), std::string::npos);
}

TEST(DicomStacks, ALoneImageIsNoVolume) {
  expect_refused(chosen(slices({1})), "none beside another; a stack of slices is expected");
}

}  // namespace
}  // namespace orcart
