// The error that the cart's painter writes into each texel's record, against the one propagated texel by
// texel.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "firmware-host/files/picture_file.hpp"
#include "firmware-host/offline/offline_painter.hpp"
#include "firmware-host/stages/view_errors.hpp"
#include "realtime/registration/body_covariance.hpp"
#include "tests/tools/evaluate/texels/demo_scene.hpp"
#include "tools/evaluate/stated_errors.hpp"
#include "tools/evaluate/texels/texel_errors.hpp"

namespace orcart {
namespace {

/// A painted texel's error: as its record says, and as propagated texel by texel.
struct TexelError {
  double record_mm = 0, propagated_mm = 0;
};

std::vector<TexelError> texel_errors(Demo& demo, const ErrorModel& assumed,
                                     const RegistrationFile& registration, const ViewErrors& errors,
                                     const std::vector<Eigen::Vector3d>& fiducials, int views) {
  OfflinePainter painter =
      OfflinePainter::create(demo.surface, demo.scope, {.seen_from = SeenFrom::inside, .texel_mm = 0.3})
          .value();
  const std::vector<std::uint8_t> grey(
      static_cast<std::size_t>(demo.scope.width_px * demo.scope.height_px) * 4, 128);
  Picture picture{.width_px = demo.scope.width_px, .height_px = demo.scope.height_px, .rgba = grey};
  std::vector<View> painted;
  for (int i = 0; i < views; ++i) {
    RandomStream random(21, static_cast<std::uint64_t>(i));
    const auto X_MC = view_of_chance(demo.scene, random);
    if (!X_MC) continue;
    painted.push_back({.image = "grey", .X_MC = *X_MC});
    painter.painter().set_view_error(errors.at(*X_MC));
    EXPECT_TRUE(painter.paint(picture.descriptor(), *X_MC));
  }
  const AtlasRecords records = painter.painter().read_records();
  TurnedScenes scenes(demo.scene, assumed, registration);
  const auto rms_mm = predicted_rms_mm(fiducials, {.layout = painter.layout(),
                                                   .records = records,
                                                   .views = painted,
                                                   .scenes = scenes_of(painted, scenes)});
  std::vector<TexelError> both;
  for (std::size_t i = 0; i < rms_mm.size(); ++i)
    if (rms_mm[i] > 0) both.push_back({1e-3 * records.texels[i].error_um, static_cast<double>(rms_mm[i])});
  return both;
}

struct Case {
  const char* name;
  bool stated;
};

class PaintedError : public ::testing::TestWithParam<Case> {};

TEST_P(PaintedError, AgreesWithThePropagationOfEachTexel) {
  Demo demo;
  if (GetParam().stated) {
    demo.scope.hand_eye_covariance = TwistCovariance::Zero();
    demo.scope.hand_eye_covariance->diagonal() << 0.04, 0.02, 0.1, 4e-6, 2e-6, 1e-6;
    (*demo.scope.hand_eye_covariance)(0, 4) = (*demo.scope.hand_eye_covariance)(4, 0) = -1.5e-4;
    demo.scope.lens_covariance = LensCovariance::Zero();
    demo.scope.lens_covariance->diagonal().head<5>() << 1, 1, 0.5, 0.5, 1e-5;
  }
  RandomStream random(21, 1000);
  const auto fiducials = fiducials_of_chance(demo.scene, ErrorModel{}.fiducials, random);
  std::vector<Eigen::Vector3d> in_R;
  in_R.reserve(fiducials.size());
  for (const Eigen::Vector3d& p : fiducials) in_R.push_back((demo.scene.X_MR.inverse() * Point<M>{p}).mm);
  const RegistrationFile registration{
      .X_MR = demo.scene.X_MR,
      .covariance = body_covariance(in_R, kAssumedErrors.fiducial_rms_mm / std::numbers::sqrt3)};
  const ErrorModel model = with_stated({}, demo.scope, registration);
  const ViewErrors errors(demo.scope, demo.scene.X_MR,
                          {.scope_markers_mm = demo.scene.scope_markers_mm,
                           .reference_markers_mm = demo.scene.reference_markers_mm,
                           .registration = registration.covariance,
                           .texel_mm = model.texel_mm});
  std::vector<double> ratio;
  for (const TexelError& one : texel_errors(demo, {}, registration, errors, fiducials, 8))
    ratio.push_back(one.record_mm / one.propagated_mm);
  std::sort(ratio.begin(), ratio.end());
  ASSERT_GT(ratio.size(), 3000U);
  const auto part = [&](double p) {
    return ratio[static_cast<std::size_t>(p * static_cast<double>(ratio.size() - 1))];
  };
  char line[160];
  std::snprintf(line, sizeof line,
                "record / propagated: least %.3f p5 %.3f median %.3f p95 %.3f most %.3f, n %zu", part(0),
                part(0.05), part(0.5), part(0.95), part(1), ratio.size());
  RecordProperty("ratio", line);
  EXPECT_NEAR(part(0.5), 1, 0.05) << line;
  EXPECT_GT(part(0.05), 0.95) << line;
  EXPECT_LT(part(0.95), 1.15) << line;
  EXPECT_GT(part(0), 0.85) << line;
  EXPECT_LT(part(1), 1.25) << line;
}

/// A light post that is off by 3 degrees, on a scope that looks 30 degrees off its shaft; all else is known.
TEST(PaintedLightPost, IsOffAsItsTexelsAreOnTheAverage) {
  Demo demo;
  demo.scope = read_scope(demo.share / "scopes/neuro-30.toml").value();
  demo.scope.hand_eye_covariance = TwistCovariance::Zero();
  demo.scope.lens_covariance = LensCovariance::Zero();
  const RegistrationFile registration{.X_MR = demo.scene.X_MR, .covariance = TwistCovariance::Zero()};
  ErrorModel model{.marker_rms_mm = 1e-6, .light_post_rad = 0.05};
  model.time_s = 0;
  const auto mean_square = [&](double light_post_rad, double TexelError::*of) {
    model.light_post_rad = light_post_rad;
    const ViewErrors errors(demo.scope, demo.scene.X_MR,
                            {.marker_rms_mm = 1e-6,
                             .registration = registration.covariance,
                             .time_s = 0,
                             .light_post_rad = light_post_rad,
                             .texel_mm = model.texel_mm});
    double sum = 0;
    const auto all = texel_errors(demo, model, registration, errors, {}, 8);
    EXPECT_GT(all.size(), 2000U);
    for (const TexelError& one : all) sum += one.*of * one.*of / static_cast<double>(all.size());
    return sum;
  };
  const double record = std::sqrt(mean_square(0.05, &TexelError::record_mm) -
                                  mean_square(1e-9, &TexelError::record_mm)),
               propagated = std::sqrt(mean_square(0.05, &TexelError::propagated_mm) -
                                      mean_square(1e-9, &TexelError::propagated_mm));
  char line[120];
  std::snprintf(line, sizeof line, "light post alone: record %.3f, propagated %.3f mm RMS", record,
                propagated);
  ::testing::Test::RecordProperty("light_post", line);
  EXPECT_GT(propagated, 0.2);
  EXPECT_NEAR(record / propagated, 1, 0.2) << line;
}

INSTANTIATE_TEST_SUITE_P(Passport, PaintedError,
                         ::testing::Values(Case{"Assumed", false}, Case{"Stated", true}),
                         [](const auto& of) { return std::string(of.param.name); });

}  // namespace
}  // namespace orcart
