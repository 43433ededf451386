// The chain that the simulated mapping errors come from, against the atlas that the painter really paints:
// light whose place is coded in its grey is painted from a wrong pose, or through a wrong lens or that of
// another medium, and read back texel by texel.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/QR>

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

/// The painter has what is believed: `scope` in place of the demo's.
OfflinePainter painter_through(const Demo& demo, const ScopeModel& scope) {
  return OfflinePainter::create(demo.surface, scope, {.seen_from = SeenFrom::inside, .texel_mm = 0.2})
      .value();
}

/// Of what lies between the two, mm. A light's origin is decoded to about 0.02 mm.
struct Bounds {
  double mean = 0.03, p95 = 0.06;
};

/// The atlas and the chain agree in a set-up, and there is an error to agree upon.
void expect_agreement(const std::string& name, const Compared& c, const Bounds& bounds = {}) {
  ASSERT_GT(c.apart_mm.size(), 200U) << name;
  const Statistics gl = statistics_of(c.gl_mm, {}), chain = statistics_of(c.chain_mm, {}),
                   apart = statistics_of(c.apart_mm, {});
  char line[160];
  std::snprintf(line, sizeof line, "%s: atlas %.3f mm, chain %.3f mm, apart mean %.3f p95 %.3f, n %zu",
                name.c_str(), gl.mean, chain.mean, apart.mean, apart.p95, apart.count);
  ::testing::Test::RecordProperty(name, line);
  EXPECT_GT(gl.mean, 0.1) << line;
  EXPECT_NEAR(gl.mean, chain.mean, 0.01) << line;
  EXPECT_LT(apart.mean, bounds.mean) << line;
  EXPECT_LT(apart.p95, bounds.p95) << line;
}

TEST(PaintedAtlas, HoldsTheErrorsThatTheChainSimulates) {
  const Demo demo;
  OfflinePainter painter = painter_through(demo, demo.scope);
  const ComponentSet poses{true, true, true, false, false, true, false};
  const ErrorModel model{.marker_rms_mm = 0.25};
  for (const std::uint64_t number : {1, 2, 3, 4, 5}) {
    RandomStream random(11, number);
    const auto view = view_of_chance(demo.scene, random);
    ASSERT_TRUE(view);
    Capture capture{.X_MC = *view};
    capture.velocity << model.speed_mm_s * random.direction(), model.turn_rad_s * random.direction();
    const auto fiducials = fiducials_of_chance(demo.scene, model.fiducials, random);
    const DrawnErrors errors = drawn_errors(demo.scene, model, poses, fiducials, random);
    expect_agreement("pose_" + std::to_string(number), compared(demo, painter, capture, errors));
  }
}

TEST(PaintedAtlas, HoldsTheErrorsOfWrongLenses) {
  const Demo demo;
  for (const std::uint64_t number : {1, 2, 3}) {
    RandomStream random(12, number);
    const auto view = view_of_chance(demo.scene, random);
    ASSERT_TRUE(view);
    DrawnErrors errors;
    for (int i = 0; i < 4; ++i) errors.lens_numbers[i] = 5 * random.gaussian();
    errors.lens_numbers[4] = 0.02 * random.gaussian();
    errors.lens_numbers[6] = 0.002 * random.gaussian();
    ScopeModel wrong = demo.scope;
    wrong.lens = stepped(demo.scope.lens, errors.lens_numbers);
    wrong.lens.max_angle_rad = largest_monotone_angle_rad(wrong.lens, 1.3);
    OfflinePainter painter = painter_through(demo, wrong);
    expect_agreement("lens_" + std::to_string(number), compared(demo, painter, {.X_MC = *view}, errors));
  }
}

/// The lens that sees in air what `fluid` sees in a fluid of this index, as a fisheye's polynomial: a radius
/// on the sensor belongs to the angle that Snell makes of the fluid's. Nothing but radial may be in `fluid`.
Lens in_air(const Lens& fluid, double index, double edge_rad) {
  constexpr int kAngles = 100;
  const double focal_px = fluid.fx_px / index;
  Eigen::Matrix<double, kAngles, 4> powers;
  Eigen::Matrix<double, kAngles, 1> rest;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = edge_rad * (i + 1) / kAngles, air = std::asin(index * std::sin(angle));
    const double radius = project(fluid, {std::sin(angle), 0, std::cos(angle)})->x() - fluid.cx_px;
    rest[i] = radius / focal_px - air;
    for (int k = 0; k < 4; ++k) powers(i, k) = std::pow(air, 3 + 2 * k);
  }
  const Eigen::Vector4d k = powers.colPivHouseholderQr().solve(rest);
  EXPECT_LT((powers * k - rest).cwiseAbs().maxCoeff() * focal_px, 0.05) << "px";
  Lens air{.model = LensModel::fisheye,
           .fx_px = focal_px,
           .fy_px = focal_px,
           .cx_px = fluid.cx_px,
           .cy_px = fluid.cy_px,
           .coefficients = {k[0], k[1], k[2], k[3], 0}};
  air.max_angle_rad = largest_monotone_angle_rad(air, 1.5);
  return air;
}

TEST(PaintedAtlas, HoldsTheErrorsOfAPassportMadeInAirAndUsedInWater) {
  constexpr double kWater = 1.333;
  Demo demo;
  demo.scope.lens.coefficients[2] = demo.scope.lens.coefficients[3] = 0;
  ScopeModel wrong = demo.scope;
  const double edge_rad = demo.scope.cone_half_angle_rad + 0.02;
  wrong.lens = in_air(demo.scope.lens, kWater, edge_rad);
  wrong.cone_half_angle_rad = std::asin(kWater * std::sin(demo.scope.cone_half_angle_rad));
  OfflinePainter painter = painter_through(demo, wrong);
  const DrawnErrors errors{.refraction = kWater - 1};
  // The wrong lens's rays diverge more, and stretch what the decoding leaves along with the picture.
  constexpr Bounds kStretched{.mean = 0.06, .p95 = 0.15};
  for (const std::uint64_t number : {1, 2, 3}) {
    RandomStream random(13, number);
    const auto view = view_of_chance(demo.scene, random);
    ASSERT_TRUE(view);
    expect_agreement("medium_" + std::to_string(number), compared(demo, painter, {.X_MC = *view}, errors),
                     kStretched);
  }
}

}  // namespace
}  // namespace orcart
