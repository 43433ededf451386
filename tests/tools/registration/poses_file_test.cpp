// Poses from the forms that people have, and the sentences for those that are none.
#include "tools/registration/poses_file.hpp"

#include <gtest/gtest.h>

#include "tests/tools/registration/text_file.hpp"

namespace orcart {
namespace {

using testing::TextFile;

std::string refusal(const std::string& text) {
  const TextFile file("poses.csv", text);
  const auto poses = read_poses(file.path());
  return poses ? "accepted" : poses.error().message;
}

TEST(PosesFile, ReadsNamedRowsWithAHeader) {
  const TextFile file("poses.csv",
                      "name,m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23\na,1,0,0,10,0,1,0,20,0,0,1,30\n");
  const auto poses = read_poses(file.path());
  ASSERT_TRUE(poses) << poses.error().message;
  ASSERT_EQ(poses->poses.size(), 1U);
  EXPECT_EQ(poses->poses[0].name, "a");
  EXPECT_EQ(poses->poses[0].X_TS.translation_mm, Eigen::Vector3d(10, 20, 30));
}

TEST(PosesFile, ReadsTimesAndSixteenNumbersAndMatricesOverFourLines) {
  const TextFile times("times.txt", "1378476416922755200 1 0 0 10 0 1 0 20 0 0 1 30 0 0 0 1\n");
  const auto timed = read_poses(times.path());
  ASSERT_TRUE(timed) << timed.error().message;
  EXPECT_EQ(timed->poses[0].name, "1378476416922755200");
  const TextFile lines("matrix.txt", "1 0 0 10\n0 1 0 20\n0 0 1 30\n0 0 0 1\n");
  const auto matrix = read_poses(lines.path());
  ASSERT_TRUE(matrix) << matrix.error().message;
  EXPECT_EQ(matrix->poses[0].X_TS.translation_mm, Eigen::Vector3d(10, 20, 30));
}

TEST(PosesFile, ReadsNamesWithBlanksAndQuotes) {
  const TextFile file("poses.csv",
                      "\xEF\xBB\xBFname,m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23\n"
                      "my picture 1.png,1,0,0,10,0,1,0,20,0,0,1,30\n\"two 2.png\";1;0;0;1;0;1;0;2;0;0;1;3\n");
  const auto poses = read_poses(file.path());
  ASSERT_TRUE(poses) << poses.error().message;
  EXPECT_EQ(poses->poses[0].name, "my picture 1.png");
  EXPECT_EQ(poses->poses[1].name, "two 2.png");
  EXPECT_EQ(poses->poses[1].X_TS.translation_mm, Eigen::Vector3d(1, 2, 3));
}

TEST(PosesFile, LeavesOutRowsInWhichNoToolWasSeen) {
  const TextFile file("poses.csv",
                      "1 0 0 10 0 1 0 20 0 0 1 30\nnan nan nan nan nan nan nan nan nan nan nan nan\n"
                      "% a remark\n1 0 0 11 0 1 0 20 0 0 1 30\n");
  const auto poses = read_poses(file.path());
  ASSERT_TRUE(poses) << poses.error().message;
  ASSERT_EQ(poses->poses.size(), 2U);
  EXPECT_EQ(poses->poses[1].name, "3");
  EXPECT_NE(poses->notes.at(0).find("1 poses hold NaN"), std::string::npos);
}

TEST(PosesFile, RefusesWithTheLine) {
  EXPECT_NE(refusal("a,1,0,0,10,0,1,0,20,0,0,1\n").find(":1: has 11 numbers"), std::string::npos);
  EXPECT_NE(refusal("a,1,0,0,10,0,1,0,20,0,0,1,x\n").find(":1: "), std::string::npos);
  EXPECT_NE(refusal("a,1,0,0,10,0,1,0,20,0,0,1,5\nb,2,0,0,1,0,1,0,2,0,0,1,3\n").find(":2: the pose differs"),
            std::string::npos);
  EXPECT_NE(refusal("a,1,0,0,10,0,1,0,20,0,0,-1,5\n").find("reflection"), std::string::npos);
  EXPECT_NE(refusal("1 0 0 0 0 1 0 0 0 0 1 0 10 20 30 1\n").find("but its fourth column is"),
            std::string::npos);
  EXPECT_NE(refusal("1 0 0 10\n0 1 0 20\n").find("inside a matrix"), std::string::npos);
  EXPECT_NE(refusal("").find("holds no pose"), std::string::npos);
}

TEST(PosesFile, NoticesMetres) {
  EXPECT_NE(refusal("a,1,0,0,0.3,0,1,0,0.1,0,0,1,-1.5\nb,1,0,0,0.2,0,1,0,0.1,0,0,1,-1.6\n")
                .find("looks like metres"),
            std::string::npos);
}

}  // namespace
}  // namespace orcart
