// What is written to a session is what is read from it; what cannot be written or read is told in one
// sentence.
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>

#include <gtest/gtest.h>

#include "firmware-host/session/session_reader.hpp"
#include "firmware-host/session/session_writer.hpp"
#include "tests/firmware-host/session/full_disk.hpp"
#include "tests/firmware-host/session/session_samples.hpp"

namespace orcart {
namespace {

using testing::facts_number;
using testing::frame_number;
using testing::FullDisk;
using testing::SessionFolder;

constexpr std::size_t kBytes = packed_bytes(PixelFormat::yuyv, testing::kWidth_px, testing::kHeight_px);

SessionMeta some_meta() {
  return {.application_version = "0.1.0",
          .config_hash = "ab12",
          .started_utc = "2026-05-04T09:30:00Z",
          .started_at = instant_from_nanos(77),
          .tracker_against_video = -12ms,
          .tracker_against_video_deviation = 1500us,
          .turn_rad = -0.25,
          .turn_deviation_rad = 0.0025};
}

class SessionFile : public ::testing::Test {
 protected:
  SessionWriter writer() {
    auto made = SessionWriter::create(file_, some_meta());
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
  }
  SessionReader reader() {
    auto opened = SessionReader::open(file_);
    EXPECT_TRUE(opened) << opened.error().message;
    return std::move(*opened);
  }
  void offer(std::uint32_t number) {
    auto bytes = testing::picture_bytes(number);
    ASSERT_TRUE(slots_.offer(frame_number(number, bytes), facts_number(number)));
  }

  SessionFolder folder_;
  std::filesystem::path file_ = folder_ / "a.orcart";
  CaptureSlots slots_{4, kBytes};
};

TEST_F(SessionFile, KeepsACaptureToTheLastBit) {
  SessionWriter session = writer();
  offer(3);
  ASSERT_EQ(session.write_pending(slots_), 1U);
  SessionReader read = reader();
  const auto captures = read.captures();
  ASSERT_TRUE(captures) << captures.error().message;
  ASSERT_EQ(captures->size(), 1U);
  const StoredCapture& c = captures->front();
  const CaptureFacts expected = facts_number(3);
  EXPECT_EQ(c.id, 1);
  EXPECT_EQ(c.frame_sequence, 1003U);
  EXPECT_EQ(c.facts.unit, 3U);
  EXPECT_FALSE(c.facts.streaming);
  EXPECT_EQ(c.facts.edge_at, expected.edge_at);
  EXPECT_EQ(c.exposure_start, instant_from_nanos(3'000'000'001));
  EXPECT_EQ(c.exposure_end, c.exposure_start + 8ms);
  EXPECT_EQ(c.dequeued_at, c.exposure_end + 2ms);
  EXPECT_EQ(c.facts.matched_at, expected.matched_at);
  EXPECT_EQ(c.facts.painted_at, expected.painted_at);
  EXPECT_EQ(c.facts.pose_kind, PoseKind::interpolated);
  EXPECT_EQ(c.facts.pose_distance, 3ns);
  EXPECT_EQ(c.facts.X_MC.rotation, expected.X_MC.rotation);
  EXPECT_EQ(c.facts.X_MC.translation_mm, expected.X_MC.translation_mm);
  EXPECT_EQ(c.facts.turn_rad, expected.turn_rad);
  ASSERT_TRUE(c.facts.velocity);
  EXPECT_EQ(*c.facts.velocity, *expected.velocity);
  EXPECT_FALSE(c.undone);

  const auto picture = read.picture(1);
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(picture->width_px, testing::kWidth_px);
  EXPECT_EQ(picture->format, PixelFormat::yuyv);
  EXPECT_EQ(picture->bytes, testing::picture_bytes(3));
}

TEST_F(SessionFile, MarksEveryPictureOfAnUndoneUnitAndNoOther) {
  SessionWriter session = writer();
  offer(1);
  offer(2);
  ASSERT_TRUE(slots_.undone(1));
  offer(3);
  ASSERT_EQ(session.write_pending(slots_), 3U);
  ASSERT_TRUE(slots_.undone(3));
  ASSERT_EQ(session.write_pending(slots_), 0U);
  const auto captures = reader().captures();
  ASSERT_EQ(captures->size(), 3U);
  EXPECT_TRUE(captures->at(0).undone);
  EXPECT_FALSE(captures->at(1).undone);
  EXPECT_TRUE(captures->at(2).undone);
}

TEST_F(SessionFile, KeepsMetaCalibrationAndBudgets) {
  SessionWriter session = writer();
  ASSERT_TRUE(session.write_calibration({.scope_toml = "old"}));
  ASSERT_TRUE(session.write_calibration(
      {.scope_toml = "name = \"30 degree\"", .registration_toml = "fre_mm = 0.4", .surface_hash = "cafe"}));
  const std::vector<SessionBudget> first{{.stage = "mapper", .count = 1}};
  const std::vector<SessionBudget> budgets{
      {.stage = "mapper", .count = 9, .p50 = 1ms, .p99 = 2ms, .max = 3ms, .misses = 4}, {.stage = "panel"}};
  ASSERT_TRUE(session.write_budgets(first));
  ASSERT_TRUE(session.write_budgets(budgets));

  SessionReader read = reader();
  EXPECT_EQ(read.meta()->config_hash, "ab12");
  EXPECT_EQ(read.meta()->application, "orcartd");
  EXPECT_EQ(read.meta()->started_utc, "2026-05-04T09:30:00Z");
  EXPECT_EQ(read.meta()->started_at, instant_from_nanos(77));
  EXPECT_EQ(read.meta()->tracker_against_video, -12ms);
  EXPECT_EQ(read.meta()->tracker_against_video_deviation, Nanos(1500us));
  EXPECT_DOUBLE_EQ(read.meta()->turn_rad, -0.25);
  EXPECT_DOUBLE_EQ(read.meta()->turn_deviation_rad.value(), 0.0025);
  EXPECT_EQ(read.calibration()->scope_toml, "name = \"30 degree\"");
  EXPECT_EQ(read.calibration()->surface_hash, "cafe");
  ASSERT_EQ(read.budgets()->size(), 2U);
  EXPECT_EQ(read.budgets()->front().stage, "mapper");
  EXPECT_EQ(read.budgets()->front().p99, 2ms);
  EXPECT_EQ(read.budgets()->front().misses, 4U);
  EXPECT_TRUE(read.check());
}

TEST_F(SessionFile, KeepsAVelocityThatIsNotKnownAsNone) {
  SessionWriter session = writer();
  offer(2);
  offer(3);
  offer(4);
  ASSERT_TRUE(session.write_pending(slots_));
  const auto captures = reader().captures();
  ASSERT_EQ(captures->size(), 3U);
  EXPECT_FALSE(captures->at(0).facts.velocity);
  EXPECT_TRUE(captures->at(1).facts.velocity);
  EXPECT_FALSE(captures->at(2).facts.velocity);
}

TEST_F(SessionFile, OfTheFormWithoutVelocitiesIsReadWithoutThem) {
  {
    SessionWriter session = writer();
    offer(3);
    ASSERT_TRUE(session.write_pending(slots_));
  }
  {
    auto database = Database::open(file_, Database::Mode::write);
    ASSERT_TRUE(database);
    for (int i = 0; i < 6; ++i)
      ASSERT_TRUE(database->run("ALTER TABLE captures DROP COLUMN v" + std::to_string(i)));
    for (const std::string key : {"tracker_against_video_deviation_ns", "turn_deviation_nrad"})
      ASSERT_TRUE(database->run("DELETE FROM meta WHERE key = '" + key + "'"));
    ASSERT_TRUE(database->run("PRAGMA user_version = 2"));
  }
  SessionReader read = reader();
  const auto captures = read.captures();
  ASSERT_TRUE(captures) << captures.error().message;
  EXPECT_FALSE(captures->front().facts.velocity);
  EXPECT_EQ(captures->front().facts.turn_rad, facts_number(3).turn_rad);
  EXPECT_FALSE(read.meta()->tracker_against_video_deviation);
  EXPECT_FALSE(read.meta()->turn_deviation_rad);
  EXPECT_EQ(read.meta()->tracker_against_video, -12ms);
}

TEST_F(SessionFile, OfTheFormWithoutTurnsIsReadAsOneThatStood) {
  {
    SessionWriter session = writer();
    offer(3);
    ASSERT_TRUE(session.write_pending(slots_));
  }
  {
    auto database = Database::open(file_, Database::Mode::write);
    ASSERT_TRUE(database);
    for (const char* column : {"turn_rad", "v0", "v1", "v2", "v3", "v4", "v5"})
      ASSERT_TRUE(database->run(std::string("ALTER TABLE captures DROP COLUMN ") + column));
    ASSERT_TRUE(database->run("PRAGMA user_version = 1"));
  }
  SessionReader read = reader();
  const auto captures = read.captures();
  ASSERT_TRUE(captures) << captures.error().message;
  ASSERT_EQ(captures->size(), 1U);
  EXPECT_EQ(captures->front().facts.turn_rad, 0);
  EXPECT_EQ(captures->front().facts.X_MC.translation_mm, facts_number(3).X_MC.translation_mm);
}

TEST_F(SessionFile, MayBeReadByItsOwnerAlone) {
  SessionWriter session = writer();
  offer(1);
  ASSERT_TRUE(session.write_pending(slots_));
  for (const char* suffix : {"", "-wal", "-shm"}) {
    struct stat status {};
    ASSERT_EQ(stat((file_.string() + suffix).c_str(), &status), 0) << suffix;
    EXPECT_EQ(status.st_mode & 0777U, 0600U) << suffix;
  }
}

TEST_F(SessionFile, IsOneFileOnceItsWriterIsDone) {
  { SessionWriter session = writer(); }
  EXPECT_TRUE(std::filesystem::exists(file_));
  EXPECT_FALSE(std::filesystem::exists(file_.string() + "-wal"));
}

/// How a reader without rights on the folder fares: its complaint, or how many captures it found.
std::string read_without_rights(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const uid_t me = geteuid();
  if (me == 0 && chown(file.c_str(), 65534, 65534) != 0) return "cannot give the file away";
  if (me == 0 && chown(folder.c_str(), 65534, 65534) != 0) return "cannot give the folder away";
  chmod(folder.c_str(), 0500);
  if (me == 0 && seteuid(65534) != 0) return "cannot be somebody else";  // root may write everywhere
  std::string told;
  {
    auto opened = SessionReader::open(file);
    const auto captures = opened ? opened->captures() : tl::unexpected(opened.error());
    told = captures ? std::to_string(captures->size()) : captures.error().message;
  }
  if (me == 0 && seteuid(me) != 0) told += " and stays somebody else";
  chmod(folder.c_str(), 0700);
  return told;
}

TEST_F(SessionFile, IsReadInAFolderThatMayNotBeWrittenToFinishedOrNot) {
  for (const bool finished : {true, false}) {
    {
      SessionWriter session = writer();
      offer(1);
      ASSERT_EQ(session.write_pending(slots_), 1U);
      if (finished) session.leave_wal();
    }
    EXPECT_EQ(read_without_rights(folder_.path(), file_), "1") << finished;
    std::filesystem::remove(file_);
  }
}

TEST_F(SessionFile, TellsWhyItCannotBeReadWhereItsLogStandsBesideItInSuchAFolder) {
  SessionWriter session = writer();
  offer(1);
  ASSERT_EQ(session.write_pending(slots_), 1U);
  const auto copy = folder_ / "copies";
  std::filesystem::create_directory(copy);
  chmod(folder_.path().c_str(), 0755);  // somebody else gets as far as there
  for (const char* suffix : {"", "-wal"})
    std::filesystem::copy(file_.string() + suffix, (copy / "a.orcart").string() + suffix);
  const std::string told = read_without_rights(copy, copy / "a.orcart");
  EXPECT_TRUE(told.starts_with((copy / "a.orcart").string() + ": ")) << told;
  EXPECT_EQ(told.find("is no session file"), std::string::npos) << told;
}

TEST_F(SessionFile, LeavesWalModeOnceFinished) {
  {
    SessionWriter session = writer();
    session.leave_wal();
  }
  std::ifstream file(file_, std::ios::binary);
  std::array<char, 20> header{};
  file.read(header.data(), header.size());
  EXPECT_EQ(header[18], 1) << "2 is WAL mode";
}

TEST_F(SessionFile, IsNeverWrittenOver) {
  std::ofstream(file_) << "precious";
  const auto made = SessionWriter::create(file_, some_meta());
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("exists already"), std::string::npos) << made.error().message;
  EXPECT_EQ(std::filesystem::file_size(file_), 8U);
}

TEST_F(SessionFile, TellsWhereItCannotBeMade) {
  const auto made = SessionWriter::create(folder_ / "missing" / "a.orcart", some_meta());
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("No such file or directory"), std::string::npos)
      << made.error().message;
}

TEST_F(SessionFile, TellsThatItsFolderMayNotBeWrittenTo) {
  const uid_t me = geteuid();
  chmod(folder_.path().c_str(), 0500);
  ASSERT_EQ(me == 0 ? seteuid(65534) : 0, 0);  // root may write everywhere; nobody may not
  const auto made = SessionWriter::create(file_, some_meta());
  ASSERT_EQ(me == 0 ? seteuid(me) : 0, 0);
  chmod(folder_.path().c_str(), 0700);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("Permission denied"), std::string::npos) << made.error().message;
}

TEST_F(SessionFile, ReturnsAnErrorOnAFullDiskLosesNothingWrittenAndGoesOnWhenThereIsRoom) {
  SessionWriter session = writer();
  offer(1);
  ASSERT_EQ(session.write_pending(slots_), 1U);
  {
    const FullDisk full(std::filesystem::file_size(file_.string() + "-wal"));
    offer(2);
    offer(3);
    const auto written = session.write_pending(slots_);
    ASSERT_FALSE(written);
    EXPECT_TRUE(written.error().message.starts_with(file_.string())) << written.error().message;
    EXPECT_EQ(session.lost(), 2U);
  }
  for (std::uint32_t i = 4; i < 8; ++i) offer(i);  // every slot came home
  ASSERT_EQ(session.write_pending(slots_), 4U);
  SessionReader read = reader();
  ASSERT_TRUE(read.check());
  const auto captures = read.captures();
  ASSERT_EQ(captures->size(), 5U);
  EXPECT_EQ(captures->at(0).facts.unit, 1U);
  EXPECT_EQ(captures->at(1).facts.unit, 4U);
}

TEST_F(SessionFile, LeavesNothingBehindWhereItCannotBeBegun) {
  const FullDisk full(1000);
  EXPECT_FALSE(SessionWriter::create(file_, some_meta()));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(SessionFile, RefusesWhatIsNoSession) {
  EXPECT_FALSE(SessionReader::open(folder_ / "missing.orcart"));
  EXPECT_FALSE(SessionReader::open(folder_.path()));
  std::ofstream(folder_ / "empty.orcart").flush();
  std::ofstream(folder_ / "garbage.orcart") << std::string(5000, 'x');
  for (const char* name : {"empty.orcart", "garbage.orcart"}) {
    const auto opened = SessionReader::open(folder_ / name);
    ASSERT_FALSE(opened) << name;
    EXPECT_NE(opened.error().message.find("orcartd (*.orcart) is accepted"), std::string::npos)
        << opened.error().message;
  }
}

TEST_F(SessionFile, RefusesALaterForm) {
  { SessionWriter session = writer(); }
  {
    auto database = Database::open(file_, Database::Mode::write);
    ASSERT_TRUE(database->run("PRAGMA user_version = 4"));
  }
  const auto opened = SessionReader::open(file_);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("has form 4; forms 1 to 3 are accepted"), std::string::npos);
}

TEST_F(SessionFile, RefusesADamagedPictureByItsNumber) {
  {
    SessionWriter session = writer();
    offer(1);
    ASSERT_TRUE(session.write_pending(slots_));
  }
  const auto damaged_by = [&](const char* sql) {
    {
      auto database = Database::open(file_, Database::Mode::write);
      EXPECT_TRUE(database->run(sql));
    }
    const auto picture = reader().picture(1);
    return picture ? std::string() : picture.error().message;
  };
  EXPECT_NE(damaged_by("UPDATE pictures SET bytes = zeroblob(500)").find("capture 1"), std::string::npos);
  EXPECT_NE(damaged_by("UPDATE pictures SET width_px = 2000000000").find("not believed"), std::string::npos);
  EXPECT_NE(damaged_by("UPDATE pictures SET width_px = 48, encoding = 'png'").find("'png'"),
            std::string::npos);
  EXPECT_NE(damaged_by("DELETE FROM pictures").find("no such capture"), std::string::npos);
}

TEST(UtcNow, IsAnIsoDate) {
  const std::string now = utc_now();
  ASSERT_EQ(now.size(), 20U);
  EXPECT_EQ(now[10], 'T');
  EXPECT_EQ(now[19], 'Z');
}

}  // namespace
}  // namespace orcart
