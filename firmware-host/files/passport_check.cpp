// Each refusal is one sentence with what would be accepted.
#include "firmware-host/files/passport_check.hpp"

#include <array>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <ctime>

namespace orcart {
namespace {

bool is_iso_date(std::string_view text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (i != 4 && i != 7 && std::isdigit(static_cast<unsigned char>(text[i])) == 0) return false;
  return text.substr(5, 2) >= "01" && text.substr(5, 2) <= "12" && text.substr(8) >= "01" &&
         text.substr(8) <= "31";
}

std::string two_digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

Result<void> check_dates(const ScopeModel& scope, std::string_view today, const std::string& file) {
  for (const auto& [key, date] :
       {std::pair{"calibrated_on", &scope.calibrated_on}, std::pair{"expires_on", &scope.expires_on}})
    if (!date->empty() && !is_iso_date(*date))
      return fail(file + ": " + key + " = \"" + *date + "\" is no date; one like 2026-11-20 is accepted");
  if (!scope.expires_on.empty() && scope.expires_on < today)
    return fail(file + ": the passport expired on " + scope.expires_on + ", today is " + std::string(today) +
                "; calibrate the scope again");
  if (!scope.expires_on.empty() && scope.calibrated_on > today)
    return fail(file + ": calibrated on " + scope.calibrated_on + ", which is after today, " +
                std::string(today) + ", so nobody can tell whether it has expired; set this machine's clock");
  return {};
}

Result<void> check_residuals(const ScopeModel& scope, const PassportWish& wish, const std::string& file) {
  if (scope.residual_px > wish.most_residual_px)
    return fail(file + ": its residual of " + two_digits(scope.residual_px) +
                " px is beyond the limit; up to " + two_digits(wish.most_residual_px) +
                " px is accepted ([scope] most_residual_px)");
  if (scope.residual_mm > wish.most_residual_mm)
    return fail(file + ": its hand-eye residual of " + two_digits(scope.residual_mm) +
                " mm is beyond the limit; up to " + two_digits(wish.most_residual_mm) +
                " mm is accepted ([scope] most_residual_mm)");
  return {};
}

}  // namespace

Result<void> check_passport(const ScopeModel& scope, const PassportWish& wish, std::string_view today,
                            const std::filesystem::path& file) {
  if (!wish.serial.empty() && scope.serial != wish.serial)
    return fail(file.string() + ": the passport of " +
                (scope.serial.empty() ? "a scope without a serial number" : "the scope " + scope.serial) +
                ", but [scope] serial is " + wish.serial + "; load that scope's passport");
  if (auto dates = check_dates(scope, today, file.string()); !dates) return dates;
  if (scope.X_SC.rotation.isIdentity(0) && scope.X_SC.translation_mm.isZero(0))
    return fail(file.string() +
                ": X_SC is the identity, so nobody knows where the camera sits on its marker; run orcart "
                "calibrate handeye");
  return check_residuals(scope, wish, file.string());
}

std::string_view word_for(Medium medium) {
  switch (medium) {
    case Medium::water:
      return "water";
    case Medium::saline:
      return "saline";
    case Medium::air:
      break;
  }
  return "air";
}

std::string medium_objection(Medium calibrated_in, std::optional<Medium> used_in) {
  const std::string calibrated(word_for(calibrated_in));
  if (!used_in) return "PAINTING BLOCKED: say --medium (passport: " + calibrated + ")";
  if (*used_in == calibrated_in) return {};
  return "PAINTING BLOCKED: calibrated in " + calibrated + ", used in " + std::string(word_for(*used_in));
}

std::string iso_today() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", &parts);
  return text.data();
}

}  // namespace orcart
