// Points from three formats: coordinate systems obeyed, unstated ones refused until told.
#include "tools/registration/points_file.hpp"

#include <gtest/gtest.h>

#include "tests/tools/registration/text_file.hpp"

namespace orcart {
namespace {

using testing::TextFile;

TEST(PointsFile, ReadsRowsWithAndWithoutNames) {
  const TextFile named("a.csv", "name,x,y,z\nnasion,1,2,3\n");
  EXPECT_EQ(read_points(named.path()).value()[0].mm, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(read_points(named.path()).value()[0].name, "nasion");
  const TextFile plain("b.txt", "37.82 52.99 -191.00\n310.90 70.36 -196.50\n");
  EXPECT_EQ(read_points(plain.path()).value()[1].mm, Eigen::Vector3d(310.90, 70.36, -196.50));
  EXPECT_FALSE(read_points(named.path()).value()[0].numbered);
  EXPECT_TRUE(read_points(plain.path()).value()[1].numbered);
}

TEST(PointsFile, ObeysWhatSlicerStates) {
  const std::string rows =
      "# columns = "
      "id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\nid1,1,2,3,0,0,0,1,1,1,0,left,,\n";
  const TextFile ras("a.fcsv", "# CoordinateSystem = RAS\n" + rows);
  EXPECT_EQ(read_points(ras.path()).value()[0].mm, Eigen::Vector3d(-1, -2, 3));
  EXPECT_EQ(read_points(ras.path()).value()[0].name, "left");
  const TextFile lps("b.fcsv", "# CoordinateSystem = LPS\n" + rows);
  EXPECT_EQ(read_points(lps.path()).value()[0].mm, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(read_points(lps.path(), Space::ras));
}

TEST(PointsFile, RefusesAnUnstatedSystemUntilTold) {
  const TextFile unstated("a.fcsv", "# columns = label,x,y,z,sel,vis\nL,1,2,3,1,1\n");
  const auto refused = read_points(unstated.path());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("--space LPS or --space RAS"), std::string::npos);
  EXPECT_EQ(read_points(unstated.path(), Space::ras).value()[0].mm, Eigen::Vector3d(-1, -2, 3));
}

TEST(PointsFile, ReadsMarkups) {
  const TextFile file("a.mrk.json", R"({"markups": [{"coordinateSystem": "RAS", "coordinateUnits": "mm",
      "controlPoints": [{"label": "F\"1", "position": [1, -2.5e0, 3], "locked": true, "x": null}]}]})");
  const auto points = read_points(file.path());
  ASSERT_TRUE(points) << points.error().message;
  EXPECT_EQ(points->at(0).name, "F\"1");
  EXPECT_EQ(points->at(0).mm, Eigen::Vector3d(-1, 2.5, 3));
}

constexpr const char* kSlicer5 =
    "# Markups fiducial file version = 5.4\n# CoordinateSystem = LPS\n"
    "# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n";

TEST(PointsFile, LeavesOutWhatSlicerHoldsWithoutAPlace) {
  const TextFile fcsv("a.fcsv", std::string(kSlicer5) +
                                    "1,-322.5,-5.6,-35.9,0,0,0,1,1,1,0,skipped,,,3,0\n"
                                    "2,-517.4,-5.6,122.9,0,0,0,1,1,1,1,placed,,,2,0\n");
  std::vector<std::string> notes;
  const auto rows = read_points(fcsv.path(), std::nullopt, &notes);
  ASSERT_TRUE(rows) << rows.error().message;
  ASSERT_EQ(rows->size(), 1U);
  EXPECT_EQ(rows->at(0).name, "placed");
  EXPECT_NE(notes.at(0).find("\"skipped\""), std::string::npos);
  const TextFile json("a.mrk.json", R"({"markups": [{"coordinateSystem": "LPS", "controlPoints": [
      {"label": "skipped", "position": "", "positionStatus": "missing"},
      {"label": "next", "position": null, "positionStatus": "undefined"},
      {"label": "placed", "position": [1, 2, 3], "positionStatus": "defined"}]}]})");
  const auto control = read_points(json.path(), std::nullopt, &notes);
  ASSERT_TRUE(control) << control.error().message;
  ASSERT_EQ(control->size(), 1U);
  EXPECT_EQ(control->at(0).mm, Eigen::Vector3d(1, 2, 3));
  EXPECT_NE(notes.at(1).find("\"skipped\", \"next\""), std::string::npos);
  const TextFile none("b.fcsv", std::string(kSlicer5) + "1,1,2,3,0,0,0,1,1,1,0,a,,,0,0\n");
  EXPECT_NE(read_points(none.path()).error().message.find("that was placed, only \"a\""), std::string::npos);
}

TEST(PointsFile, MeasuredPointsAreWhatSlicerShows) {
  const std::string row = "1,-10,-20,30,0,0,0,1,1,1,0,a,,,2,0\n";
  const TextFile lps("a.fcsv", kSlicer5 + row);
  std::vector<std::string> notes;
  EXPECT_EQ(read_measured_points(lps.path(), &notes).value()[0].mm, Eigen::Vector3d(10, 20, 30));
  EXPECT_EQ(notes.size(), 1U);
  const TextFile ras("b.fcsv", "# CoordinateSystem = RAS\n# columns = label,x,y,z\na,10,20,30\n");
  EXPECT_EQ(read_measured_points(ras.path()).value()[0].mm, Eigen::Vector3d(10, 20, 30));
  const TextFile old("c.fcsv", "# Fiducial List file c\n# columns = label,x,y,z,sel,vis\na,10,20,30,1,1\n");
  EXPECT_EQ(read_measured_points(old.path()).value()[0].mm, Eigen::Vector3d(10, 20, 30));
  const TextFile rows("d.csv", "a,10,20,30\n");
  EXPECT_EQ(read_measured_points(rows.path()).value()[0].mm, Eigen::Vector3d(10, 20, 30));
}

TEST(PointsFile, ReadsWhatSpreadsheetsWrite) {
  const TextFile semicolons("a.csv", "\xEF\xBB\xBFname;x;y;z\r\n\"left, upper\";1,5;-2,25;3\r\n");
  const auto points = read_points(semicolons.path());
  ASSERT_TRUE(points) << points.error().message;
  EXPECT_EQ(points->at(0).name, "left, upper");
  EXPECT_EQ(points->at(0).mm, Eigen::Vector3d(1.5, -2.25, 3));
  const TextFile first("b.csv", "\xEF\xBB\xBFnasion,1,2,3\n\"a \"\"b\"\"\",\t4, 5,6\n");
  const auto named = read_points(first.path());
  ASSERT_TRUE(named) << named.error().message;
  EXPECT_EQ(named->at(0).name, "nasion");
  EXPECT_EQ(named->at(1).name, "a \"b\"");
  const TextFile remarks("c.csv", "name,x,y,z\na,1,2,3,good\n");
  EXPECT_NE(read_points(remarks.path()).error().message.find("c.csv:2: "), std::string::npos);
}

TEST(PointsFile, ReadsAQuotedLabelAndAnyCaseInFcsv) {
  const TextFile file("a.FCSV", "# coordinateSystem = 0\n# columns = id,x,y,z,label\n1,1,2,3,\"F, 1\"\n");
  const auto points = read_points(file.path());
  ASSERT_TRUE(points) << points.error().message;
  EXPECT_EQ(points->at(0).name, "F, 1");
  EXPECT_EQ(points->at(0).mm, Eigen::Vector3d(-1, -2, 3));
}

TEST(PointsFile, ReadsUnitsSeveralListsAndEscapesOfMarkups) {
  const TextFile file("a.MRK.JSON", R"({"markups": [
      {"coordinateSystem": "LPS", "coordinateUnits": ["mm", "UCUM", "millimeter"],
       "controlPoints": [{"label": "\u00e9\ud83d\ude00\ttip", "position": [1, 2, 3]}]},
      {"coordinateSystem": "LPS", "coordinateUnits": "um",
       "controlPoints": [{"label": "b", "position": [1000, 2000, 3000]}]}]})");
  const auto points = read_points(file.path());
  ASSERT_TRUE(points) << points.error().message;
  ASSERT_EQ(points->size(), 2U);
  EXPECT_EQ(points->at(0).name, "\xC3\xA9\xF0\x9F\x98\x80\ttip");
  EXPECT_EQ(points->at(1).mm, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(points->at(1).numbered);
  const TextFile mixed("b.mrk.json", R"({"markups": [
      {"coordinateSystem": "LPS", "controlPoints": [{"position": [1, 2, 3]}]},
      {"coordinateSystem": "RAS", "controlPoints": [{"position": [1, 2, 3]}]}]})");
  EXPECT_NE(read_points(mixed.path()).error().message.find("different coordinate systems"),
            std::string::npos);
}

TEST(PointsFile, ReadsBackWhatItWrites) {
  const std::vector<NamedPoint> points{{.name = "a", .mm = {1.25, -2, 3}},
                                       {.name = "b", .mm = {0, 1e-3, 100}}};
  for (const char* name : {"c.csv", "c.fcsv", "c.mrk.json"}) {
    const TextFile file(name, "");
    ASSERT_TRUE(write_points(file.path(), points));
    const auto read = read_points(file.path());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->at(1).name, "b");
    EXPECT_EQ(read->at(1).mm, points[1].mm);
  }
}

TEST(PointsFile, RefusesShortRowsDoublesAndNothing) {
  const TextFile missing("a.csv", "name,x,y,z\na,1,2,3\nb,1,2\n");
  EXPECT_NE(read_points(missing.path()).error().message.find(":3: "), std::string::npos);
  const TextFile doubled("b.csv", "a,1,2,3\na,4,5,6\n");
  EXPECT_NE(read_points(doubled.path()).error().message.find("two points are named"), std::string::npos);
  const TextFile broken("c.mrk.json", "{\"markups\": [");
  EXPECT_FALSE(read_points(broken.path()));
  const TextFile empty("d.csv", "");
  EXPECT_FALSE(read_points(empty.path()));
}

}  // namespace
}  // namespace orcart
