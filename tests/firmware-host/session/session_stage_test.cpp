// From the painter's record to the file, with the disk full in between.
#include "firmware-host/session/session_stage.hpp"

#include <gtest/gtest.h>

#include "firmware-host/session/session_reader.hpp"
#include "tests/firmware-host/session/full_disk.hpp"
#include "tests/firmware-host/session/session_samples.hpp"
#include "tests/support/zero_allocation.hpp"

namespace orcart {
namespace {

using testing::FullDisk;
using testing::SessionFolder;

constexpr std::size_t kBytes = packed_bytes(PixelFormat::yuyv, testing::kWidth_px, testing::kHeight_px);

struct Bench {
  SessionFolder folder;
  Result<SessionWriter> writer = SessionWriter::create(folder / "a.orcart", {});
  SessionStage stage{*writer, 4, kBytes};
  std::vector<std::byte> bytes = testing::picture_bytes(9);

  void paint(std::uint32_t unit) {
    stage.keep(testing::frame_number(9, bytes), {.unit = unit, .streaming = true});
  }
};

TEST(SessionStage, WritesWhatWasPaintedAndWhatWasTakenBack) {
  Bench bench;
  EXPECT_FALSE(bench.stage.step({}).worked);
  bench.paint(1);
  bench.paint(2);
  bench.stage.undone(2);
  EXPECT_EQ(bench.stage.step({}).items, 2U);
  EXPECT_EQ(bench.stage.kept(), 2U);
  const auto captures = SessionReader::open(bench.folder / "a.orcart")->captures();
  ASSERT_EQ(captures->size(), 2U);
  EXPECT_EQ(captures->at(0).facts.unit, 1U);
  EXPECT_TRUE(captures->at(0).facts.streaming);
  EXPECT_EQ(captures->at(0).frame_sequence, 1009U);
  EXPECT_FALSE(captures->at(0).undone);
  EXPECT_TRUE(captures->at(1).undone);
}

TEST(SessionStage, GoesOnAfterAFullDiskAndSaysWhatHappened) {
  Bench bench;
  {
    const FullDisk full(std::filesystem::file_size((bench.folder / "a.orcart-wal")));
    bench.paint(1);
    EXPECT_TRUE(bench.stage.step({}).worked);
  }
  EXPECT_EQ(bench.stage.failures(), 1U);
  EXPECT_EQ(bench.stage.lost(), 1U);
  EXPECT_TRUE(bench.stage.failing());
  EXPECT_NE(bench.stage.last_error().find("a.orcart: "), std::string::npos) << bench.stage.last_error();
  bench.paint(2);
  EXPECT_EQ(bench.stage.step({}).items, 1U);
  EXPECT_EQ(bench.stage.lost(), 1U);
  EXPECT_FALSE(bench.stage.failing());
}

TEST(SessionStage, RemembersWhatWasTakenBackWhileTheDiskWasFull) {
  Bench bench;
  bench.paint(1);
  bench.paint(2);
  EXPECT_EQ(bench.stage.step({}).items, 2U);
  {
    const FullDisk full(std::filesystem::file_size((bench.folder / "a.orcart-wal")));
    bench.stage.undone(2);
    (void)bench.stage.step({});
    EXPECT_EQ(bench.stage.failures(), 1U);
  }
  (void)bench.stage.step({});
  const auto captures = SessionReader::open(bench.folder / "a.orcart")->captures();
  ASSERT_EQ(captures->size(), 2U);
  EXPECT_FALSE(captures->at(0).undone);
  EXPECT_TRUE(captures->at(1).undone);
  EXPECT_EQ(bench.stage.lost(), 0U);
  EXPECT_FALSE(bench.stage.failing());
}

TEST(SessionStage, CountsWhatItHadNoRoomFor) {
  Bench bench;
  for (std::uint32_t i = 0; i < 6; ++i) bench.paint(i);
  EXPECT_EQ(bench.stage.lost(), 2U);
}

TEST(SessionStage, AsksNothingOfTheHeapOnTheRenderThread) {
  Bench bench;
  const CapturedFrame frame = testing::frame_number(9, bench.bytes);
  EXPECT_TRUE(testing::zero_allocation([&] {
    for (int i = 0; i < 6; ++i) bench.stage.keep(frame, {.unit = 1});
    bench.stage.undone(1);
  }));
}

}  // namespace
}  // namespace orcart
