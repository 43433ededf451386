// Files that do not belong together are refused before anything is armed.
#include "firmware-host/app/patient.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/firmware-host/app/demo_cart.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart::testing {
namespace {

CartConfig demo() {
  auto config = read_cart(demo_cart()).value();
  config.texel_mm = 1;  // quick
  return config;
}

TEST(Patient, OfTheShippedDemoIsWhole) {
  const auto patient = read_patient(demo());
  ASSERT_TRUE(patient) << patient.error().message;
  EXPECT_TRUE(patient->surface.closed);
  EXPECT_EQ(patient->registration.surface_hash, patient->surface.identity.hash);
  EXPECT_FALSE(patient->layout.owners.empty());
}

TEST(Patient, RefusesARegistrationOfAnotherSurface) {
  const TemporaryFolder folder;
  CartConfig config = demo();
  const std::string text = text_of(config.registration);
  const std::string other = "0123456789abcdef0123456789abcdef";
  const std::string hash = read_patient(config).value().surface.identity.hash;
  config.registration = folder.write("other.toml", replaced(text, hash, other));
  const auto patient = read_patient(config);
  ASSERT_FALSE(patient);
  for (const std::string& named : {other, hash, config.registration.string(), config.surface.string()})
    EXPECT_NE(patient.error().message.find(named), std::string::npos) << patient.error().message;
}

TEST(Patient, TellsAPoseThatWasMended) {
  const TemporaryFolder folder;
  CartConfig config = demo();
  config.registration =
      folder.write("r.toml", replaced(text_of(config.registration), "0.477097364", "0.485097364"));
  const auto patient = read_patient(config);
  ASSERT_TRUE(patient) << patient.error().message;
  EXPECT_TRUE(std::any_of(patient->notes.begin(), patient->notes.end(), [&](const std::string& note) {
    return note.starts_with(config.registration.string()) &&
           note.find("X_MR differs by") != std::string::npos;
  })) << ::testing::PrintToString(patient->notes);
}

TEST(Patient, RefusesAPassportOfAnotherPictureSize) {
  CartConfig config = demo();
  config.camera.width_px = 1280;
  config.camera.height_px = 720;
  const auto patient = read_patient(config);
  ASSERT_FALSE(patient);
  EXPECT_NE(patient.error().message.find("640x480"), std::string::npos) << patient.error().message;
  EXPECT_NE(patient.error().message.find("1280x720"), std::string::npos) << patient.error().message;
}

TEST(Patient, AnotherMediumThanThePassportsBlocksPaintingAndSaysSo) {
  CartConfig config = demo();
  EXPECT_EQ(read_patient(config).value().painting_blocked, "");
  config.passport.medium = Medium::air;
  const auto patient = read_patient(config);
  ASSERT_TRUE(patient) << patient.error().message;
  EXPECT_NE(patient->painting_blocked.find("calibrated in saline, used in air"), std::string::npos)
      << patient->painting_blocked;
}

TEST(Patient, AScopeThatTurnsIsPutAtItsTurnAndNotPaintedWithUntilItIsSaid) {
  const TemporaryFolder folder;
  CartConfig config = demo();
  config.turn_rad = 0.5;
  const auto senseless = read_patient(config);
  ASSERT_FALSE(senseless);
  EXPECT_NE(senseless.error().message.find("no [turning]"), std::string::npos) << senseless.error().message;

  config.turn_rad.reset();
  config.turn_deviation_rad = 0.01;
  const auto as_senseless = read_patient(config);
  ASSERT_FALSE(as_senseless);
  EXPECT_NE(as_senseless.error().message.find("turn_deviation_deg means nothing"), std::string::npos)
      << as_senseless.error().message;
  config.turn_deviation_rad.reset();
  config.turn_rad = 0.5;

  config.scope = folder.write("angled.toml", text_of(config.scope) +
                                                 "\n[turning]\nview_angle_rad = 0.5236\ncentre_px = [320, "
                                                 "240]\nmarker = \"shaft\"\n");
  const auto patient = read_patient(config);
  ASSERT_TRUE(patient) << patient.error().message;
  EXPECT_EQ(patient->painting_blocked, "");
  EXPECT_NE(patient->scope.lens.cx_px, 321.5);
  config.turn_rad.reset();
  const auto unsaid = read_patient(config);
  ASSERT_TRUE(unsaid) << unsaid.error().message;
  EXPECT_EQ(unsaid->painting_blocked, "PAINTING BLOCKED: say [scope] turn_deg or --turn");
  EXPECT_EQ(unsaid->scope.lens.cx_px, 321.5);
}

TEST(Patient, RefusesAPassportThatHasExpired) {
  const TemporaryFolder folder;
  CartConfig config = demo();
  const std::string text = text_of(config.scope);
  config.scope = folder.write(
      "old.toml", replaced(text, "calibrated_on = \"2026-11-20\"", "expires_on = \"2001-01-01\""));
  const auto patient = read_patient(config);
  ASSERT_FALSE(patient);
  EXPECT_NE(patient.error().message.find("expired on 2001-01-01"), std::string::npos)
      << patient.error().message;
}

TEST(Patient, RefusesToLookFromInsideAnOpenSurface) {
  const TemporaryFolder folder;
  CartConfig config = demo();
  config.surface =
      folder.write("open.ply",
                   "ply\nformat ascii 1.0\ncomment SPACE=LPS\nelement vertex 3\nproperty float x\n"
                   "property float y\nproperty float z\nelement face 1\n"
                   "property list uchar int vertex_indices\nend_header\n"
                   "0 0 0\n10 0 0\n0 10 0\n3 0 1 2\n");
  const auto patient = read_patient(config);
  ASSERT_FALSE(patient);
  EXPECT_NE(patient.error().message.find("open"), std::string::npos) << patient.error().message;
  EXPECT_NE(patient.error().message.find("inside"), std::string::npos) << patient.error().message;
}

TEST(Patient, AScopeThatIsFollowedStaysAtThePassportsTurnAndIsRefusedWhereThatLacksWhatItIsFollowedBy) {
  const TemporaryFolder folder;
  CartConfig config = demo();
  const auto angled = demo_cart().parent_path().parent_path() / "scopes/neuro-30.toml";
  config.scope = angled;
  for (const TurnSource source : {TurnSource::marker, TurnSource::notch}) {
    config.turn = source;
    const auto patient = read_patient(config);
    ASSERT_TRUE(patient) << patient.error().message;
    EXPECT_EQ(patient->painting_blocked, "");
    EXPECT_EQ(patient->scope.lens.cx_px, 321.5);
  }
  config.turn = TurnSource::encoder;
  EXPECT_EQ(read_patient(config)->painting_blocked, "") << "the notch tells the zero";
  config.scope = folder.write("no-notch.toml", replaced(text_of(angled), "notch_rad = -1.5\n", ""));
  EXPECT_EQ(read_patient(config)->painting_blocked, "PAINTING BLOCKED: say [scope] turn_deg or --turn");
  config.turn_rad = 0.5;
  const auto told = read_patient(config);
  EXPECT_EQ(told->painting_blocked, "");
  EXPECT_EQ(told->scope.lens.cx_px, 321.5);
  config.turn_rad.reset();
  config.encoder.counts_at_zero = 12;
  EXPECT_EQ(read_patient(config)->painting_blocked, "");
  const std::string text = text_of(angled);
  const auto refusal_of = [&](TurnSource source, const std::string& passport) {
    config.turn = source;
    config.scope = folder.write("lacking.toml", passport);
    const auto patient = read_patient(config);
    return patient ? "accepted" : patient.error().message;
  };
  EXPECT_NE(
      refusal_of(TurnSource::notch, replaced(text, "notch_rad = -1.5\n", "")).find("no [mask] notch_rad"),
      std::string::npos);
  const auto second = text.find("R_SL");
  ASSERT_NE(second, std::string::npos);
  const std::string without = text.substr(0, second) + text.substr(text.find('\n', second));
  EXPECT_NE(refusal_of(TurnSource::marker, without).find("no [turning] R_SL"), std::string::npos);
  config = demo();
  config.turn = TurnSource::notch;
  const auto straight = read_patient(config);
  ASSERT_FALSE(straight);
  EXPECT_NE(straight.error().message.find("no [turning]"), std::string::npos) << straight.error().message;
}

}  // namespace
}  // namespace orcart::testing
