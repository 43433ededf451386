// What the position sensor says of itself: faults, alerts (the bump detector among them) and events.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace orcart::ndi {

/// One bit for each of NDI's condition codes 0 to 31: code n is bit n. Codes as in NDI's sample of its
/// combined API.
struct SystemAlerts {
  std::uint32_t faults = 0;  ///< the sensor may not be believed
  std::uint32_t alerts = 0;  ///< the sensor works, a person is wanted
  std::uint32_t events = 0;  ///< something was plugged in or out

  bool any() const noexcept { return (faults | alerts | events) != 0; }
  bool bumped() const noexcept { return (alerts & 1u << 2) != 0; }
  void add(const SystemAlerts& more) noexcept {
    faults |= more.faults;
    alerts |= more.alerts;
    events |= more.events;
  }
  /// Those that `known` does not hold.
  SystemAlerts except(const SystemAlerts& known) const noexcept {
    return {
        .faults = faults & ~known.faults, .alerts = alerts & ~known.alerts, .events = events & ~known.events};
  }
  bool operator==(const SystemAlerts&) const = default;
};

/// Kinds of condition as BX2 numbers them.
enum class AlertKind : std::uint8_t { fault = 0, alert = 1, event = 2 };

/// Codes above 31 and unknown kinds are passed over.
void note_alert(SystemAlerts& alerts, std::uint8_t kind, std::uint16_t code) noexcept;

/// The number that GET:Info.Status.Alerts and GET:Info.Status.New Alerts give: faults from bit 0, alerts from
/// bit 20.
SystemAlerts alerts_from_parameter(std::uint32_t bits) noexcept;
std::uint32_t parameter_from_alerts(const SystemAlerts& alerts) noexcept;

/// All of them in words, separated by commas; empty where there is none. Allocates: not for a step().
std::string alert_words(const SystemAlerts& alerts);

}  // namespace orcart::ndi
