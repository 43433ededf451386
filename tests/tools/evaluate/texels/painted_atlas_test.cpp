// The chain that the simulated mapping errors come from, against the atlas that the painter really paints:
// light whose place is coded in its grey is painted from a wrong pose, and read back texel by texel.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "board/sim/scope_camera.hpp"
#include "firmware-host/offline/offline_painter.hpp"
#include "tests/tools/evaluate/texels/demo_scene.hpp"
#include "tools/evaluate/draw.hpp"
#include "tools/evaluate/statistics.hpp"

namespace orcart {
namespace {

constexpr double kPeriod_mm = 20;
constexpr int kPhases = 3;

/// Where each texel's light came from, along one axis modulo the period; negative where it is not painted.
std::vector<double> decoded_axis(const Demo& demo, OfflinePainter& painter, int axis, const Pose<M, C>& truth,
                                 const Pose<M, C>& believed) {
  std::vector<std::array<double, kPhases>> greys(painter.layout().owners.size());
  std::vector<int> painted(greys.size(), 0);
  const int width = demo.scope.width_px, height = demo.scope.height_px;
  std::vector<std::byte> bytes(packed_bytes(PixelFormat::yuyv, width, height));
  for (int phase = 0; phase < kPhases; ++phase) {
    const ScopeCamera camera(
        demo.surface.mesh, demo.rays, demo.scope,
        {.tissue = CodedTissue{
             .axis = axis, .period_mm = kPeriod_mm, .phase_rad = 2 * std::numbers::pi * phase / kPhases}});
    ScopeCamera::Scratch scratch;
    const ImageDescriptor image = packed_image(bytes.data(), PixelFormat::yuyv, width, height);
    camera.draw({.poses = {&truth, 1}}, scratch, image);
    painter.painter().clear();
    EXPECT_TRUE(painter.paint(image, believed));
    const AtlasPicture atlas = painter.painter().read_back();
    for (std::size_t i = 0; i < greys.size(); ++i) {
      greys[i][static_cast<std::size_t>(phase)] = atlas.rgba[4 * i + 1];
      painted[i] += atlas.rgba[4 * i + 3] == 255 ? 1 : 0;
    }
  }
  std::vector<double> place_mm(greys.size(), -1);
  for (std::size_t i = 0; i < greys.size(); ++i) {
    if (painted[i] != kPhases || painter.layout().inside[i] == 0) continue;
    // Three steps of 120 degrees (Creath 1988).
    const auto& g = greys[i];
    const double turn =
        std::atan2(2 * g[0] - g[1] - g[2], std::numbers::sqrt3 * (g[1] - g[2])) / (2 * std::numbers::pi);
    place_mm[i] = kPeriod_mm * (turn < 0 ? turn + 1 : turn);
  }
  return place_mm;
}

Eigen::Vector3d point_of(const TriangleMesh& mesh, const TexelOwner& owner) {
  const auto& t = mesh.triangles[owner.triangle];
  const Eigen::Vector3d a = mesh.vertices_mm[t[0]].cast<double>();
  return a + double(owner.b1) * (mesh.vertices_mm[t[1]].cast<double>() - a) +
         double(owner.b2) * (mesh.vertices_mm[t[2]].cast<double>() - a);
}

struct Compared {
  std::vector<double> gl_mm, chain_mm,
      apart_mm;  ///< one a texel: error in the atlas, in the chain, between them
};

/// For each painted texel: its light's origin as the atlas has it, and where the chain says light of that
/// very origin lands: at the texel, if both are right.
Compared compared(const Demo& demo, OfflinePainter& painter, const Capture& capture,
                  const DrawnErrors& errors) {
  const Pose<M, C> believed = believed_pose(demo.scene, capture, errors);
  std::array<std::vector<double>, 3> axes;
  for (int axis = 0; axis < 3; ++axis)
    axes[static_cast<std::size_t>(axis)] = decoded_axis(demo, painter, axis, capture.X_MC, believed);
  Compared result;
  for (std::size_t i = 0; i < axes[0].size(); ++i) {
    if (axes[0][i] < 0 || axes[1][i] < 0 || axes[2][i] < 0) continue;
    const Eigen::Vector3d texel = point_of(demo.surface.mesh, painter.layout().owners[i]);
    Eigen::Vector3d origin;
    for (int axis = 0; axis < 3; ++axis) {
      const double off = texel[axis] - axes[static_cast<std::size_t>(axis)][i];
      origin[axis] = texel[axis] - (off - kPeriod_mm * std::round(off / kPeriod_mm));
    }
    const auto pixel =
        project(demo.scope.lens, capture.X_MC.rotation.transpose() * (origin - capture.X_MC.translation_mm));
    const auto landmark = pixel ? landmark_at(demo.scene, capture.X_MC, *pixel) : std::nullopt;
    if (!landmark || (landmark->place_mm - origin).norm() > 0.3) continue;  // a colour mixed at a fold's edge
    const auto lands = painted_place(demo.scene, capture, *landmark, errors, {});
    if (!lands) continue;
    result.gl_mm.push_back((origin - texel).norm());
    result.chain_mm.push_back((*lands - landmark->place_mm).norm());
    result.apart_mm.push_back((*lands - texel).norm());
  }
  return result;
}

TEST(PaintedAtlas, HoldsTheErrorsThatTheChainSimulates) {
  const Demo demo;
  OfflinePainter painter =
      OfflinePainter::create(demo.surface, demo.scope, {.seen_from = SeenFrom::inside, .texel_mm = 0.2})
          .value();
  // What the painter is given wrong is the pose; lens and medium it would be given with the passport.
  const ComponentSet poses{true, true, true, false, false, true, false};
  const ErrorModel model{.marker_rms_mm = 0.25};
  std::size_t texels = 0;
  for (const std::uint64_t number : {1, 2, 3, 4, 5}) {
    RandomStream random(11, number);
    const auto view = view_of_chance(demo.scene, random);
    ASSERT_TRUE(view);
    Capture capture{.X_MC = *view};
    capture.velocity << model.speed_mm_s * random.direction(), model.turn_rad_s * random.direction();
    const auto fiducials = fiducials_of_chance(demo.scene, model.fiducials, random);
    const DrawnErrors errors = drawn_errors(demo.scene, model, poses, fiducials, random);
    const Compared c = compared(demo, painter, capture, errors);
    ASSERT_GT(c.apart_mm.size(), 200U) << number;
    const Statistics gl = statistics_of(c.gl_mm, {}), chain = statistics_of(c.chain_mm, {}),
                     apart = statistics_of(c.apart_mm, {});
    char line[160];
    std::snprintf(line, sizeof line,
                  "set-up %d: atlas %.3f mm, chain %.3f mm, apart mean %.3f p95 %.3f, n %zu",
                  static_cast<int>(number), gl.mean, chain.mean, apart.mean, apart.p95, apart.count);
    ::testing::Test::RecordProperty("setup_" + std::to_string(number), line);
    EXPECT_GT(gl.mean, 0.1) << line;
    EXPECT_NEAR(gl.mean, chain.mean, 0.01) << line;
    EXPECT_LT(apart.mean, 0.03) << line;
    EXPECT_LT(apart.p95, 0.06) << line;
    texels += apart.count;
  }
  EXPECT_GT(texels, 3000U);
}

}  // namespace
}  // namespace orcart
