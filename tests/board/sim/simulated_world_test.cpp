// A simulated procedure: the path keeps its promises, the frames fit together, the script happens.
#include "board/sim/simulated_world.hpp"

#include <gtest/gtest.h>

#include "board/sim/lumen.hpp"
#include "tests/board/sim/pattern_scope.hpp"
#include "tests/board/sim/test_shapes.hpp"

namespace orcart {
namespace {

struct Room {
  Surface surface;
  RayScene rays;
  ScopeModel scope = testing::pattern_scope();
  ProcedureScript script;
  SimulatedWorld world;

  explicit Room(const Eigen::Vector3f& radii_mm, const ProcedureScript& wanted)
      : surface{.mesh = testing::ellipsoid(radii_mm, 40, 60), .identity = {}, .closed = true},
        rays(*RayScene::create(surface.mesh)),
        script(wanted),
        world(*SimulatedWorld::create({surface, rays, scope, script})) {}
};

const Eigen::Vector3f kLumen{9, 22, 13}, kHead{60, 75, 65};

const Room& ventricle() {
  static const Room room(kLumen, {});
  return room;
}

const Room& cortex() {
  static const Room room(kHead, {.seen_from = SeenFrom::outside, .entry_direction = {-0.5, 0.1, 0.8}});
  return room;
}

Instant at_ms(int ms) {
  return instant_from_nanos(ms * 1'000'000LL);
}

TEST(Lumen, TellsInsideFromOutside) {
  const Room& room = ventricle();
  EXPECT_TRUE(inside(room.surface.mesh, room.rays, {0, 15, 0}));
  EXPECT_FALSE(inside(room.surface.mesh, room.rays, {0, 23, 0}));
  EXPECT_FALSE(inside(room.surface.mesh, room.rays, {20, 0, 0}));
}

TEST(Lumen, MeasuresTheRoomAboutAPoint) {
  EXPECT_NEAR(clearance_mm(ventricle().rays, {0, 0, 0}), 9, 0.3);
  EXPECT_NEAR(clearance_mm(ventricle().rays, {5, 0, 0}), 4, 0.3);
  EXPECT_EQ(clearance_mm(ventricle().rays, {0, 0, 0}, 2), 2);
}

TEST(SimulatedWorld, KeepsTheTipInTheLumenWithRoomAboutIt) {
  const Room& room = ventricle();
  for (int ms = 0; ms < 30'000; ms += 20) {
    const Eigen::Vector3f tip = room.world.X_MC(at_ms(ms)).translation_mm.cast<float>();
    ASSERT_TRUE(inside(room.surface.mesh, room.rays, tip)) << ms;
    ASSERT_GT(clearance_mm(room.rays, tip, 3), room.script.room_mm - 0.6) << ms;
  }
}

TEST(SimulatedWorld, KeepsTheShaftInTheBurrHole) {
  const Room& room = ventricle();
  const Eigen::Vector3d entry = room.world.motion().way().entry_mm;
  EXPECT_FALSE(inside(room.surface.mesh, room.rays, entry.cast<float>()));
  for (int ms = 0; ms < 30'000; ms += 50) {
    const Point<C> in_camera = room.world.X_MC(at_ms(ms)).inverse() * Point<M>{entry};
    EXPECT_NEAR(in_camera.mm.head<2>().norm(), 0, 1e-9) << "on the shaft's axis";
    EXPECT_LT(in_camera.mm.z(), -30) << "and behind the tip";
  }
}

TEST(SimulatedWorld, MovesAsAHandDoes) {
  for (const Room* room : {&ventricle(), &cortex()}) {
    double fastest = 0, far = 0;
    for (int ms = 0; ms < 30'000; ms += 5) {
      const Pose<M, C> now = room->world.X_MC(at_ms(ms)), next = room->world.X_MC(at_ms(ms + 5));
      fastest = std::max(fastest, (next.translation_mm - now.translation_mm).norm() / 0.005);
      far = std::max(far, (now.translation_mm - room->world.X_MC(at_ms(0)).translation_mm).norm());
      ASSERT_LT(angle_between_rad(now, next), 0.02) << "no jump at " << ms;
    }
    EXPECT_LT(fastest, 40);
    EXPECT_GT(far, 5) << "it goes somewhere";
  }
}

TEST(SimulatedWorld, LooksAtACortexFromOutside) {
  const Room& room = cortex();
  for (int ms = 1100; ms < 30'000; ms += 1750) {
    const Pose<M, C> X_MC = room.world.X_MC(at_ms(ms));
    const auto hit =
        room.rays.nearest(X_MC.translation_mm.cast<float>(), X_MC.rotation.col(2).cast<float>(), 200);
    ASSERT_TRUE(hit);
    EXPECT_GT(hit->distance_mm, 22);
    EXPECT_LT(hit->distance_mm, 45);
  }
}

TEST(SimulatedWorld, MeasuresToolsThatFitTheTruth) {
  const Room& room = ventricle();
  for (int ms : {0, 777, 12'345, 29'999}) {
    const auto scope = room.world.pose_of(SimulatedWorld::kScopeTool, at_ms(ms));
    const auto reference = room.world.pose_of(SimulatedWorld::kReferenceTool, at_ms(ms));
    const auto X_TS = pose_from_quaternion<T, S>(scope.rotation, scope.translation_mm);
    const auto X_TR = pose_from_quaternion<T, R>(reference.rotation, reference.translation_mm);
    const Pose<M, C> X_MC = room.world.X_MR() * X_TR.inverse() * X_TS * room.scope.X_SC;
    const Pose<M, C> truth = room.world.X_MC(at_ms(ms));
    EXPECT_NEAR((X_MC.translation_mm - truth.translation_mm).norm(), 0, 1e-9);
    EXPECT_NEAR((X_MC.rotation - truth.rotation).cwiseAbs().maxCoeff(), 0, 1e-12);
  }
}

TEST(SimulatedWorld, StaysTrueWhenTheReferenceIsBumped) {
  const Room room(kLumen, {.bump_at = 0.5});
  const auto X_TR = [&](int ms) { return room.world.X_TR(at_ms(ms)); };
  EXPECT_LT((X_TR(14'990).translation_mm - X_TR(0).translation_mm).norm(), 0.1);
  EXPECT_NEAR((X_TR(15'100).translation_mm - X_TR(0).translation_mm).norm(), 12, 0.1);
  EXPECT_NEAR(angle_between_rad(X_TR(15'100), X_TR(0)), 0.03, 1e-6);
  EXPECT_EQ(room.world.X_MC(at_ms(20'000)).translation_mm,
            ventricle().world.X_MC(at_ms(20'000)).translation_mm)
      << "the patient moves with the reference";
}

TEST(SimulatedWorld, HidesTheScopeOnceAndNeverTheReference) {
  int hidden_ms = 0;
  for (int ms = 0; ms < 30'000; ++ms) {
    hidden_ms += !ventricle().world.pose_of(SimulatedWorld::kScopeTool, at_ms(ms)).visible;
    ASSERT_TRUE(ventricle().world.pose_of(SimulatedWorld::kReferenceTool, at_ms(ms)).visible);
  }
  EXPECT_EQ(hidden_ms, 1100);
}

TEST(SimulatedWorld, PressesAtRestAndUndoesOnceAndStreamsOnce) {
  const auto edges = ventricle().world.pedal_edges();
  ASSERT_EQ(edges.size() % 2, 0U);
  int presses = 0, double_presses = 0, holds = 0;
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    ASSERT_EQ(edges[i].kind, EdgeKind::pressed);
    ASSERT_EQ(edges[i + 1].kind, EdgeKind::released);
    ASSERT_LT(edges[i].at, edges[i + 1].at);
    ++presses;
    holds += edges[i + 1].at - edges[i].at > 500ms;
    if (i > 0) double_presses += edges[i].at - edges[i - 2].at < 350ms;
    const Pose<M, C> now = ventricle().world.X_MC(edges[i].at),
                     later = ventricle().world.X_MC(edges[i].at + 40ms);
    EXPECT_LT((later.translation_mm - now.translation_mm).norm() / 0.04, 4.0) << "mm/s at the press";
  }
  EXPECT_EQ(presses, places_in({}) + 1);
  EXPECT_EQ(double_presses, 1);
  EXPECT_EQ(holds, 1);
  EXPECT_LT(edges.back().at, ventricle().world.end());
}

TEST(SimulatedWorld, NeverPressesAPedalThatIsHeldHoweverShortTheProcedure) {
  for (const double duration_s : {2.0, 4.0, 6.0, 8.0, 12.0}) {
    const Room room(kLumen, {.duration_s = duration_s});
    const auto edges = room.world.pedal_edges();
    for (std::size_t i = 1; i < edges.size(); ++i) {
      EXPECT_LT(edges[i - 1].at, edges[i].at) << duration_s;
      EXPECT_NE(edges[i - 1].kind, edges[i].kind) << duration_s;
    }
  }
}

TEST(SimulatedWorld, RepeatsItselfFromASeedAndDiffersWithAnother) {
  const Room again(kLumen, {}), other(kLumen, {.seed = 2});
  const Instant at = at_ms(9'999);
  EXPECT_EQ(again.world.X_MC(at).rotation, ventricle().world.X_MC(at).rotation);
  EXPECT_NE(other.world.X_MC(at).rotation, ventricle().world.X_MC(at).rotation);
  EXPECT_NE(fingerprint(other.script), fingerprint(again.script));
}

TEST(SimulatedWorld, RefusesASurfaceWithoutRoom) {
  const Surface narrow{.mesh = testing::ellipsoid({1.5, 20, 1.5}, 20, 30), .identity = {}, .closed = true};
  const RayScene rays = *RayScene::create(narrow.mesh);
  const auto world = SimulatedWorld::create({narrow, rays, testing::pattern_scope(), {}});
  ASSERT_FALSE(world);
  EXPECT_NE(world.error().message.find("room"), std::string::npos);
}

}  // namespace
}  // namespace orcart
