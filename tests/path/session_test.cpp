// What a procedure leaves on disk: every painted capture, and what became of it.
#include <gtest/gtest.h>

#include "firmware-host/app/kept_session.hpp"
#include "firmware-host/session/session_reader.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/path/cart_rig.hpp"

namespace orcart::testing {
namespace {

TEST(Session, HoldsEveryPaintedCaptureOfTheProcedure) {
  const TemporaryFolder folder;
  const auto file = folder / "procedure.orcart";
  auto rig = CartRig::create(presses());
  ASSERT_TRUE(rig);
  auto session = KeptSession::create(
      {.file = file, .config = rig->config, .patient = rig->patient, .started_at = rig->clock.now()});
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_TRUE(rig->arm(&(*session)->stage()));
  rig->run_to_end();
  rig->cart->stop();
  ASSERT_TRUE((*session)->finish(rig->cart->stage_ledgers()));
  EXPECT_EQ((*session)->sentence(), "Session: " + file.string() + ", 3 captures kept, none lost.\n");

  auto reader = SessionReader::open(file);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto kept = reader->captures().value();
  ASSERT_EQ(kept.size(), 3u);  // the fourth press was refused
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const CaptureRecord& c = rig->cart->captures().at(i);
    EXPECT_EQ(kept[i].facts.unit, c.unit) << i;
    EXPECT_EQ(kept[i].facts.edge_at, c.edge_at) << i;
    EXPECT_EQ(kept[i].undone, c.undone) << i;
    EXPECT_TRUE(kept[i].facts.velocity) << i;
    EXPECT_TRUE(kept[i].facts.X_MC.translation_mm == c.X_MC.translation_mm) << i;
    EXPECT_EQ(reader->picture(kept[i].id).value().bytes.size(), 640u * 480u * 2u) << i;
  }
  EXPECT_NE(reader->picture(kept[0].id).value().bytes, reader->picture(kept[2].id).value().bytes);
  EXPECT_EQ(reader->calibration().value().surface_hash, rig->patient.surface.identity.hash);
  EXPECT_EQ(reader->budgets().value().size(), kStageCount);
}

TEST(Session, KnowsHowTheScopeMovedAtEachCaptureOfAStream) {
  RigWish wish = presses();
  wish.holds = {{.from = 500ms, .until = 4500ms}};  // from place to place
  auto rig = CartRig::create(wish);
  ASSERT_TRUE(rig);
  ASSERT_TRUE(rig->arm());
  rig->run_to_end();
  const auto& captures = rig->cart->captures();
  std::size_t compared = 0;
  double fastest_mm_s = 0;
  for (std::size_t i = 1; i < captures.size(); ++i) {
    const CaptureRecord &before = captures.at(i - 1), &here = captures.at(i);
    if (!before.streaming || !here.streaming || before.unit != here.unit) continue;
    ASSERT_TRUE(here.velocity) << i;
    const Twist between =
        twist_between(before.X_MC, here.X_MC) / seconds(here.mid_exposure - before.mid_exposure);
    // The marker's samples reach from a tenth of a second before to the one next after.
    EXPECT_LT((here.velocity->head<3>() - between.head<3>()).norm(), 1 + 0.3 * between.head<3>().norm()) << i;
    EXPECT_LT((here.velocity->tail<3>() - between.tail<3>()).norm(), 0.01 + 0.3 * between.tail<3>().norm())
        << i;
    fastest_mm_s = std::max(fastest_mm_s, between.head<3>().norm());
    ++compared;
  }
  EXPECT_GE(compared, 3U);
  EXPECT_GT(fastest_mm_s, 3);
}

}  // namespace
}  // namespace orcart::testing
