// views.csv as people and programs write it; what is refused names its line.
#include "firmware-host/files/views_file.hpp"

#include <gtest/gtest.h>

#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {
namespace {

constexpr const char* kHeader = "image,m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23";

Result<ViewsFile> read_text(const TemporaryFolder& folder, const std::string& text) {
  return read_views(folder.write("views.csv", text));
}

std::string error_of(const std::string& text) {
  const TemporaryFolder folder;
  const auto read = read_text(folder, text);
  EXPECT_FALSE(read);
  if (read) return "";
  return read.error().message.substr(read.error().message.find("views.csv"));
}

TEST(ViewsFile, ReadsPosesRowByRow) {
  const TemporaryFolder folder;
  const auto read = read_text(folder, std::string(kHeader) + "\na.png,0,-1,0,10,1,0,0,20,0,0,1,30\n");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->views.size(), 1U);
  EXPECT_TRUE(read->views[0].X_MC.translation_mm.isApprox(Eigen::Vector3d(10, 20, 30)));
  EXPECT_TRUE((read->views[0].X_MC.rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_TRUE(read->notes.empty());
}

TEST(ViewsFile, TakesImagesFromItsOwnFolder) {
  const TemporaryFolder folder;
  const auto read =
      read_text(folder, "sub/a.png,1,0,0,0,0,1,0,0,0,0,1,0\n/abs/b.png,1,0,0,0,0,1,0,0,0,0,1,0");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->views[0].image, folder / "sub/a.png");
  EXPECT_EQ(read->views[1].image, "/abs/b.png");
}

TEST(ViewsFile, BearsBlankLinesCarriageReturnsBlanksAByteOrderMarkAndNoHeader) {
  const TemporaryFolder folder;
  const auto read = read_text(
      folder, "\xEF\xBB\xBF\r\n a.png , 1,0,0,0, 0,1,0,0, 0,0,1,+1e1 \r\n\r\nb.png,1,0,0,0,0,1,0,0,0,0,1,2");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->views.size(), 2U);
  EXPECT_EQ(read->views[0].image.filename(), "a.png");
  EXPECT_EQ(read->views[0].X_MC.translation_mm.z(), 10);
}

TEST(ViewsFile, ReadsQuotedNames) {
  const TemporaryFolder folder;
  const auto read = read_text(folder, "\"a, \"\"b\"\".png\",1,0,0,0,0,1,0,0,0,0,1,0\n");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->views[0].image.filename(), "a, \"b\".png");
}

TEST(ViewsFile, MendsWhatIsNearlyARotationAndTells) {
  const TemporaryFolder folder;
  const auto read = read_text(folder, "a.png,1.004,0,0,0,0,1,0,0,0,0,1,0\n");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->views[0].X_MC.rotation.isIdentity(1e-12));
  ASSERT_EQ(read->notes.size(), 1U);
  EXPECT_NE(read->notes[0].find("views.csv:1: the pose differs by 0.008 from a rotation and was made one"),
            std::string::npos);
}

TEST(ViewsFile, RefusesWhatIsNoRotationByItsLine) {
  const std::string good = std::string(kHeader) + "\n\na.png,1,0,0,0,0,1,0,0,0,0,1,0\n";
  EXPECT_EQ(error_of(good + "b.png,1.006,0,0,0,0,1,0,0,0,0,1,0"),
            "views.csv:4: the pose differs by 0.012 from a rotation; up to 0.01 is accepted");
  EXPECT_EQ(error_of(good + "b.png,-1,0,0,0,0,1,0,0,0,0,1,0"),
            "views.csv:4: the pose holds a reflection; a rotation is accepted");
  EXPECT_NE(error_of("b.png,0,0,0,0,0,0,0,0,0,0,0,0"), "");
}

TEST(ViewsFile, RefusesNumbersThatAreNone) {
  EXPECT_EQ(error_of("a.png,1,0,0,0,0,1,0,x,0,0,1,0"),
            "views.csv:1: m13 is \"x\"; a finite number is accepted");
  EXPECT_NE(error_of("a.png,nan,0,0,0,0,1,0,0,0,0,1,0").find("m00 is \"nan\""), std::string::npos);
  EXPECT_NE(error_of("a.png,1,0,0,0,0,1,0,0,0,0,1,inf").find("m23 is \"inf\""), std::string::npos);
  EXPECT_NE(error_of("a.png,1,0,0,0,0,1,0,0,0,0,1,").find("m23 is \"\""), std::string::npos);
}

TEST(ViewsFile, RefusesTheWrongNumberOfFieldsAndOpenQuotes) {
  EXPECT_NE(error_of("a.png,1,0,0").find("views.csv:1: has 4 fields; image,m00"), std::string::npos);
  EXPECT_NE(error_of("a.png,1,0,0,0,0,1,0,0,0,0,1,0,9,9").find("has 15 fields"), std::string::npos);
  EXPECT_NE(error_of(",1,0,0,0,0,1,0,0,0,0,1,0").find("names no image"), std::string::npos);
  EXPECT_NE(error_of("\"a.png,1,0,0,0,0,1,0,0,0,0,1,0").find("a quote is not closed"), std::string::npos);
  EXPECT_NE(error_of("\"a\"b,1,0,0,0,0,1,0,0,0,0,1,0").find("text follows it"), std::string::npos);
}

TEST(ViewsFile, RefusesAFileWithoutViews) {
  EXPECT_NE(error_of("").find("holds no views"), std::string::npos);
  EXPECT_NE(error_of(kHeader).find("holds no views"), std::string::npos);
  EXPECT_FALSE(read_views("/no/such/views.csv"));
}

TEST(ViewsFile, NeverBreaksOnATextCutShort) {
  const TemporaryFolder folder;
  const std::string text = std::string(kHeader) + "\r\n\"a,b.png\",1,0,0,0,0,1,0,0,0,0,1,0\r\n";
  for (std::size_t length = 0; length < text.size() - 4; ++length)
    EXPECT_FALSE(read_text(folder, text.substr(0, length))) << length;
}

TEST(ViewsFile, ReadsTheTurnOfAScopeThatTurned) {
  const TemporaryFolder folder;
  const auto read =
      read_text(folder, std::string(kHeader) + ",turn_rad\na.png,1,0,0,0,0,1,0,0,0,0,1,0,-0.25\n" +
                            "b.png,1,0,0,0,0,1,0,0,0,0,1,0\n");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->views[0].turn_rad, -0.25);
  EXPECT_EQ(read->views[1].turn_rad, 0);
  ScopeModel scope;
  const auto refused = check_turns(read->views, scope, "views.csv");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("turned in a.png"), std::string::npos) << refused.error().message;
  EXPECT_TRUE(check_turns({read->views[1]}, scope, "views.csv"));
  scope.turning.emplace();
  EXPECT_TRUE(check_turns(read->views, scope, "views.csv"));
  EXPECT_NE(error_of("a.png,1,0,0,0,0,1,0,0,0,0,1,0,left\n").find("turn_rad is \"left\""), std::string::npos);
}

constexpr const char* kVelocity = ",vx_mm_s,vy_mm_s,vz_mm_s,wx_rad_s,wy_rad_s,wz_rad_s";
constexpr const char* kAtRest = "a.png,1,0,0,0,0,1,0,0,0,0,1,0";

TEST(ViewsFile, ReadsHowFastTheScopeMovedWithAndWithoutATurn) {
  const TemporaryFolder folder;
  const auto turned = read_text(folder, std::string(kHeader) + ",turn_rad" + kVelocity + "\n" + kAtRest +
                                            ",0.5,1,2,3,-0.1,0,1e-2\n" + kAtRest + ",0.25,,,,,,\n");
  ASSERT_TRUE(turned) << turned.error().message;
  ASSERT_EQ(turned->views.size(), 2U);
  EXPECT_EQ(turned->views[0].turn_rad, 0.5);
  EXPECT_EQ(turned->views[0].velocity.value(), (Twist() << 1, 2, 3, -0.1, 0, 0.01).finished());
  EXPECT_EQ(turned->views[1].turn_rad, 0.25);
  EXPECT_FALSE(turned->views[1].velocity) << "all empty: not known";
  for (const std::string& header : {std::string(kHeader) + kVelocity + "\n", std::string()}) {
    const auto straight = read_text(folder, header + kAtRest + ",1,2,3,4,5,6\n");
    ASSERT_TRUE(straight) << straight.error().message;
    EXPECT_EQ(straight->views[0].turn_rad, 0);
    EXPECT_EQ(straight->views[0].velocity.value(), (Twist() << 1, 2, 3, 4, 5, 6).finished());
  }
}

TEST(ViewsFile, RefusesAVelocityThatIsNoneByLineAndColumn) {
  const std::string line = std::string(kAtRest) + ",0.5,1,2,3,";
  EXPECT_EQ(error_of(std::string(kHeader) + ",turn_rad" + kVelocity + "\n" + line + "0,slow,0\n"),
            "views.csv:2: wy_rad_s is \"slow\"; a finite number is accepted");
  EXPECT_NE(error_of(line + "0,0,inf").find("wz_rad_s is \"inf\""), std::string::npos);
  EXPECT_NE(error_of(line + "0,,0").find("wy_rad_s is \"\""), std::string::npos)
      << "some, but not all, empty";
  EXPECT_NE(error_of(std::string(kHeader) + ",turn_rad" + kVelocity + "\n" + line + "0,0\n")
                .find("views.csv:2: has 19 fields; as many as the header's, 20,"),
            std::string::npos);
  EXPECT_NE(error_of(line + "0,0,0,0").find("has 21 fields"), std::string::npos);
  EXPECT_NE(error_of(std::string(kAtRest) + ",1,2,3,4,5").find("has 18 fields"), std::string::npos);
}

TEST(ViewsFile, RefusesVelocitiesOfAnotherOrderOrUnitByTheirHeader) {
  const std::string degrees = ",vx_mm_s,vy_mm_s,vz_mm_s,wx_deg_s,wy_deg_s,wz_deg_s";
  EXPECT_NE(error_of(kHeader + degrees + "\n" + kAtRest + ",1,2,3,4,5,6\n")
                .find("views.csv:1: the column wx_rad_s is named \"wx_deg_s\""),
            std::string::npos);
}

}  // namespace
}  // namespace orcart
