// Calibration passports and registrations go out and come back; what the cart could not paint through is
// refused.
#include "firmware-host/files/scope_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "firmware-host/files/lens_rows.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {
namespace {

std::filesystem::path shipped(const char* name) {
  return std::filesystem::path(std::getenv("ORCART_SOURCE_DIR")) / "share" / name;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

constexpr const char* kPassport = R"(name = "scope"
width_px = 640
height_px = 480
medium = "water"
[lens]
model = "brown"
fx_px = 400
fy_px = 400
cx_px = 320
cy_px = 240
coefficients = [0, 0, 0, 0, 0]
[mask]
cx_px = 320
cy_px = 240
radius_px = 200
[cone]
half_angle_rad = 0.46
[poses]
X_SC = [1,0,0,0, 0,1,0,0, 0,0,1,250]
)";

Result<ScopeModel> read_text(const std::string& text, std::vector<std::string>* notes = nullptr) {
  const TemporaryFolder folder;
  return read_scope(folder.write("scope.toml", text), notes);
}

/// What is refused after one change, without the folder's name.
std::string error_with(const std::string& from, const std::string& to) {
  const auto read = read_text(replaced(kPassport, from, to));
  EXPECT_FALSE(read);
  if (read) return "";
  const std::string& message = read.error().message;
  return message.substr(std::min(message.find("scope.toml"), message.size()));
}

TEST(ScopeFile, AShortPassportIsReadWithItsDefaults) {
  const auto scope = read_text(kPassport);
  ASSERT_TRUE(scope) << scope.error().message;
  EXPECT_EQ(scope->medium, Medium::water);
  EXPECT_EQ(scope->far_mm, 60);
  EXPECT_EQ(scope->mask.soft_edge_px, 6);
  EXPECT_EQ(scope->X_SC.translation_mm.z(), 250);
  EXPECT_TRUE(scope->X_CE.rotation.isIdentity());
  EXPECT_GT(scope->lens.max_angle_rad, 0.46);
}

TEST(ScopeFile, TheShippedScopeIsReadAndItsConeIsTheMasksEdge) {
  const auto scope = read_scope(shipped("scopes/neuro-2p7.toml"));
  ASSERT_TRUE(scope) << scope.error().message;
  const auto edge = direction_of(scope->lens, {scope->mask.cx_px + scope->mask.radius_px, scope->mask.cy_px});
  ASSERT_TRUE(edge);
  EXPECT_NEAR(std::acos(edge->z()), scope->cone_half_angle_rad, 0.01);
  EXPECT_EQ(scope->X_CE.translation_mm, Eigen::Vector3d(0, 0, 1));
}

TEST(ScopeFile, TheShippedRegistrationNamesTheShippedVentricle) {
  const auto registration = read_registration(shipped("carts/demo-registration.toml"));
  ASSERT_TRUE(registration) << registration.error().message;
  const auto surface = read_surface(shipped("surfaces/ventricle.ply"));
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(registration->surface_hash, surface->identity.hash);
}

ScopeModel scope_with(LensModel model) {
  ScopeModel scope = *read_text(kPassport);
  scope.name = "a \"quoted\" name \\ with a\ttab";
  scope.serial = "AB-12";
  scope.medium = Medium::saline;
  scope.calibrated_on = "2026-11-20";
  scope.lens.model = model;
  scope.lens.coefficients = {-0.01 / 3, 1e-7, 1e-9, model == LensModel::poly4 ? 0 : 2e-11,
                             model == LensModel::brown ? 0.001 : 0};
  if (model == LensModel::poly4) {
    scope.lens.coefficients = {1e-5, 1e-7, 1e-10, 0, 0};
    scope.lens.distortion_centre_px = {321.25, 0.1 + 238};
  }
  scope.X_SC.rotation = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  scope.X_CE.translation_mm = {0.1, -0.2, 1.0 / 3};
  scope.fall_off = {.reference_mm = 12.5, .vignetting_cos_power = 2};
  scope.residual_px = 0.28;
  scope.residual_mm = 1.0 / 7;
  scope.expires_on = "2027-11-20";
  scope.notch_rad = -0.21;
  LensCovariance lens = LensCovariance::Zero();
  for (const int i : lens_rows(model, lens_row_counts(model).front()))
    for (const int j : lens_rows(model, lens_row_counts(model).front()))
      lens(i, j) = (i == j ? 2 : 1.0 / 3) * std::pow(10.0, -i - j);
  scope.lens_covariance = lens;
  TwistCovariance hand_eye = TwistCovariance::Constant(1e-7 / 3);
  hand_eye.diagonal() << 0.01, 0.02, 0.03, 1e-6, 2e-6, 3e-6;
  scope.hand_eye_covariance = hand_eye;
  scope.window_covariance = Eigen::Vector3d(0, 1e-4, 1.0 / 7).asDiagonal();
  scope.turning =
      Turning{.view_angle_rad = 0.5,
              .centre_px = {317.25, 1.0 / 3},
              .centre_deviation_px = 0.1,
              .marker = TurnMarker::head,
              .axis = {0.6, 0, 0.8},
              .axis_point_mm = {1.0 / 3, -2, 0},
              .R_SL = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(),
              .notch_deviation_rad = 1.0 / 300};
  return scope;
}

class EachLens : public ::testing::TestWithParam<LensModel> {};

TEST_P(EachLens, ComesBackAsItWasWritten) {
  const TemporaryFolder folder;
  const ScopeModel scope = scope_with(GetParam());
  ASSERT_TRUE(write_scope(folder / "scope.toml", scope));
  std::vector<std::string> notes;
  const auto back = read_scope(folder / "scope.toml", &notes);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(back->name, scope.name);
  EXPECT_EQ(back->serial, scope.serial);
  EXPECT_EQ(back->medium, scope.medium);
  EXPECT_EQ(back->calibrated_on, scope.calibrated_on);
  EXPECT_EQ(back->lens.model, scope.lens.model);
  EXPECT_EQ(back->lens.coefficients, scope.lens.coefficients);
  EXPECT_EQ(back->lens.distortion_centre_px, scope.lens.distortion_centre_px);
  EXPECT_EQ(back->mask.radius_px, scope.mask.radius_px);
  EXPECT_EQ(back->cone_half_angle_rad, scope.cone_half_angle_rad);
  EXPECT_TRUE(back->X_SC.rotation.isApprox(scope.X_SC.rotation, 1e-14));
  EXPECT_EQ(back->X_CE.translation_mm, scope.X_CE.translation_mm);
  EXPECT_EQ(back->fall_off.vignetting_cos_power, scope.fall_off.vignetting_cos_power);
  EXPECT_EQ(back->residual_mm, scope.residual_mm);
  EXPECT_EQ(back->expires_on, scope.expires_on);
  EXPECT_EQ(back->notch_rad, scope.notch_rad);
  ASSERT_TRUE(back->lens_covariance && back->hand_eye_covariance);
  EXPECT_EQ(*back->lens_covariance, *scope.lens_covariance);
  EXPECT_EQ(*back->hand_eye_covariance, *scope.hand_eye_covariance);
  ASSERT_TRUE(back->window_covariance);
  EXPECT_EQ(*back->window_covariance, *scope.window_covariance);
  ASSERT_TRUE(back->turning);
  EXPECT_EQ(back->turning->centre_px, scope.turning->centre_px);
  EXPECT_EQ(back->turning->marker, TurnMarker::head);
  EXPECT_TRUE(back->turning->axis.isApprox(scope.turning->axis, 1e-14));
  EXPECT_EQ(back->turning->axis_point_mm, scope.turning->axis_point_mm);
  ASSERT_TRUE(back->turning->R_SL);
  EXPECT_TRUE(back->turning->R_SL->isApprox(*scope.turning->R_SL, 1e-14));
  EXPECT_EQ(back->turning->notch_deviation_rad, scope.turning->notch_deviation_rad);
}

TEST(ScopeFile, SaysOfANotchOnlyWhatIsKnownOfIt) {
  const TemporaryFolder folder;
  ScopeModel scope = scope_with(LensModel::brown);
  scope.turning->notch_deviation_rad.reset();
  ASSERT_TRUE(write_scope(folder / "scope.toml", scope));
  EXPECT_FALSE(read_scope(folder / "scope.toml")->turning->notch_deviation_rad);
  scope.turning->notch_deviation_rad = -0.01;
  ASSERT_TRUE(write_scope(folder / "scope.toml", scope));
  const auto refused = read_scope(folder / "scope.toml");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("notch_deviation_rad"), std::string::npos)
      << refused.error().message;
}

TEST(ScopeFile, KeepsTheAxisOfAMarkerOnTheShaftWhereThereIsASecondOne) {
  const TemporaryFolder folder;
  ScopeModel scope = scope_with(LensModel::brown);
  scope.turning->marker = TurnMarker::shaft;
  ASSERT_TRUE(write_scope(folder / "scope.toml", scope));
  const auto back = read_scope(folder / "scope.toml");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(back->turning->axis.isApprox(scope.turning->axis, 1e-14));
  scope.turning->R_SL = Eigen::Matrix3d::Ones();
  ASSERT_TRUE(write_scope(folder / "scope.toml", scope));
  const auto refused = read_scope(folder / "scope.toml");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("R_SL is no rotation"), std::string::npos)
      << refused.error().message;
}

INSTANTIATE_TEST_SUITE_P(ScopeFile, EachLens,
                         ::testing::Values(LensModel::brown, LensModel::poly4, LensModel::fisheye));

TEST(ScopeFile, APassportWithoutCovariancesIsAsGoodAsEver) {
  const auto scope = read_text(kPassport);
  ASSERT_TRUE(scope);
  EXPECT_FALSE(scope->lens_covariance || scope->hand_eye_covariance || scope->window_covariance);
}

TEST(ScopeFile, KeepsFewerRowsWhereFewerCoefficientsWereFree) {
  const TemporaryFolder folder;
  ScopeModel scope = *read_text(kPassport);
  scope.lens_covariance = LensCovariance::Zero();
  scope.lens_covariance->diagonal().head<6>().setConstant(0.25);
  ASSERT_TRUE(write_scope(folder / "scope.toml", scope));
  const auto back = read_scope(folder / "scope.toml");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(*back->lens_covariance, *scope.lens_covariance);
}

TEST(ScopeFile, KeepsTheWindowsCovarianceAloneAndRefusesOneOfAnotherSize) {
  const TemporaryFolder folder;
  ScopeModel scope = *read_text(kPassport);
  scope.window_covariance = Eigen::Vector3d(0, 0, 0.04).asDiagonal();
  ASSERT_TRUE(write_scope(folder / "scope.toml", scope));
  const auto back = read_scope(folder / "scope.toml");
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_TRUE(back->window_covariance);
  EXPECT_EQ(*back->window_covariance, *scope.window_covariance);
  EXPECT_NE(error_with("[poses]", "[covariance]\nwindow = [0.04]\n[poses]").find("3x3, row by row"),
            std::string::npos);
}

/// Six by six: 1e-2 on the diagonal but for one pair of numbers.
std::string six_by_six(const char* upper, const char* lower) {
  std::string text;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      text += i == 1 && j == 4   ? std::string(upper) + ","
              : i == 4 && j == 1 ? std::string(lower) + ","
              : i == j           ? "0.01,"
                                 : "0,";
  return "[" + text + "]";
}

TEST(ScopeFile, RefusesACovarianceThatIsNone) {
  const auto with = [](const std::string& hand_eye) {
    return error_with("[poses]", "[covariance]\nhand_eye = " + hand_eye + "\n[poses]");
  };
  EXPECT_EQ(with(six_by_six("0.001", "0.002")),
            "scope.toml:19: [covariance] hand_eye is not symmetric; a covariance, row by row, is accepted");
  EXPECT_EQ(with(six_by_six("0.011", "0.011")),
            "scope.toml:19: [covariance] hand_eye is not positive semi-definite; a covariance is accepted");
  EXPECT_EQ(with("[1, 2, 3]"),
            "scope.toml:19: [covariance] hand_eye holds 3 numbers; 6x6, row by row, is accepted");
  EXPECT_NE(error_with("[poses]", "[covariance]\nlens = [1, 2, 2]\n[poses]").find("9x9, 8x8, 6x6, 5x5"),
            std::string::npos);
  std::string negative = six_by_six("0", "0");
  EXPECT_NE(with(replaced(negative, "0.01", "-0.01")).find("negative variance"), std::string::npos);
  EXPECT_NE(with(replaced(six_by_six("0.001", "0.001"), "0,0.01,", "0,0,")).find("positive semi-definite"),
            std::string::npos);
  const auto good = read_text(
      replaced(kPassport, "[poses]", "[covariance]\nhand_eye = " + six_by_six("0.01", "0.01") + "\n[poses]"));
  EXPECT_TRUE(good) << good.error().message;  // singular, but semi-definite
}

TEST(ScopeFile, ReadsTheLensesCovarianceWhereOlderPassportsKeepIt) {
  std::string square;
  for (int i = 0; i < 25; ++i) square += i % 6 == 0 ? "0.04," : "0,";
  const auto scope = read_text(kPassport + std::string("[residuals]\ncovariance = [") + square + "]\n");
  ASSERT_TRUE(scope) << scope.error().message;
  EXPECT_EQ((*scope->lens_covariance)(4, 4), 0.04);
  EXPECT_EQ((*scope->lens_covariance)(5, 5), 0);
}

TEST(ScopeFile, RefusesALensThatFoldsInsideTheMask) {
  const std::string error = error_with("coefficients = [0, 0, 0, 0, 0]", "coefficients = [-1.5, 0, 0, 0, 0]");
  EXPECT_NE(error.find("scope.toml:11: [lens] coefficients fold the picture back inside the mask's circle"),
            std::string::npos)
      << error;
}

TEST(ScopeFile, AcceptsALensThatFoldsOnlyBeyondTheMask) {
  const auto scope =
      read_text(replaced(kPassport, "coefficients = [0, 0, 0, 0, 0]", "coefficients = [-0.4, 0, 0, 0, 0]"));
  ASSERT_TRUE(scope) << scope.error().message;
  EXPECT_LT(scope->lens.max_angle_rad, 0.75);
}

TEST(ScopeFile, RefusesAConeWiderThanTheLensIsGoodFor) {
  const TemporaryFolder folder;
  const std::string text =
      replaced(replaced(kPassport, "coefficients = [0, 0, 0, 0, 0]", "coefficients = [-0.4, 0, 0, 0, 0]"),
               "half_angle_rad = 0.46", "half_angle_rad = 0.9");
  const auto read = read_text(text);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find(
                "scope.toml:17: [cone] half_angle_rad is wider than the lens is good for; up to 0."),
            std::string::npos)
      << read.error().message;
}

TEST(ScopeFile, RefusesAMaskOutsideThePicture) {
  EXPECT_NE(error_with("[mask]\ncx_px = 320", "[mask]\ncx_px = 641").find("scope.toml:13: [mask] cx_px"),
            std::string::npos);
}

TEST(ScopeFile, RefusesTheWrongNumberOfCoefficients) {
  EXPECT_NE(error_with("[0, 0, 0, 0, 0]", "[0, 0, 0, 0]").find("scope.toml:11: [lens] coefficients"),
            std::string::npos);
  EXPECT_NE(error_with("model = \"brown\"", "model = \"fisheye\"").find("coefficients"), std::string::npos);
  EXPECT_NE(error_with("model = \"brown\"", "model = \"pinhole\"").find("scope.toml:6: [lens] model"),
            std::string::npos);
}

TEST(ScopeFile, RefusesAnUnknownKeyAndTellsAllErrorsAtOnce) {
  const std::string error = error_with("width_px = 640", "width_px = -1\nradius = 3");
  EXPECT_NE(error.find("scope.toml:2: width_px"), std::string::npos) << error;
  EXPECT_NE(error.find("scope.toml:3: radius is not known"), std::string::npos) << error;
}

TEST(ScopeFile, MendsAPoseThatIsNearlyARotationAndRefusesOthers) {
  std::vector<std::string> notes;
  const auto mended = read_text(replaced(kPassport, "X_SC = [1,", "X_SC = [1.004,"), &notes);
  ASSERT_TRUE(mended) << mended.error().message;
  EXPECT_TRUE(mended->X_SC.rotation.isIdentity(1e-12));
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("X_SC differs by 0.008 from a rotation and was made one"), std::string::npos);
  EXPECT_NE(error_with("X_SC = [1,", "X_SC = [1.01,").find("up to 0.01 is accepted"), std::string::npos);
  EXPECT_NE(error_with("X_SC = [1,", "X_SC = [-1,").find("holds a reflection"), std::string::npos);
}

TEST(ScopeFile, SaysWhatIsMissing) {
  const auto read = read_text("");
  ASSERT_FALSE(read);
  for (const char* key : {"name", "width_px", "medium", "fx_px", "radius_px", "half_angle_rad", "X_SC"})
    EXPECT_NE(read.error().message.find(key), std::string::npos) << key;
  EXPECT_FALSE(read_scope("/no/such/scope.toml"));
}

TEST(RegistrationFile, ComesBackAsItWasWritten) {
  const TemporaryFolder folder;
  RegistrationFile registration{.surface_hash = "0123", .fre_mm = 1.0 / 3, .predicted_tre_mm = 0.6};
  registration.X_MR.rotation =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(3, 2, 1).normalized()).toRotationMatrix();
  registration.X_MR.translation_mm = {-62.1, -118, 96};
  registration.covariance = TwistCovariance::Identity() / 3;
  ASSERT_TRUE(write_registration(folder / "r.toml", registration));
  const auto back = read_registration(folder / "r.toml");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_TRUE(back->X_MR.rotation.isApprox(registration.X_MR.rotation, 1e-14));
  EXPECT_EQ(back->X_MR.translation_mm, registration.X_MR.translation_mm);
  EXPECT_EQ(back->surface_hash, registration.surface_hash);
  EXPECT_EQ(back->fre_mm, registration.fre_mm);
  ASSERT_TRUE(back->covariance);
  EXPECT_EQ(*back->covariance, *registration.covariance);
}

TEST(RegistrationFile, IsRefusedWithoutItsSurface) {
  const TemporaryFolder folder;
  const auto read = read_registration(
      folder.write("r.toml", "X_MR = [1,0,0,0, 0,1,0,0, 0,0,1,0]\nfre_mm = 0.1\npredicted_tre_mm = 0.2\n"));
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("surface_hash is missing"), std::string::npos) << read.error().message;
}

}  // namespace
}  // namespace orcart
