// The session file of a run: made whole or not at all, and never over another.
#include "firmware-host/app/kept_session.hpp"

#include <gtest/gtest.h>

#include "firmware-host/session/session_reader.hpp"
#include "tests/firmware-host/app/demo_cart.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart::testing {
namespace {

class KeptSessionTest : public ::testing::Test {
 protected:
  Result<std::unique_ptr<KeptSession>> create() {
    return KeptSession::create(
        {.file = file, .config = config, .patient = patient, .started_at = instant_from_nanos(5)});
  }

  TemporaryFolder folder;
  std::filesystem::path file = folder / "run.orcart";
  CartConfig config = read_cart(demo_cart()).value();
  Patient patient;
};

TEST_F(KeptSessionTest, RefusesAFileThatExistsAndLeavesItAlone) {
  folder.write("run.orcart", "somebody's");
  const auto session = create();
  ASSERT_FALSE(session);
  EXPECT_NE(session.error().message.find(file.string()), std::string::npos) << session.error().message;
  EXPECT_EQ(text_of(file), "somebody's");
}

TEST_F(KeptSessionTest, MakesANewFileInAFolderAtEachStart) {
  file = folder / "";
  const std::string utc = "2026-01-31T10:20:30Z";
  EXPECT_EQ(session_file(folder / "new.orcart", utc), folder / "new.orcart");
  EXPECT_EQ(session_file(file, utc), folder / "2026-01-31T102030Z.orcart");
  folder.write("2026-01-31T102030Z.orcart", "the first start's");
  EXPECT_EQ(session_file(file, utc), folder / "2026-01-31T102030Z-2.orcart") << "again within a second";

  const auto first = create();
  ASSERT_TRUE(first) << first.error().message;
  const auto second = create();
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_NE((*first)->sentence(), (*second)->sentence());
  EXPECT_EQ(text_of(folder / "2026-01-31T102030Z.orcart"), "the first start's");
}

TEST_F(KeptSessionTest, TakesItsFileAwayWhereTheRunNeverCameAbout) {
  ASSERT_TRUE(create());
  EXPECT_EQ(folder.count(), 0u);
}

TEST_F(KeptSessionTest, HoldsCalibrationAndBudgetsOnceFinished) {
  patient.surface.identity.hash = "0123456789abcdef0123456789abcdef";
  {
    auto session = create();
    ASSERT_TRUE(session) << session.error().message;
    std::array<StageLedger, kStageCount> ledgers{
        StageLedger("a"), StageLedger("b"), StageLedger("c"),
        StageLedger("d"), StageLedger("e"), StageLedger("f"),
        StageLedger("g"), StageLedger("h"), StageLedger("i", {.p999 = 1ms, .bound = 2ms})};
    ledgers.back().record({.at = Instant{}, .wall = 3ms, .cpu = 1ms}, {.worked = true});
    ASSERT_TRUE((*session)->finish(ledgers));
    EXPECT_EQ((*session)->sentence(), "Session: " + file.string() + ", 0 captures kept, none lost.\n");
  }
  auto reader = SessionReader::open(file);
  ASSERT_TRUE(reader) << reader.error().message;
  const SessionCalibration calibration = reader->calibration().value();
  EXPECT_EQ(calibration.surface_hash, patient.surface.identity.hash);
  EXPECT_EQ(calibration.scope_toml, text_of(config.scope));
  EXPECT_EQ(calibration.registration_toml, text_of(config.registration));
  EXPECT_EQ(reader->meta().value().started_at, instant_from_nanos(5));
  EXPECT_FALSE(reader->meta().value().turn_deviation_rad) << "a scope in one piece";
  const auto budgets = reader->budgets().value();
  ASSERT_EQ(budgets.size(), kStageCount);
  EXPECT_EQ(budgets.back().stage, "i");
  EXPECT_EQ(budgets.back().max, 3ms);
  EXPECT_EQ(budgets.back().misses, 1u);
}

TEST_F(KeptSessionTest, SaysHowWellATurnIsKnown) {
  config.turn = TurnSource::notch;
  patient.scope.turning = Turning{.notch_deviation_rad = 0.0025};
  auto session = create();
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_EQ(SessionReader::open(file).value().meta().value().turn_deviation_rad, 0.0025);
}

}  // namespace
}  // namespace orcart::testing
