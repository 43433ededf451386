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
