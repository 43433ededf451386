// An angled scope whose light post is turned during the procedure: the cart follows it, and where it cannot
// it says so and paints nothing.
#include <gtest/gtest.h>

#include <numbers>

#include "firmware-host/app/kept_session.hpp"
#include "firmware-host/app/truth_check.hpp"
#include "firmware-host/offline/offline_painter.hpp"
#include "firmware-host/session/session_reader.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/path/cart_rig.hpp"

namespace orcart::testing {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Three presses at rest, at 1200, 2800 and 4400 ms, while the light post goes from -60 to 60 degrees and
/// back once in four seconds.
RigWish turning(const AngledWish& angled) {
  RigWish wish{.duration_s = 5.4,
               .script = {.press_every_s = 1.6,
                          .undo_at = -1,
                          .stream_at = -1,
                          .hide_at = -1,
                          .turn_rad = 60 * kDegree,
                          .turn_every_s = 4}};
  wish.angled = angled;
  return wish;
}

RigWish still(const AngledWish& angled) {
  RigWish wish = turning(angled);
  wish.script.turn_rad = 0;
  return wish;
}

std::unique_ptr<CartRig> finished(const RigWish& wish) {
  auto rig = CartRig::create(wish);
  if (!rig || !rig->arm()) return nullptr;
  rig->run_to_end();
  return rig;
}

/// Of what the cart painted.
PaintingError painting_error(const CartRig& rig) {
  std::vector<JudgedView> views;
  for (std::size_t i = 0; i < rig.cart->captures().size(); ++i) {
    const CaptureRecord& c = rig.cart->captures().at(i);
    if (c.refusal != Refusal::none) continue;
    views.push_back({.believed = c.X_MC,
                     .true_pose = rig.devices->world().X_MC(c.mid_exposure),
                     .believed_turn_rad = c.turn_rad,
                     .true_turn_rad = rig.devices->world().turn_rad(c.mid_exposure)});
  }
  EXPECT_EQ(views.size(), 3u);
  const auto error = check_painting(rig.patient, views, {.seen_from = rig.config.seen_from});
  if (!error) ADD_FAILURE() << error.error().message;
  return error ? *error : PaintingError{};
}

/// How far beside its place a point on the circle's edge is seen through what the turn is believed to be: the
/// marker's pose is the true one. The worst of all captures and directions.
double edge_error_px(const CartRig& rig) {
  const ScopeModel& scope = rig.patient.scope;
  double worst = 0;
  for (std::size_t i = 0; i < rig.cart->captures().size(); ++i) {
    const CaptureRecord& c = rig.cart->captures().at(i);
    const TurnedOptics truth = optics_at(scope, rig.devices->world().turn_rad(c.mid_exposure)),
                       believed = optics_at(scope, c.turn_rad);
    for (int k = 0; k < 24; ++k) {
      const double angle = 2 * std::numbers::pi * k / 24;
      const Eigen::Vector2d edge(truth.mask.cx_px + 0.97 * truth.mask.radius_px * std::cos(angle),
                                 truth.mask.cy_px + 0.97 * truth.mask.radius_px * std::sin(angle));
      const auto direction = direction_of(truth.lens, edge);
      if (!direction) continue;
      const Point<C> p{20 * *direction};
      const auto seen = project(believed.lens, (believed.X_SC.inverse() * (truth.X_SC * p)).mm);
      worst = std::max(worst, seen ? (*seen - edge).norm() : 1e9);
    }
  }
  return worst;
}

double worst_turn_error_deg(const CartRig& rig) {
  double worst = 0;
  for (std::size_t i = 0; i < rig.cart->captures().size(); ++i) {
    const CaptureRecord& c = rig.cart->captures().at(i);
    const double off =
        std::remainder(c.turn_rad - rig.devices->world().turn_rad(c.mid_exposure), 2 * std::numbers::pi);
    worst = std::max(worst, std::abs(off) / kDegree);
  }
  return worst;
}

void record(const std::string& name, double value) {
  ::testing::Test::RecordProperty(name, std::to_string(value));
  std::printf("  %s %.4f\n", name.c_str(), value);
}

class Followed : public ::testing::TestWithParam<double> {};

/// A scope that is followed while it turns paints as well as one that stands; its edge and angle are
/// recorded.
void expect_paints_as_one_that_stands(const CartRig& stands, const CartRig& turns) {
  EXPECT_GT(std::abs(turns.cart->captures().at(1).turn_rad - turns.cart->captures().at(0).turn_rad), 0.5);
  const PaintingError still_error = painting_error(stands), turned_error = painting_error(turns);
  record("still_mean_mm", still_error.mean_mm);
  record("turned_mean_mm", turned_error.mean_mm);
  record("turned_max_mm", turned_error.max_mm);
  record("edge_px", edge_error_px(turns));
  record("turn_deg", worst_turn_error_deg(turns));
  EXPECT_GT(turned_error.texels, 1000u);
  EXPECT_LE(turned_error.mean_mm, still_error.mean_mm + 0.03);
}

TEST_P(Followed, ByASecondMarkerPaintsAsWellAsAScopeThatStands) {
  const auto stands = finished(still({.view_deg = GetParam()})),
             turns = finished(turning({.view_deg = GetParam()}));
  ASSERT_TRUE(stands && turns);
  expect_paints_as_one_that_stands(*stands, *turns);
  EXPECT_LE(edge_error_px(*turns), 0.2);
}

TEST_P(Followed, ByTheNotchStaysWithinTwoPixelsAtTheCirclesEdge) {
  const auto turns = finished(turning({.view_deg = GetParam(), .follow = TurnSource::notch}));
  ASSERT_TRUE(turns);
  const PaintingError error = painting_error(*turns);
  record("mean_mm", error.mean_mm);
  record("max_mm", error.max_mm);
  record("edge_px", edge_error_px(*turns));
  record("turn_deg", worst_turn_error_deg(*turns));
  EXPECT_LE(error.mean_mm, 0.15);
  EXPECT_LE(edge_error_px(*turns), 2);
}

TEST_P(Followed, ByAnEncoderPaintsAsWellAsAScopeThatStands) {
  const auto stands = finished(still({.view_deg = GetParam()})),
             turns = finished(turning({.view_deg = GetParam(), .follow = TurnSource::encoder}));
  ASSERT_TRUE(stands && turns);
  expect_paints_as_one_that_stands(*stands, *turns);
  EXPECT_LE(worst_turn_error_deg(*turns), 0.15) << "a count of 4,096 is 0.088 degrees";
  EXPECT_LE(edge_error_px(*turns), 1);
}

TEST_P(Followed, NotAtAllPaintsMuchBesideThePlace) {
  const auto turns =
      finished(turning({.view_deg = GetParam(), .follow = TurnSource::told, .most_mismatch_deg = 180}));
  ASSERT_TRUE(turns);
  const PaintingError error = painting_error(*turns);
  record("mean_mm", error.mean_mm);
  record("edge_px", edge_error_px(*turns));
  EXPECT_GT(error.mean_mm, 1.5);
  EXPECT_GT(edge_error_px(*turns), 50);
}

TEST_P(Followed, ByNoisyMarkersStaysWithinTwoPixelsAtTheCirclesEdge) {
  const auto turns = finished(turning({.view_deg = GetParam(), .marker_noise_mm = 0.07}));
  ASSERT_TRUE(turns);
  record("edge_px", edge_error_px(*turns));
  record("turn_deg", worst_turn_error_deg(*turns));
  EXPECT_LE(edge_error_px(*turns), 2);
}

INSTANTIATE_TEST_SUITE_P(Turning, Followed, ::testing::Values(30.0, 70.0));

TEST(TurnUnknown, APressWhileTheSecondMarkerIsHiddenFailsAndThePanelSaysWhy) {
  RigWish wish = turning({});
  wish.script.hide_second_at = 2.5 / 5.4;
  auto rig = CartRig::create(wish);
  ASSERT_TRUE(rig && rig->arm());
  rig->run_until(2700ms);
  const auto before = rig->painting();
  EXPECT_NE(
      std::string(rig->cart->status().notice.text.data()).find("TURN NOT KNOWN: clear the second marker"),
      std::string::npos)
      << rig->cart->status().notice.text.data();
  rig->run_until(3400ms);
  ASSERT_EQ(rig->cart->captures().size(), 2u);
  EXPECT_EQ(rig->cart->captures().at(0).refusal, Refusal::none);
  EXPECT_EQ(rig->cart->captures().at(1).refusal, Refusal::turn_unknown);
  EXPECT_EQ(rig->painting(), before);
  rig->run_to_end();
  ASSERT_EQ(rig->cart->captures().size(), 3u);
  EXPECT_EQ(rig->cart->captures().at(2).refusal, Refusal::none) << "seen again at 3.6 s";
}

TEST(TurnUnknown, APressWithoutANotchInThePictureFailsAndThePanelSaysWhy) {
  auto rig = CartRig::create(turning({.follow = TurnSource::notch}));
  ASSERT_TRUE(rig && rig->arm());
  rig->camera->blacken(rig->at(2500ms), rig->at(3600ms));
  rig->run_until(2750ms);
  const auto before = rig->painting();
  EXPECT_NE(std::string(rig->cart->status().notice.text.data()).find("TURN NOT KNOWN: no notch"),
            std::string::npos)
      << rig->cart->status().notice.text.data();
  rig->run_until(3400ms);
  ASSERT_EQ(rig->cart->captures().size(), 2u);
  EXPECT_EQ(rig->cart->captures().at(1).refusal, Refusal::turn_unknown);
  EXPECT_EQ(rig->painting(), before);
  rig->run_to_end();
  ASSERT_EQ(rig->cart->captures().size(), 3u);
  EXPECT_EQ(rig->cart->captures().at(2).refusal, Refusal::none);
}

TEST(TurnUnknown, APressWhileTheEncoderIsUnpluggedFailsAndSoDoesOneAfterItForItsZeroIsLost) {
  auto rig = CartRig::create(
      turning({.follow = TurnSource::encoder, .encoder = {.gone_at = 2500ms, .back_at = 3600ms}}));
  ASSERT_TRUE(rig);
  rig->patient.scope.notch_rad.reset();  // which would tell the zero
  ASSERT_TRUE(rig->arm());
  rig->run_until(2700ms);
  const auto before = rig->painting();
  EXPECT_NE(std::string(rig->cart->status().notice.text.data()).find("TURN NOT KNOWN: no encoder"),
            std::string::npos)
      << rig->cart->status().notice.text.data();
  EXPECT_EQ(rig->cart->now().encoder, PortFault::disconnected);
  rig->run_until(4200ms);
  EXPECT_NE(std::string(rig->cart->status().notice.text.data()).find("TURN NOT KNOWN: tell it"),
            std::string::npos)
      << rig->cart->status().notice.text.data();
  EXPECT_EQ(rig->cart->now().encoder, PortFault::nothing_yet);
  rig->run_to_end();
  ASSERT_EQ(rig->cart->captures().size(), 3u);
  EXPECT_EQ(rig->cart->captures().at(0).refusal, Refusal::none);
  EXPECT_EQ(rig->cart->captures().at(1).refusal, Refusal::turn_unknown);
  EXPECT_EQ(rig->cart->captures().at(2).refusal, Refusal::turn_unknown);
  EXPECT_EQ(rig->painting(), before);
}

TEST(TurnUnknown, APressAfterTheKernelDroppedTheEncodersStepsFails) {
  auto rig = CartRig::create(turning({.follow = TurnSource::encoder, .encoder = {.lost_at = 2500ms}}));
  ASSERT_TRUE(rig);
  rig->patient.scope.notch_rad.reset();
  ASSERT_TRUE(rig->arm());
  rig->run_to_end();
  ASSERT_EQ(rig->cart->captures().size(), 3u);
  EXPECT_EQ(rig->cart->captures().at(0).refusal, Refusal::none);
  EXPECT_EQ(rig->cart->captures().at(1).refusal, Refusal::turn_unknown);
  EXPECT_EQ(rig->cart->captures().at(2).refusal, Refusal::turn_unknown);
}

TEST(TurnUnknown, AnEncoderThatWasUnpluggedGetsItsZeroByTheNotch) {
  RigWish wish = turning({.follow = TurnSource::encoder,
                          .encoder = {.gone_at = 1500ms, .back_at = 2000ms},
                          .told_rad = std::nullopt});
  wish.camera_hz = 30;
  auto rig = finished(wish);
  ASSERT_TRUE(rig);
  ASSERT_EQ(rig->cart->captures().size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(rig->cart->captures().at(i).refusal, Refusal::none) << i;
  record("turn_deg", worst_turn_error_deg(*rig));
  EXPECT_LE(worst_turn_error_deg(*rig), 0.3);
}

std::string notice_of(const CartRig& rig) {
  return rig.cart->status().notice.text.data();
}

struct Slip {
  TurnSource follow = TurnSource::marker;
  double marker_noise_mm = 0;
  std::string suspect;
};
/// A turn that is told stands, unless a test says otherwise.
class Slipped : public ::testing::TestWithParam<Slip> {
 protected:
  static RigWish wish() {
    const Slip& slip = GetParam();
    const AngledWish angled{.follow = slip.follow, .marker_noise_mm = slip.marker_noise_mm};
    RigWish wish = slip.follow == TurnSource::told ? still(angled) : turning(angled);
    wish.camera_hz = 30;
    return wish;
  }
  static bool mismatch(const Status& status) {
    return std::string(status.notice.text.data()).find("TURN MISMATCH") != std::string::npos;
  }
};

TEST_P(Slipped, IsNoticedWithinASecondAndNothingIsPaintedSince) {
  const bool told = GetParam().follow == TurnSource::told;
  RigWish wish = told ? turning({.follow = TurnSource::told}) : Slipped::wish();
  wish.camera_hz = 30;
  wish.script.slip_second_at = 2.0 / wish.duration_s;
  wish.script.slip_second_rad = 6 * kDegree;
  wish.angled->encoder = {.slip_at = 2000ms, .slip_rad = 6 * kDegree};
  auto rig = CartRig::create(wish);
  ASSERT_TRUE(rig && rig->arm());
  const Instant slipped = rig->at(told ? 0ms : 2000ms);  // what was told is wrong from the start
  rig->run_until(slipped - rig->at(0ms));
  EXPECT_EQ(rig->cart->now().mismatch_deg, 0);
  const Nanos noticed = rig->until(slipped, mismatch);
  record("noticed_after_s", seconds(noticed));
  EXPECT_LE(noticed, 1s);
  EXPECT_NE(notice_of(*rig).find(GetParam().suspect), std::string::npos) << notice_of(*rig);
  if (!told) {
    EXPECT_NE(notice_of(*rig).find(" 6 deg"), std::string::npos) << notice_of(*rig);
    EXPECT_EQ(rig->cart->now().mismatch_deg, -6);
  }
  const auto before = rig->painting();
  rig->run_to_end();
  ASSERT_EQ(rig->cart->captures().size(), 3u);
  EXPECT_EQ(rig->cart->captures().at(1).refusal, Refusal::turn_mismatch);
  EXPECT_EQ(rig->cart->captures().at(2).refusal, Refusal::turn_mismatch);
  EXPECT_EQ(rig->painting(), before);
}

TEST_P(Slipped, IsNotSuspectedWhereNothingSlips) {
  auto rig = CartRig::create(Slipped::wish());
  ASSERT_TRUE(rig && rig->arm());
  EXPECT_EQ(rig->until(rig->at(0ms), mismatch), Nanos::max());
  rig->run_to_end();
  ASSERT_EQ(rig->cart->captures().size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(rig->cart->captures().at(i).refusal, Refusal::none) << i;
}

INSTANTIATE_TEST_SUITE_P(Turning, Slipped,
                         ::testing::Values(Slip{TurnSource::marker, 0.07, "marker slipped?"},
                                           Slip{TurnSource::encoder, 0, "encoder slipped?"},
                                           Slip{TurnSource::told, 0, "head turned?"}));

TEST(TurnedSession, IsPaintedAgainFromTheRecordingToTheByte) {
  const TemporaryFolder folder;
  const auto file = folder / "procedure.orcart";
  auto rig = CartRig::create(turning({.follow = TurnSource::notch}));
  ASSERT_TRUE(rig);
  rig->config.highlights = Highlights::keep;
  rig->config.light = LightModel::as_seen;
  const std::filesystem::path passport = rig->config.scope;
  ASSERT_TRUE(write_scope(passport, rig->patient.scope));
  auto session = KeptSession::create(
      {.file = file, .config = rig->config, .patient = rig->patient, .started_at = rig->clock.now()});
  std::filesystem::remove(passport);
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_TRUE(rig->arm(&(*session)->stage()));
  rig->run_to_end();
  rig->cart->stop();
  const auto painted = rig->painting();

  auto reader = SessionReader::open(file);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto kept = reader->captures().value();
  ASSERT_EQ(kept.size(), 3u);
  const auto again_from = [&](bool followed) {
    auto painter =
        OfflinePainter::create(rig->patient.surface, rig->patient.scope,
                               {.seen_from = rig->config.seen_from, .texel_mm = rig->config.texel_mm});
    EXPECT_TRUE(painter) << painter.error().message;
    for (const StoredCapture& capture : kept) {
      auto picture = reader->picture(capture.id).value();
      EXPECT_TRUE(
          painter->paint(picture.descriptor(), capture.facts.X_MC, followed ? capture.facts.turn_rad : 0));
    }
    return painter->painter().read_back().rgba;
  };
  for (std::size_t i = 0; i < kept.size(); ++i)
    EXPECT_EQ(kept[i].facts.turn_rad, rig->cart->captures().at(i).turn_rad);
  EXPECT_EQ(again_from(true), painted);
  EXPECT_NE(again_from(false), painted);
}

}  // namespace
}  // namespace orcart::testing
