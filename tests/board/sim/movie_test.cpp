// Movies: drawn once, used again where they fit, refused where they are damaged, true to the world.
#include "board/sim/movie_drawing.hpp"

#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/board/sim/pattern_scope.hpp"
#include "tests/board/sim/test_shapes.hpp"

namespace orcart {
namespace {

class MovieTest : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("orcart-movie-test-" + std::to_string(getpid()));
  std::filesystem::path file_ = folder_ / "procedure.orcmovie";
  Surface surface_{
      .mesh = testing::ellipsoid({6, 9, 7}, 16, 24), .identity = {.hash = "ball"}, .closed = true};
  RayScene rays_ = *RayScene::create(surface_.mesh);
  ScopeModel scope_ = testing::pattern_scope();
  ProcedureScript script_{.duration_s = 0.5};
  SimulatedWorld world_ = *SimulatedWorld::create({surface_, rays_, scope_, script_});
  MovieRequest request_{.surface = surface_,
                        .rays = rays_,
                        .scope = scope_,
                        .world = world_,
                        .look = {.tissue = CodedTissue{}},
                        .timing = {.rate_hz = 30, .exposure = 8ms, .first = 3ms}};

  std::vector<std::byte> pixels(const MovieFile& movie, std::uint64_t frame) const {
    std::vector<std::byte> bytes(packed_bytes(PixelFormat::yuyv, scope_.width_px, scope_.height_px));
    EXPECT_TRUE(movie.read(frame, bytes));
    return bytes;
  }
};

TEST_F(MovieTest, HoldsTheFramesThatEndWithinTheProcedure) {
  const auto movie = movie_for(file_, request_);
  ASSERT_TRUE(movie) << movie.error().message;
  EXPECT_EQ(movie->frame_count(), 15U);  // frame 14 ends at 3 + 466.7 + 8 ms, frame 15 would at 511
  EXPECT_EQ(movie->timing().end_of(14), 3ms + 466'666'667ns + 8ms);
}

TEST_F(MovieTest, RecordsTheTruePoseAtMidExposure) {
  const auto movie = movie_for(file_, request_);
  ASSERT_TRUE(movie);
  const auto record = movie->truth(7);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->exposure_end_ns - record->exposure_start_ns, 8'000'000);
  const Pose<M, C> truth =
      world_.X_MC(world_.start() + Nanos{(record->exposure_start_ns + record->exposure_end_ns) / 2});
  EXPECT_NEAR(record->X_MC[3], truth.translation_mm.x(), 1e-9);
  EXPECT_NEAR(record->X_MC[6], truth.rotation(1, 2), 1e-9);
}

TEST_F(MovieTest, HoldsThePicturesThatTheCameraDraws) {
  const auto movie = movie_for(file_, request_);
  ASSERT_TRUE(movie);
  const ScopeCamera camera(surface_.mesh, rays_, scope_, request_.look);
  for (std::uint64_t frame : {0U, 9U}) EXPECT_EQ(pixels(*movie, frame), draw_frame(request_, camera, frame));
}

TEST_F(MovieTest, IsDrawnTheSameByAnyNumberOfThreads) {
  request_.look = {.texel_mm = 0.3F};
  request_.threads = 1;
  const auto alone = movie_for(folder_ / "1.orcmovie", request_);
  request_.threads = 3;
  const auto together = movie_for(folder_ / "3.orcmovie", request_);
  ASSERT_TRUE(alone && together);
  for (std::uint64_t k = 0; k < alone->frame_count(); ++k) EXPECT_EQ(pixels(*alone, k), pixels(*together, k));
}

TEST_F(MovieTest, IsUsedAgainWhereItFitsAndDrawnAnewWhereNot) {
  int drawings = 0;
  const auto count = [&](std::uint64_t drawn, std::uint64_t all) { drawings += drawn == all; };
  ASSERT_TRUE(movie_for(file_, request_, count));
  EXPECT_EQ(drawings, 1);
  ASSERT_TRUE(movie_for(file_, request_, count));
  EXPECT_EQ(drawings, 1);
  request_.look.tissue = CodedTissue{.axis = 2};
  ASSERT_TRUE(movie_for(file_, request_, count));
  EXPECT_EQ(drawings, 2);
}

TEST_F(MovieTest, LeavesNothingHalfWrittenBehind) {
  ASSERT_TRUE(movie_for(file_, request_));
  {
    auto writer = MovieWriter::create(folder_ / "other.orcmovie", header_for(request_));
    ASSERT_TRUE(writer);
  }
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) ++files;
  EXPECT_EQ(files, 1) << "the finished movie alone";
}

TEST_F(MovieTest, SaysWhatIsWrongWithAFileThatIsNoMovie) {
  EXPECT_FALSE(MovieFile::open(folder_ / "missing.orcmovie"));
  std::filesystem::create_directories(folder_);
  std::ofstream(file_) << "not a movie at all, but long enough to hold a header of a hundred bytes or so";
  const auto garbage = MovieFile::open(file_);
  ASSERT_FALSE(garbage);
  EXPECT_NE(garbage.error().message.find("no orcart movie"), std::string::npos);
  ASSERT_TRUE(movie_for(file_, request_));
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
  const auto cut = MovieFile::open(file_);
  ASSERT_FALSE(cut);
  EXPECT_NE(cut.error().message.find("shorter"), std::string::npos);
}

TEST_F(MovieTest, RefusesAFolderThatCannotBeWritten) {
  EXPECT_FALSE(movie_for("/proc/orcart/none.orcmovie", request_));
}

}  // namespace
}  // namespace orcart
