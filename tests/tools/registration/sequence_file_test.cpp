// PLUS sequences: statuses before and behind their transforms, tools of any name, MetaImage and NRRD.
#include "tools/registration/sequence_file.hpp"

#include <gtest/gtest.h>

#include "tests/tools/registration/text_file.hpp"

namespace orcart {
namespace {

using testing::TextFile;

std::string matrix(int x) {
  return "1 0 0 " + std::to_string(x) + " 0 1 0 0 0 0 1 0 0 0 0 1";
}

std::string mha(const std::string& fields) {
  return "ObjectType = Image\nNDims = 3\n" + fields + "ElementDataFile = LOCAL\n\n\n";
}

TEST(SequenceFile, AStatusCountsOnEitherSideOfItsTransform) {
  const TextFile file("a.mha", mha("Seq_Frame0000_StylusToTrackerTransformStatus = INVALID\n"
                                   "Seq_Frame0000_StylusToTrackerTransform = " +
                                   matrix(1) + "\nSeq_Frame0001_StylusToTrackerTransform = " + matrix(2) +
                                   "\nSeq_Frame0001_StylusToTrackerTransformStatus = OK\n"));
  const auto sequence = read_sequence(file.path());
  ASSERT_TRUE(sequence) << sequence.error().message;
  EXPECT_EQ(sequence->frames[0].transforms.count("StylusToTracker"), 0U);
  EXPECT_EQ(sequence->frames[1].transforms.count("StylusToTracker"), 1U);
  EXPECT_EQ(sequence->transforms_not_ok, 1U);
}

TEST(SequenceFile, ReadsNrrdAndWindowsLineEnds) {
  const TextFile file("a.igs.nrrd",
                      "NRRD0004\r\ntype: unsigned char\r\nSeq_Frame0000_StylusToTrackerTransform:=" +
                          matrix(7) + "\r\nSeq_Frame0000_StylusToTrackerTransformStatus:=OK\r\n\r\n");
  const auto sequence = read_sequence(file.path());
  ASSERT_TRUE(sequence) << sequence.error().message;
  EXPECT_EQ(sequence->frames[0].transforms.at("StylusToTracker").translation_mm.x(), 7);
}

TEST(SequenceFile, ToolsOfAnyNameAreFoundDirectlyOrByWayOfTheTracker) {
  const TextFile file("a.mha", mha("Seq_Frame0000_PointerToTrackerTransform = " + matrix(9) +
                                   "\nSeq_Frame0000_BodyToTrackerTransform = " + matrix(4) +
                                   "\nSeq_Frame0001_PointerTipToBodyTransform = " + matrix(3) + "\n"));
  const auto sequence = read_sequence(file.path());
  ASSERT_TRUE(sequence) << sequence.error().message;
  const auto across = stylus_poses(*sequence, {.stylus = "Pointer", .reference = "Body"});
  ASSERT_TRUE(across) << across.error().message;
  EXPECT_EQ(across->at(0).X_TS.translation_mm.x(), 5);
  const auto direct = stylus_poses(*sequence, {.stylus = "PointerTip", .reference = "Body"});
  ASSERT_TRUE(direct) << direct.error().message;
  EXPECT_EQ(direct->at(0).name, "1");
  const auto refused = stylus_poses(*sequence);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("it holds BodyToTracker, PointerTipToBody, PointerToTracker"),
            std::string::npos);
}

}  // namespace
}  // namespace orcart
