// A passport that is old, poor or another scope's is refused; another medium blocks painting, in words that
// fit.
#include "firmware-host/files/passport_check.hpp"

#include <gtest/gtest.h>

namespace orcart::testing {
namespace {

constexpr const char* kToday = "2026-11-26";

ScopeModel passport() {
  ScopeModel scope{.name = "scope", .serial = "AB12"};
  scope.X_SC.translation_mm = {1, 2, 200};
  scope.calibrated_on = "2026-11-20";
  scope.expires_on = "2026-11-26";
  scope.residual_px = 0.4, scope.residual_mm = 0.9;
  return scope;
}

std::string refusal(const ScopeModel& scope, const PassportWish& wish = {}) {
  const auto checked = check_passport(scope, wish, kToday, "scope.toml");
  return checked ? "" : checked.error().message;
}

void expect_refused(const ScopeModel& scope, const PassportWish& wish, const std::string& word) {
  const std::string said = refusal(scope, wish);
  EXPECT_NE(said.find(word), std::string::npos) << said;
  EXPECT_NE(said.find("scope.toml"), std::string::npos) << said;
}

TEST(Passport, IsTakenToTheDayItExpires) {
  EXPECT_EQ(refusal(passport()), "");
  EXPECT_EQ(refusal(passport(), {.serial = "AB12"}), "");
}

TEST(Passport, IsRefusedOnceItHasExpiredOrWhereItsDatesAreNone) {
  ScopeModel scope = passport();
  scope.expires_on = "2026-11-25";
  expect_refused(scope, {}, "expired on 2026-11-25");
  scope.expires_on = "next year";
  expect_refused(scope, {}, "is no date");
  scope.expires_on = "";
  EXPECT_EQ(refusal(scope), "");
  scope.calibrated_on = "2026-11-27";
  EXPECT_EQ(refusal(scope), "");
  scope.expires_on = "2027-11-27";
  expect_refused(scope, {}, "after today");
}

TEST(Passport, IsRefusedBeyondItsLimits) {
  ScopeModel scope = passport();
  scope.residual_px = 1.01;
  expect_refused(scope, {}, "1.01 px");
  scope.residual_px = 0.4, scope.residual_mm = 2.3;
  expect_refused(scope, {}, "2.30 mm");
  EXPECT_EQ(refusal(scope, {.most_residual_mm = 2.5}), "");
}

TEST(Passport, OfAnotherScopeOrWithoutHandEyeIsRefused) {
  expect_refused(passport(), {.serial = "AB13"}, "AB13");
  ScopeModel scope = passport();
  scope.serial = "";
  expect_refused(scope, {.serial = "AB13"}, "without a serial number");
  scope.X_SC = {};
  expect_refused(scope, {}, "handeye");
}

TEST(Passport, AnotherMediumOrNoneBlocksPaintingInWordsThatFitThePanel) {
  EXPECT_EQ(medium_objection(Medium::saline, Medium::saline), "");
  for (const Medium calibrated : {Medium::air, Medium::water, Medium::saline})
    for (const auto& used : {std::optional<Medium>{}, std::optional(Medium::air),
                             std::optional(Medium::water), std::optional(Medium::saline)}) {
      const std::string said = medium_objection(calibrated, used);
      if (used == calibrated) continue;
      EXPECT_NE(said.find("PAINTING BLOCKED"), std::string::npos);
      EXPECT_LE(said.size(), 54U) << said;
    }
}

}  // namespace
}  // namespace orcart::testing
