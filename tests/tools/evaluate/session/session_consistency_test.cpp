// Sessions written as a cart writes them: captures in their place, a reference that slips on the way,
// captures that were undone.
#include "tools/evaluate/session/session_consistency.hpp"
#include "realtime/optics/scope_turn.hpp"

#include <gtest/gtest.h>

#include <array>

#include "board/sim/tissue.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "firmware-host/files/views_file.hpp"
#include "firmware-host/session/session_writer.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tests/tools/evaluate/ball_scene.hpp"
#include "tools/evaluate/error_chain.hpp"
#include "tools/evaluate/session/session_export.hpp"
#include "tools/evaluate/stated_errors.hpp"
#include "tools/registration/poses_file.hpp"

namespace orcart {
namespace {

/// Captures of a hollow ball's wall, a few degrees apart.
class SessionConsistency : public ::testing::Test {
 protected:
  static constexpr int kWidth = 640, kHeight = 480;

  void SetUp() override {
    const Surface surface = *make_surface(ball_.mesh, "ball");
    hash_ = surface.identity.hash;
    ASSERT_TRUE(write_ply(folder_ / "ball.ply", surface));
    ball_.scope.calibrated_on = "2026-01-01";
    ASSERT_TRUE(write_scope(folder_ / "scope.toml", ball_.scope));
    ASSERT_TRUE(write_registration(folder_ / "registration.toml",
                                   {.X_MR = ball_.scene().X_MR, .surface_hash = hash_}));
  }

  static std::string text_of_file(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  Pose<M, C> pose(int number) const {
    Twist twist = Twist::Zero();
    twist[3] = 0.06 * number;
    Pose<M, C> X_MC = moved(Pose<M, C>{}, twist);
    X_MC.translation_mm = {0, 0, 14};
    return X_MC;
  }

  /// Its lens 40 px beside what the picture goes round.
  ScopeModel angled() const {
    ScopeModel scope = ball_.scope;
    scope.turning = Turning{.centre_px = {290, 266},
                            .axis = Eigen::Vector3d(0, 0.02, 1).normalized(),
                            .axis_point_mm = {5, 0, 0}};
    scope.turning->marker = TurnMarker::head;
    return scope;
  }

  /// Luma of mottled tissue, YUYV.
  std::vector<std::byte> picture(const Pose<M, C>& X_MC, double turn_rad) const {
    const Lens lens = optics_at(ball_.scope, turn_rad).lens;
    std::vector<std::byte> bytes(packed_bytes(PixelFormat::yuyv, kWidth, kHeight), std::byte{128});
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        int grey = 0;
        if (const auto direction = direction_of(lens, {x, y})) {
          const Eigen::Vector3f along = (X_MC.rotation * *direction).cast<float>(),
                                from = X_MC.translation_mm.cast<float>();
          if (const auto hit = ball_.rays.nearest(from, along, 100))
            grey = static_cast<int>(
                255 *
                tissue_colour(from + hit->distance_mm * along, 1).dot(Eigen::Vector3f(0.3F, 0.6F, 0.1F)));
        }
        bytes[2 * static_cast<std::size_t>(y * kWidth + x)] = static_cast<std::byte>(grey);
      }
    return bytes;
  }

  struct Taken {
    int number = 0;
    double wrong_mm = 0;  ///< believed so far beside the truth, along x
    bool undone = false;
    double turn_rad = 0;
    double speed_mm_s = 0;  ///< along the picture's x
  };

  std::filesystem::path write_session(const std::vector<Taken>& all) {
    const auto file = folder_ / ("s" + std::to_string(++sessions_) + ".orcart");
    SessionWriter writer = SessionWriter::create(file, {.started_utc = "2026-01-01T00:00:00Z",
                                                        .started_at = instant_from_nanos(0),
                                                        .tracker_against_video_deviation = deviation_,
                                                        .turn_deviation_rad = turn_deviation_rad_})
                               .value();
    EXPECT_TRUE(writer.write_calibration({.scope_toml = text_of_file(folder_ / "scope.toml"),
                                          .registration_toml = text_of_file(folder_ / "registration.toml"),
                                          .surface_hash = hash_}));
    CaptureSlots slots(2, packed_bytes(PixelFormat::yuyv, kWidth, kHeight));
    std::uint32_t unit = 0;
    for (const Taken& taken : all) {
      auto bytes = picture(pose(taken.number), taken.turn_rad);
      CapturedFrame frame{.sequence = unit};
      frame.image = packed_image(bytes.data(), PixelFormat::yuyv, kWidth, kHeight);
      CaptureFacts facts{.unit = ++unit};
      frame.exposure_start = instant_from_nanos(10'000'000'000LL * unit);
      facts.X_MC = pose(taken.number);
      facts.X_MC.translation_mm.x() += taken.wrong_mm;
      facts.turn_rad = taken.turn_rad;
      facts.velocity = taken.speed_mm_s * Twist::Unit(0);
      EXPECT_TRUE(slots.offer(frame, facts));
      if (taken.undone) {
        EXPECT_TRUE(slots.undone(unit));
      }
      EXPECT_TRUE(writer.write_pending(slots));
    }
    return file;
  }

  SessionCommand command(const std::filesystem::path& session) const {
    const auto share = std::filesystem::path(std::getenv("ORCART_SOURCE_DIR")) / "share/tools";
    return {.session = session,
            .surface = folder_ / "ball.ply",
            .scope_rom = share / "scope.rom",
            .reference_rom = share / "reference.rom"};
  }

  static Result<SessionReport> evaluated(const SessionCommand& command) {
    return evaluate_session(command, [](const std::string&, double) {});
  }

  BallScene ball_;
  TemporaryFolder folder_;
  std::string hash_;
  int sessions_ = 0;
  std::optional<Nanos> deviation_;
  std::optional<double> turn_deviation_rad_;
};

TEST_F(SessionConsistency, CapturesInTheirPlaceRaiseNoAlarm) {
  auto ask = command(write_session({{0}, {1}, {2}, {3}}));
  ask.page = folder_ / "page";
  const auto report = evaluated(ask);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->captures, 4U);
  EXPECT_EQ(report->pairs.size() + report->without_overlap + report->unmatched, 6U);  // 1 + 2 + 3
  EXPECT_GE(report->pairs.size(), 4U);
  EXPECT_EQ(report->alarms(), 0U);
  EXPECT_FALSE(report->break_in_time());
  EXPECT_NEAR(report->pairs.front().second_s, 20, 1e-9);
  EXPECT_NE(text_of(*report).find("no alarm"), std::string::npos);
  EXPECT_NE(text_of(*report).find("cannot see a shift that both pictures share"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "page/consistency.html"));
}

TEST_F(SessionConsistency, AReferenceThatSlipsIsFoundInTime) {
  // 1.3 mm from the third capture on, against 0.5 predicted.
  const auto report = evaluated(command(write_session({{0}, {1}, {2, 1.3}, {3, 1.3}})));
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_GE(report->alarms(), 2U);
  const auto gap = report->break_in_time();
  ASSERT_TRUE(gap) << text_of(*report);
  EXPECT_EQ(gap->after, "capture 2");
  EXPECT_EQ(gap->before, "capture 3");
  EXPECT_NEAR(gap->from_s, 20, 1e-9);
  for (const SessionPair& pair : report->pairs)
    if (pair.first_s > 25 || pair.second_s < 25) {
      EXPECT_FALSE(pair.pair.alarm()) << pair.pair.first;
    }
  EXPECT_NE(text_of(*report).find("ALARM"), std::string::npos);
  EXPECT_NE(json_of(*report).find("\"break\": true"), std::string::npos);
}

TEST_F(SessionConsistency, TheTimesErrorGrowsWithTheSpeedOfEachCaptureAndTheSessionsDeviation) {
  const auto predicted = [&](double speed_mm_s) {
    const auto report =
        evaluated(command(write_session({{.number = 0}, {.number = 1, .speed_mm_s = speed_mm_s}})));
    EXPECT_EQ(report->pairs.size(), 1U);
    EXPECT_EQ(report->velocities.stored, 2U);
    return report->pairs.front().pair.predicted_mm;
  };
  deviation_ = 5ms;
  const double still = predicted(0), moving = predicted(100);
  // 100 mm/s by 5 ms, along the wall as the picture's x lies on it.
  EXPECT_NEAR(std::sqrt(moving * moving - still * still), 0.5, 0.03);
  const auto report = evaluated(command(write_session({{0}, {1}})));
  EXPECT_NE(text_of(*report).find("time 5.0 ms (session)"), std::string::npos) << text_of(*report);
  auto told = command(write_session({{0}, {1}}));
  told.model = with_time(told.model, 0.001);
  EXPECT_NE(text_of(*evaluated(told)).find("time 1.0 ms (told)"), std::string::npos);
}

TEST_F(SessionConsistency, AShiftBeyondTheSearchIsToldAsNoMatch) {
  const auto report = evaluated(command(write_session({{0}, {0, 5}})));
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->unmatched, 1U) << text_of(*report);
  EXPECT_EQ(report->without_overlap, 0U);
  EXPECT_NE(text_of(*report).find("1 see one place but do not match"), std::string::npos) << text_of(*report);
}

TEST_F(SessionConsistency, LeavesOutWhatWasUndone) {
  const auto report = evaluated(command(write_session({{0}, {1, 1.3, true}, {1}})));
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->captures, 2U);
  EXPECT_EQ(report->undone, 1U);
  EXPECT_EQ(report->alarms(), 0U);
}

TEST_F(SessionConsistency, RefusesAnotherSurfaceAndTooFewCaptures) {
  const auto alone = evaluated(command(write_session({{0}})));
  ASSERT_FALSE(alone);
  EXPECT_NE(alone.error().message.find("two or more are accepted"), std::string::npos);
  auto other = command(write_session({{0}, {1}}));
  ASSERT_TRUE(write_ply(folder_ / "other.ply", *make_surface(hollow_ball(29), "other")));
  other.surface = folder_ / "other.ply";
  const auto wrong = evaluated(other);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("bring the surface of that session"), std::string::npos);
  EXPECT_FALSE(evaluated(command(folder_ / "none.orcart")));
}

TEST_F(SessionConsistency, ASessionIsExportedAsFilesThatOtherVerbsRead) {
  const auto session = write_session({{0}, {1, 0, true}, {2, 0.5, false, 0, 12.5}});
  const auto report =
      export_session({.session = session, .out = folder_ / "out"}, [](const std::string&, double) {});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->captures, 2U);
  EXPECT_EQ(report->undone, 1U);
  const auto views = read_views(folder_ / "out/views.csv");
  ASSERT_TRUE(views) << views.error().message;
  ASSERT_EQ(views->views.size(), 2U);
  EXPECT_TRUE(views->notes.empty());
  Pose<M, C> believed = pose(2);
  believed.translation_mm.x() += 0.5;
  EXPECT_LT((views->views[1].X_MC.translation_mm - believed.translation_mm).norm(), 1e-9);
  EXPECT_EQ(views->views[1].image.filename(), "capture-0003.png");
  EXPECT_EQ(views->views[0].velocity.value(), Twist::Zero());
  EXPECT_EQ(views->views[1].velocity.value(), 12.5 * Twist::Unit(0));
  const auto picture = read_picture(views->views[1].image);
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(picture->width_px, kWidth);
  // X_MC = X_MR X_RS X_SC: the poses lead back to the views.
  const auto poses = read_poses(folder_ / "out/poses.csv");
  ASSERT_TRUE(poses) << poses.error().message;
  ASSERT_EQ(poses->poses.size(), 2U);
  EXPECT_EQ(poses->poses[1].name, "capture-0003.png");
  const auto scope = read_scope(folder_ / "out/scope.toml");
  const auto registration = read_registration(folder_ / "out/registration.toml");
  ASSERT_TRUE(scope && registration);
  const Pose<R, S> X_RS{.rotation = poses->poses[1].X_TS.rotation,
                        .translation_mm = poses->poses[1].X_TS.translation_mm};
  const Pose<M, C> back = registration->X_MR * X_RS * scope->X_SC;
  EXPECT_LT((back.translation_mm - believed.translation_mm).norm(), 1e-6);
  EXPECT_LT((back.rotation - believed.rotation).norm(), 1e-9);
  EXPECT_EQ(registration->surface_hash, hash_);
}

TEST_F(SessionConsistency, AnExportIsComparedWithTheVelocitiesThatItTells) {
  const auto predicted_mm = [&](double speed_mm_s) {
    const auto session = write_session({{.number = 0}, {.number = 1, .speed_mm_s = speed_mm_s}});
    const auto out = folder_ / ("at-" + std::to_string(speed_mm_s));
    EXPECT_TRUE(export_session({.session = session, .out = out}, [](const std::string&, double) {}));
    const auto share = std::filesystem::path(std::getenv("ORCART_SOURCE_DIR")) / "share/tools";
    const auto report = evaluate({.surface = folder_ / "ball.ply",
                                  .scope = out / "scope.toml",
                                  .registration = out / "registration.toml",
                                  .scope_rom = share / "scope.rom",
                                  .reference_rom = share / "reference.rom",
                                  .simulation = {.model = with_time({}, 0.005), .setups = 2, .landmarks = 1},
                                  .noises = {{"vega", 0.12}},
                                  .views = out / "views.csv"},
                                 [](const std::string&, double) {});
    EXPECT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->pairs.size(), 1U);
    EXPECT_NE(text_of(*report).find("velocity: of 2 views told, of 0 assumed"), std::string::npos);
    return report->pairs.front().predicted_mm;
  };
  const double still = predicted_mm(0), moving = predicted_mm(100);
  // 100 mm/s by 5 ms, along the wall as the picture's x lies on it.
  EXPECT_NEAR(std::sqrt(moving * moving - still * still), 0.5, 0.03);
}

TEST_F(SessionConsistency, CapturesOfAScopeThatTurnsAreComparedEachThroughItsOwnLens) {
  ball_.scope = angled();
  ASSERT_TRUE(write_scope(folder_ / "scope.toml", ball_.scope));
  const std::vector<Taken> turning{
      {.number = 0}, {.number = 1, .turn_rad = 0.7}, {.number = 2, .turn_rad = -1.1}};
  const auto report = evaluated(command(write_session(turning)));
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->unmatched, 0U);
  ASSERT_GE(report->pairs.size(), 2U);
  for (const SessionPair& pair : report->pairs) {
    EXPECT_LT(pair.pair.found.median_mm, 0.1) << pair.pair.second;
    EXPECT_GE(pair.pair.found.patches.size(), 5U) << pair.pair.second;
  }
  // A slip of 1.3 mm shows as it does through one lens.
  auto slipped = turning;
  slipped[2].wrong_mm = 1.3;
  const auto apart = evaluated(command(write_session(slipped)));
  ASSERT_TRUE(apart) << apart.error().message;
  EXPECT_GE(apart->alarms(), 1U) << text_of(*apart);
  EXPECT_FALSE(apart->pairs.front().pair.alarm());
}

TEST_F(SessionConsistency, ATurnIsAsWellKnownAsTheSessionSaysUnlessToldOtherwise) {
  ball_.scope = angled();
  ball_.scope.turning->notch_deviation_rad = 0.001;
  ASSERT_TRUE(write_scope(folder_ / "scope.toml", ball_.scope));
  const auto ask = [&](std::optional<double> kept_rad) {
    turn_deviation_rad_ = kept_rad;
    return command(write_session({{.number = 0}, {.number = 1, .turn_rad = 0.7}}));
  };
  const auto unsaid = evaluated(ask({})), said = evaluated(ask(0.02));
  ASSERT_TRUE(unsaid && said);
  EXPECT_NE(text_of(*unsaid).find("turn 0.06 degrees (passport)"), std::string::npos) << text_of(*unsaid);
  EXPECT_NE(text_of(*said).find("turn 1.15 degrees (session)"), std::string::npos) << text_of(*said);
  EXPECT_GT(said->pairs.front().pair.predicted_mm, 1.05 * unsaid->pairs.front().pair.predicted_mm);
  auto told = ask(0.02);
  told.model = with_turn(told.model, 0.01);
  EXPECT_NE(text_of(*evaluated(told)).find("turn 0.57 degrees (told)"), std::string::npos);
}

TEST_F(SessionConsistency, TurnsThroughAPassportThatDoesNotTurnAreRefused) {
  const auto refused = evaluated(command(write_session({{.number = 0}, {.number = 1, .turn_rad = 0.5}})));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("turned while it ran"), std::string::npos)
      << refused.error().message;
}

TEST_F(SessionConsistency, AScopeThatTurnedIsExportedWithItsTurns) {
  const auto scope_file = folder_ / "scope.toml";
  const auto angled = this->angled();
  ASSERT_TRUE(write_scope(scope_file, angled));
  const auto session = write_session({{.number = 0}, {.number = 1, .turn_rad = 0.5}});
  const auto report =
      export_session({.session = session, .out = folder_ / "out"}, [](const std::string&, double) {});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->turned);
  const auto views = read_views(folder_ / "out/views.csv");
  ASSERT_TRUE(views) << views.error().message;
  EXPECT_EQ(views->views[0].turn_rad, 0);
  EXPECT_EQ(views->views[1].turn_rad, 0.5);
  const auto poses = read_poses(folder_ / "out/poses.csv");
  ASSERT_TRUE(poses) << poses.error().message;
  const auto scope = read_scope(folder_ / "out/scope.toml").value();
  EXPECT_EQ(scope.lens.cx_px, angled.lens.cx_px) << "as calibrated: each view brings its turn";
  const Pose<R, S> X_RS{.rotation = poses->poses[1].X_TS.rotation,
                        .translation_mm = poses->poses[1].X_TS.translation_mm};
  const Pose<M, C> back =
      read_registration(folder_ / "out/registration.toml")->X_MR * X_RS * optics_at(scope, 0.5).X_SC;
  EXPECT_LT((back.translation_mm - views->views[1].X_MC.translation_mm).norm(), 1e-6);
}

TEST_F(SessionConsistency, AnExportIsWholeOrNotThere) {
  const auto session = write_session({{0}});
  const auto ask = [&](const std::filesystem::path& from, const std::filesystem::path& out) {
    return export_session({.session = from, .out = out}, [](const std::string&, double) {});
  };
  std::filesystem::create_directory(folder_ / "taken");
  const auto before = folder_.count();
  EXPECT_NE(ask(session, folder_ / "taken").error().message.find("is there already"), std::string::npos);
  EXPECT_FALSE(ask(folder_ / "none.orcart", folder_ / "out"));
  EXPECT_FALSE(ask(session, folder_ / "no/such/out"));
  EXPECT_EQ(folder_.count(), before);
}

TEST(GreyOf, TakesTheLumaOfEachFormat) {
  const std::array<std::pair<PixelFormat, std::vector<std::byte>>, 4> pictures{
      {{PixelFormat::yuyv, {std::byte{10}, std::byte{1}, std::byte{20}, std::byte{2}}},
       {PixelFormat::uyvy, {std::byte{1}, std::byte{10}, std::byte{2}, std::byte{20}}},
       {PixelFormat::gray8, {std::byte{10}, std::byte{20}}},
       {PixelFormat::rgba8888,
        {std::byte{10}, std::byte{10}, std::byte{10}, std::byte{255}, std::byte{20}, std::byte{20},
         std::byte{20}, std::byte{255}}}}};
  for (const auto& [format, bytes] : pictures) {
    const auto grey = grey_of({.width_px = 2, .height_px = 1, .format = format, .bytes = bytes});
    ASSERT_TRUE(grey) << grey.error().message;
    EXPECT_EQ(grey->rgba, (std::vector<std::uint8_t>{10, 10, 10, 255, 20, 20, 20, 255}));
  }
  EXPECT_FALSE(
      grey_of({.width_px = 2, .height_px = 2, .format = PixelFormat::gray8, .bytes = {std::byte{1}}}));
}

}  // namespace
}  // namespace orcart
