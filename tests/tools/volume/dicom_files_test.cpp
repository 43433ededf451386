// A folder of DICOM slices becomes a volume in Hounsfield and LPS, or one clear sentence.
#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/tools/volume/dicom_sample.hpp"
#include "tools/volume/volume_reader.hpp"

namespace orcart {
namespace {

std::filesystem::path path_of(const TemporaryFolder& folder) {
  return folder / "";
}

void expect_refused(const TemporaryFolder& folder, const std::string& why) {
  const auto volume = read_volume({.path = path_of(folder)});
  ASSERT_FALSE(volume);
  EXPECT_NE(volume.error().message.find(why), std::string::npos) << volume.error().message;
}

TEST(DicomFiles, AreSortedRescaledAndPlaced) {
  const TemporaryFolder folder;
  write_series(folder, 3);
  const auto volume = read_volume({.path = path_of(folder)});
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->lattice.size, (std::array{4, 3, 3}));
  EXPECT_EQ(volume->lattice.origin_mm, (PlainPoint{-10, -20, 0}));
  EXPECT_EQ(volume->lattice.step_mm[0], (PlainPoint{0.5, 0, 0}));
  EXPECT_EQ(volume->lattice.step_mm[1], (PlainPoint{0, 0.75, 0}));
  EXPECT_EQ(volume->lattice.step_mm[2], (PlainPoint{0, 0, 2}));
  EXPECT_EQ(volume->values[0], -1000);
  EXPECT_EQ(volume->values[5], -990);
  EXPECT_EQ(volume->values[12], -800);  // the second slice's pixels start at 100
  EXPECT_EQ(volume->series, "1.2.3");
  EXPECT_EQ(volume->frame_of_reference, "1.2.3.4");
  EXPECT_EQ(volume->kind, "DICOM CT, 3 slices");
}

TEST(DicomFiles, OtherFilesBesideThemAreLeftOutAndTold) {
  const TemporaryFolder folder;
  write_series(folder, 3);
  folder.write("LICENSE", "free");
  const auto volume = read_volume({.path = path_of(folder)});
  ASSERT_TRUE(volume);
  ASSERT_EQ(volume->notes.size(), 1U);
  EXPECT_NE(volume->notes[0].find("1 files beside the slices"), std::string::npos);
}

TEST(DicomFiles, AFolderWithoutSlicesIsRefused) {
  const TemporaryFolder folder;
  folder.write("LICENSE", "free");
  expect_refused(folder, "holds 1 files and no DICOM image");
}

TEST(DicomFiles, OneCutShortIsRefusedByName) {
  const TemporaryFolder folder;
  write_series(folder, 3);
  const std::string whole = DicomSample{.position = "-10\\-20\\6"}.bytes();
  folder.write("broken", whole.substr(0, whole.size() - 9));
  expect_refused(folder, "broken");
  folder.write("broken", whole.substr(0, 300));
  expect_refused(folder, "broken");
}

TEST(DicomFiles, OneCutShortBehindASequenceWithoutALengthIsRefusedByName) {
  const TemporaryFolder folder;
  write_series(folder, 3);
  std::string whole = DicomSample{.position = "-10\\-20\\6"}.bytes();
  const std::string patient = DicomBytes::text(0x10, 0x20, "LO", "P1");
  whole.insert(whole.find(patient), DicomBytes::open_ended(8, 0x1140, "SQ", ""));
  folder.write("whole", whole);
  EXPECT_TRUE(read_volume({.path = path_of(folder)}));
  folder.write("whole", whole.substr(0, whole.size() - 9));
  expect_refused(folder, "whole");
}

TEST(DicomFiles, AFolderInItThatCannotBeListedIsRefused) {
  const TemporaryFolder folder;
  write_series(folder, 3);
  std::filesystem::create_directory(folder / "more");
  std::filesystem::permissions(folder / "", std::filesystem::perms(0755));
  std::filesystem::permissions(folder / "more", std::filesystem::perms::none);
  constexpr uid_t kNobody = 65534;
  const bool root = ::geteuid() == 0;  // whom nothing is shut to
  ASSERT_TRUE(!root || ::seteuid(kNobody) == 0);
  const auto volume = read_volume({.path = path_of(folder)});
  ASSERT_TRUE(!root || ::seteuid(0) == 0);
  std::filesystem::permissions(folder / "more", std::filesystem::perms::owner_all);
  ASSERT_FALSE(volume);
  EXPECT_NE(volume.error().message.find("more: cannot be listed: Permission denied"), std::string::npos)
      << volume.error().message;
}

TEST(DicomFiles, TwoPatientsAndManyFramesAreRefused) {
  const TemporaryFolder folder;
  write_series(folder, 3);
  folder.write("other", DicomSample{.patient = "P2", .position = "-10\\-20\\6"}.bytes());
  expect_refused(folder, "images of 2 patients");
  folder.write("other", DicomSample{.frames = "20"}.bytes());
  expect_refused(folder, "holds 20 frames");
}

TEST(DicomFiles, ThoseWithoutThePreambleAreReadToo) {
  const TemporaryFolder folder, bare;
  write_series(folder, 3);
  for (const auto& entry : std::filesystem::directory_iterator(path_of(folder))) {
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), {}};
    bare.write(entry.path().filename().string(), whole.substr(whole.find(std::string("\x08\0\x16\0", 4))));
  }
  const auto volume = read_volume({.path = path_of(folder)}), same = read_volume({.path = path_of(bare)});
  ASSERT_TRUE(volume && same) << same.error().message;
  EXPECT_EQ(same->values, volume->values);
  EXPECT_EQ(same->lattice.origin_mm, volume->lattice.origin_mm);
}

TEST(DicomFiles, ASingleSliceAsksForItsFolder) {
  const TemporaryFolder folder;
  const auto volume = read_volume({.path = folder.write("one.dcm", DicomSample{}.bytes())});
  ASSERT_FALSE(volume);
  EXPECT_NE(volume.error().message.find("the folder that holds the whole series is expected"),
            std::string::npos);
}

TEST(DicomFiles, NeverFailsOtherwiseWhenCutAnywhere) {
  const std::string whole = DicomSample{}.bytes();
  for (std::size_t length = 132; length < whole.size(); length += 7) {
    const TemporaryFolder folder;
    write_series(folder, 2);
    folder.write("cut", whole.substr(0, length));
    const auto volume = read_volume({.path = path_of(folder)});
    EXPECT_TRUE(volume || !volume.error().message.empty());
  }
}

}  // namespace
}  // namespace orcart
