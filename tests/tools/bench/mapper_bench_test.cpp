// Bench poses as files, good and bad, and a bench of a mesh whose counts are known.
#include "tools/bench/mapper_bench.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/realtime/geometry/analytic_meshes.hpp"

namespace orcart {
namespace {

/// A file for the length of a test.
class PosesFile {
 public:
  explicit PosesFile(const std::string& text)
      : path_(std::filesystem::path(::testing::TempDir()) /
              (std::string("poses_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() +
               ".csv")) {
    std::ofstream(path_) << text;
  }
  ~PosesFile() { std::filesystem::remove(path_); }
  PosesFile(const PosesFile&) = delete;
  PosesFile& operator=(const PosesFile&) = delete;

  Result<std::vector<Pose<M, C>>> read() const { return read_bench_poses(path_); }

 private:
  std::filesystem::path path_;
};

TEST(BenchPoses, TakeDirAsZAndUpAsMinusY) {
  const auto poses = PosesFile("# tip, dir, up, distance\n1,2,3,0,1,0,0,0,1,5.5\n").read();
  ASSERT_TRUE(poses);
  ASSERT_EQ(poses->size(), 1U);
  EXPECT_TRUE(poses->front().translation_mm.isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_TRUE((poses->front() * Direction<C>{{0, 0, 1}}).xyz.isApprox(Eigen::Vector3d(0, 1, 0)));
  EXPECT_TRUE((poses->front() * Direction<C>{{0, -1, 0}}).xyz.isApprox(Eigen::Vector3d(0, 0, 1)));
  EXPECT_NEAR(poses->front().rotation.determinant(), 1, 1e-12);
}

TEST(BenchPoses, RefuseWhatIsNoListOfPoses) {
  for (const char* bad :
       {"", "# only a comment\n", "1,2,3\n", "1,2,3,0,1,0,0,0,1,5,6\n", "1,2,3,0,2,0,0,0,1,5\n",
        "1,2,3,0,1,0,0,1,0,5\n", "1,2,3,0,1,0,0,0,nan,5\n", "tip,dir,up\n", "\x7f\x45\x4c\x46"})
    EXPECT_FALSE(PosesFile(bad).read()) << '"' << bad << '"';
  EXPECT_FALSE(read_bench_poses("/nowhere/poses.csv"));
}

TEST(BenchPoses, NameTheLineThatIsWrong) {
  const auto poses = PosesFile("1,2,3,0,1,0,0,0,1,5\n1,2\n").read();
  ASSERT_FALSE(poses);
  EXPECT_NE(poses.error().message.find(".csv:2: wants ten numbers"), std::string::npos);
}

TEST(MapperBench, CountsTrianglesStepsAndHeapCallsInEveryForm) {
  const Surface surface{.mesh = testing::icosphere(20, 4)};
  const auto poses = PosesFile("0,0,-39,0,0,1,0,1,0,19\n0,0,500,0,0,1,0,1,0,0\n").read().value();
  for (const BenchForm form : {BenchForm::cutout, BenchForm::clip, BenchForm::ranges, BenchForm::live}) {
    const MapperBenchReport report =
        run_mapper_bench(surface, bench_scope({}), poses,
                         {.form = form, .limits = {.max_triangles_per_step = 2000}, .rounds = 3})
            .value();
    EXPECT_EQ(report.triangles_max, 5120U);  // the whole sphere: its edge lies 31 degrees off the axis
    EXPECT_EQ(report.steps_max, form == BenchForm::ranges ? 1U : 3U);
    EXPECT_EQ(report.heap_calls.value_or(0), 0U);
    EXPECT_GE(report.max_us, report.p99_us);
    EXPECT_GE(report.p99_us, report.median_us);
    EXPECT_EQ(report.occlusion_median_us.has_value(), form == BenchForm::live);
    EXPECT_LE(report.tree_bytes_per_triangle, 30);
    EXPECT_NE(to_json(report).find("\"triangles_max\": 5120"), std::string::npos);
  }
}

TEST(MapperBench, RefusesNoPoses) {
  EXPECT_FALSE(run_mapper_bench({.mesh = testing::icosphere(20, 1)}, bench_scope({}), {}, {}));
}

}  // namespace
}  // namespace orcart
