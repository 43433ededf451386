// Poses from TOML: rotations pass, nearly rotations are mended and told, the rest is refused.
#include "firmware-host/files/toml_pose.hpp"

#include <gtest/gtest.h>

namespace orcart {
namespace {

struct Read {
  Pose<M, C> pose;
  std::vector<std::string> notes;
  std::string error;
};

Read read(const std::string& text, std::optional<Pose<M, C>> fallback = std::nullopt) {
  const auto reader = *TomlReader::parse(text, "f.toml");
  Read read;
  read.pose = pose_from_toml<M, C>(reader->top(), "X_MC", fallback);
  read.notes = reader->notes();
  const auto finished = reader->finish();
  if (!finished) read.error = finished.error().message;
  return read;
}

TEST(TomlPose, ARotationPasses) {
  const Read quarter = read("X_MC = [0,-1,0,4, 1,0,0,5, 0,0,1,6]");
  EXPECT_EQ(quarter.error, "");
  EXPECT_TRUE(quarter.notes.empty());
  EXPECT_TRUE(quarter.pose.translation_mm.isApprox(Eigen::Vector3d(4, 5, 6)));
  EXPECT_TRUE((quarter.pose.rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
}

TEST(TomlPose, ANearlyRotationIsMendedAndTold) {
  const Read nearly = read("X_MC = [1.004,0,0,0, 0,1,0,0, 0,0,1,0]");
  EXPECT_EQ(nearly.error, "");
  EXPECT_TRUE(nearly.pose.rotation.isApprox(Eigen::Matrix3d::Identity(), 1e-12));
  EXPECT_EQ(nearly.notes,
            std::vector<std::string>{"f.toml:1: X_MC differs by 0.008 from a rotation and was made one"});
}

TEST(TomlPose, NoRotationIsRefused) {
  EXPECT_EQ(read("X_MC = [1.006,0,0,0, 0,1,0,0, 0,0,1,0]").error,
            "f.toml:1: X_MC differs by 0.012 from a rotation; up to 0.01 is accepted");
  EXPECT_EQ(read("X_MC = [-1,0,0,0, 0,1,0,0, 0,0,1,0]").error,
            "f.toml:1: X_MC holds a reflection; a rotation is accepted");
  EXPECT_NE(read("X_MC = [0,0,0,0, 0,0,0,0, 0,0,0,0]").error, "");
}

TEST(TomlPose, TheFallbackIsUsedWhereNothingIsSaid) {
  EXPECT_EQ(read("", Pose<M, C>{.translation_mm = {1, 2, 3}}).pose.translation_mm.y(), 2);
  EXPECT_EQ(read("").error, "f.toml: X_MC is missing; it is required");
}

}  // namespace
}  // namespace orcart
