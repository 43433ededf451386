// An enhanced multi-frame file is the volume that its frames would be as classic slices, or one clear
// sentence.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "tests/tools/volume/enhanced_sample.hpp"
#include "tools/volume/volume_reader.hpp"

namespace orcart {
namespace {

Result<Volume> read(const std::string& bytes, int stack = 0) {
  const TemporaryFolder folder;
  return read_volume({.path = folder.write("enhanced.dcm", bytes), .stack = stack});
}

Result<Volume> classic(int count) {
  const TemporaryFolder folder;
  write_series(folder, count);
  return read_volume({.path = folder / ""});
}

void expect_same(const Result<Volume>& one, const Result<Volume>& other) {
  ASSERT_TRUE(one) << one.error().message;
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ(one->lattice.size, other->lattice.size);
  EXPECT_EQ(one->lattice.origin_mm, other->lattice.origin_mm);
  EXPECT_EQ(one->lattice.step_mm, other->lattice.step_mm);
  EXPECT_EQ(one->values, other->values);
  EXPECT_EQ(one->kind, other->kind);
  EXPECT_EQ(one->series, other->series);
  EXPECT_EQ(one->frame_of_reference, other->frame_of_reference);
  EXPECT_EQ(one->notes, other->notes);
}

void expect_refused(const Result<Volume>& volume, const std::string& why) {
  ASSERT_FALSE(volume);
  EXPECT_NE(volume.error().message.find(why), std::string::npos) << volume.error().message;
}

TEST(DicomFrames, AreTheVolumeThatTheirClassicSlicesAre) {
  expect_same(read(enhanced_series(3).bytes()), classic(3));
  const TemporaryFolder folder;
  folder.write("enhanced.dcm", enhanced_series(3).bytes());
  expect_same(read_volume({.path = folder / ""}), classic(3));
}

TEST(DicomFrames, MayComeInAnyOrder) {
  EnhancedSample sample = enhanced_series(5);
  std::swap(sample.frames[0], sample.frames[3]);
  std::swap(sample.frames[1], sample.frames[4]);
  expect_same(read(sample.bytes()), classic(5));
}

TEST(DicomFrames, MayLieInSequencesWithoutALength) {
  EnhancedSample sample = enhanced_series(3);
  sample.open_ended_groups = true;
  expect_same(read(sample.bytes()), classic(3));
}

TEST(DicomFrames, MayBeCompressedEachByItself) {
  EnhancedSample sample = enhanced_series(3);
  sample.run_length = true;
  std::swap(sample.frames[0], sample.frames[2]);
  expect_same(read(sample.bytes()), classic(3));
}

TEST(DicomFrames, EachHasItsOwnRescaling) {
  EnhancedSample sample = enhanced_series(3);
  sample.frames[1].slope = "0.5";
  sample.frames[1].intercept = "7";
  const auto volume = read(sample.bytes());
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->values[0], -1000);
  EXPECT_EQ(volume->values[13], 57.5F);  // pixel 101
  EXPECT_EQ(volume->values[24], -600);
}

TEST(DicomFrames, WhatAFrameSaysItselfGoesBeforeWhatAllShare) {
  EnhancedSample sample = enhanced_series(3);
  for (EnhancedFrame& frame : sample.frames) frame.spacing = "1.5\\1.25";
  const auto volume = read(sample.bytes());
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->lattice.step_mm[0], (PlainPoint{1.25, 0, 0}));
  EXPECT_EQ(volume->lattice.step_mm[1], (PlainPoint{0, 1.5, 0}));
}

TEST(DicomFrames, OfTwoEchoesAreListedAndEitherMayBeTaken) {
  EnhancedSample sample = enhanced_series(3);
  for (int i = 0; i < 3; ++i) {
    sample.frames.push_back(sample.frames[static_cast<std::size_t>(i)]);
    sample.frames.back().first = 1000;
  }
  for (std::size_t i = 0; i < 6; ++i) sample.frames[i].echo_ms = i < 3 ? 9.5 : 10.25;
  expect_refused(read(sample.bytes()),
                 "1: 3 slices 2 mm apart, from 0 to 4 mm along their normal (echo 9.5 ms)");
  expect_refused(read(sample.bytes()), "(echo 10.25 ms), series ...1.2.3; --stack N, to take one of them");
  expect_same(read(sample.bytes(), 1), classic(3));
  const auto second = read(sample.bytes(), 2);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->values[0], 1000);
}

TEST(DicomFrames, AtOnePlaceWithNothingToTellThemApartAreRefused) {
  EnhancedSample sample = enhanced_series(3);
  sample.frames.push_back(sample.frames[1]);
  expect_refused(
      read(sample.bytes()),
      "enhanced.dcm, frame 2, and enhanced.dcm, frame 4, lie at the same place and nothing in them");
}

TEST(DicomFrames, ADelayOfEachSliceSplitsNothing) {
  EnhancedSample sample = enhanced_series(3);
  double delay = 0;
  for (EnhancedFrame& frame : sample.frames) frame.delay_ms = delay += 20;
  expect_same(read(sample.bytes()), classic(3));
}

TEST(DicomFrames, OfTwoStacksAreOneVolumeOnlyWhereOneGoesOnBehindTheOther) {
  EnhancedSample sample = enhanced_series(6);
  for (std::size_t i = 0; i < 6; ++i) sample.frames[i].stack = i < 3 ? "1" : "2";
  expect_same(read(sample.bytes()), classic(6));
  for (std::size_t i = 0; i < 6; ++i) sample.frames[i].stack = i % 2 == 0 ? "1" : "2";
  expect_refused(read(sample.bytes()), "(stack 1)");
}

TEST(DicomFrames, WithAGapBetweenThemAreTwoStacks) {
  EnhancedSample sample = enhanced_series(7);
  sample.frames.erase(sample.frames.begin() + 3);
  expect_refused(read(sample.bytes()), "is no single volume but 2 stacks");
  const auto upper = read(sample.bytes(), 2);
  ASSERT_TRUE(upper);
  EXPECT_EQ(upper->lattice.origin_mm[2], 8);
}

TEST(DicomFrames, UnevenOrLeaningAreToldAsClassicOnesAre) {
  EnhancedSample sample = enhanced_series(5);
  sample.frames[2].position = "-10\\-20\\4.2";
  const auto uneven = read(sample.bytes());
  ASSERT_TRUE(uneven) << uneven.error().message;
  EXPECT_NE(uneven->notes.at(0).find("from an even spacing of 2 mm"), std::string::npos);
  for (int i = 0; i < 5; ++i)
    sample.frames[static_cast<std::size_t>(i)].position =
        "-10\\" + std::to_string(-20 + i) + "\\" + std::to_string(2 * i);
  const auto leaning = read(sample.bytes());
  ASSERT_TRUE(leaning) << leaning.error().message;
  EXPECT_EQ(leaning->lattice.step_mm[2], (PlainPoint{0, 1, 2}));
  EXPECT_NE(leaning->notes.at(0).find("leans by 26"), std::string::npos);
}

TEST(DicomFrames, FilesOfOneSeriesAreEachAVolumeAtOnePlace) {
  const TemporaryFolder folder;
  for (const std::string name : {"a.dcm", "b.dcm"}) {
    EnhancedSample sample = enhanced_series(3);
    sample.instance = "1.2.9." + std::to_string(name[0]);
    folder.write(name, sample.bytes());
  }
  const auto both = read_volume({.path = folder / ""});
  expect_refused(both, "(file a.dcm)");
  expect_refused(both, "(file b.dcm)");
  expect_same(read_volume({.path = folder / "b.dcm"}), classic(3));
}

TEST(DicomFrames, TheSameFileTwiceIsTakenOnce) {
  const TemporaryFolder folder;
  for (const char* name : {"a.dcm", "copy of a.dcm"}) folder.write(name, enhanced_series(3).bytes());
  const auto volume = read_volume({.path = folder / ""});
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_NE(volume->notes.at(0).find("3 images are in the folder twice"), std::string::npos);
}

TEST(DicomFrames, ThatAConcatenationSpreadsOverFilesAreOneVolume) {
  const EnhancedSample whole = enhanced_series(6);
  for (const bool interleaved : {false, true}) {
    const TemporaryFolder folder;
    for (std::size_t part = 0; part < 2; ++part) {
      EnhancedSample sample = whole;
      sample.frames.clear();
      for (std::size_t i = 0; i < 6; ++i)
        if ((interleaved ? i % 2 : i / 3) == part) sample.frames.push_back(whole.frames[i]);
      sample.instance += "." + std::to_string(part);
      sample.concatenation = "1.2.77";
      folder.write("part" + std::to_string(part), sample.bytes());
    }
    expect_same(read_volume({.path = folder / ""}), classic(6));
  }
}

TEST(DicomFrames, ThatContradictTheirFileAreRefused) {
  EnhancedSample lies = enhanced_series(3);
  lies.stated_frames = "4";
  expect_refused(read(lies.bytes()),
                 "holds 4 frames and functional groups for 3; one for each frame is expected");
  EnhancedSample thin = enhanced_series(3);
  thin.frames_of_pixels = 2;
  expect_refused(read(thin.bytes()), "cut short");
  thin.run_length = true;
  expect_refused(read(thin.bytes()), "holds 3 frames in 2 pieces of compressed pixels");
  expect_refused(read(DicomSample{.frames = "20"}.bytes()), "holds 20 frames and no functional groups");
}

TEST(DicomFrames, ThatLieNowhereOrInNoPlaneAreRefused) {
  EnhancedSample sample = enhanced_series(3);
  sample.frames[1].position = "";
  expect_refused(read(sample.bytes()), "enhanced.dcm, frame 2: states no ImagePositionPatient");
  sample.frames[1].position = "-10\\nan\\2";
  expect_refused(read(sample.bytes()), "enhanced.dcm, frame 2: states no ImagePositionPatient");
  EnhancedSample flat = enhanced_series(3);
  flat.spacing = "0\\0.5";
  expect_refused(read(flat.bytes()), "frame 1: states the PixelSpacing \"0\\0.5\"; two positive numbers");
  flat.spacing = "";
  expect_refused(read(flat.bytes()), "frame 1: states the PixelSpacing \"\"");
  EnhancedSample askew = enhanced_series(3);
  askew.orientation = "1\\0\\0\\0.6\\0.8\\0";
  expect_refused(read(askew.bytes()), "frame 1: states the ImageOrientationPatient");
}

TEST(DicomFrames, CutAnywhereAreRefused) {
  for (const bool open_ended : {false, true}) {
    EnhancedSample sample = enhanced_series(3);
    sample.open_ended_groups = open_ended;
    sample.run_length = open_ended;
    const std::string whole = sample.bytes();
    for (std::size_t length = 132; length + 8 < whole.size(); length += 11)
      EXPECT_FALSE(read(whole.substr(0, length))) << length;
  }
}

TEST(DicomFrames, WhoseRunLengthsAreDamagedAreRefused) {
  EnhancedSample sample = enhanced_series(3);
  sample.run_length = true;
  const std::string whole = sample.bytes();
  constexpr std::size_t kEndOfPieces = 8, kPlanes = 28, kHead = 64;
  const std::size_t head = whole.size() - kEndOfPieces - kPlanes - kHead;
  ASSERT_EQ(whole[head], 2);
  for (const std::size_t damaged : {0, 4, 5, 8}) {  // the planes' count and their places
    std::string bytes = whole;
    bytes[head + damaged] = 120;
    expect_refused(read(bytes), "cannot be unpacked or are cut short");
  }
}

TEST(DicomFrames, DamagedAnywhereGiveAVolumeOrASentence) {
  EnhancedSample sample = enhanced_series(3);
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    sample.open_ended_groups = round % 2 == 0;
    sample.run_length = round % 3 == 0;
    std::string bytes = sample.bytes();
    for (int i = 0; i < 1 + round % 4; ++i)
      bytes[132 + random() % (bytes.size() - 132)] = static_cast<char>(random() % 256);
    const auto volume = read(bytes);
    EXPECT_TRUE(volume || !volume.error().message.empty());
  }
}

TEST(DicomFiles, OfTwoKindsAtOnePlaceAreListed) {
  const TemporaryFolder folder;
  for (const char* type : {"ORIGINAL\\PRIMARY\\M", "ORIGINAL\\PRIMARY\\P"})
    for (int i = 0; i < 3; ++i)
      folder.write(std::string(type).substr(17) + std::to_string(i),
                   DicomSample{.position = "0\\0\\" + std::to_string(i), .type = type}.bytes());
  expect_refused(read_volume({.path = folder / ""}), "(type ORIGINAL\\PRIMARY\\P)");
}

}  // namespace
}  // namespace orcart
