// The tables of faults, alerts and events.
#include "firmware-host/tracker/ndi/system_alerts.hpp"

#include <array>

namespace orcart::ndi {
namespace {

struct Row {
  std::uint8_t code;
  int parameter_bit;  ///< in Info.Status.Alerts; -1 where it has none
  std::string_view word;
};
constexpr auto kFaults = std::to_array<Row>({{1, 0, "fatal parameter fault"},
                                             {2, 1, "sensor parameter fault"},
                                             {3, 2, "main voltage fault"},
                                             {4, 3, "sensor voltage fault"},
                                             {5, 4, "illuminator voltage fault"},
                                             {6, 5, "illuminator current fault"},
                                             {7, 6, "left sensor's temperature"},
                                             {8, 7, "right sensor's temperature"},
                                             {9, 8, "main board's temperature"},
                                             {10, -1, "sensor malfunction"}});
constexpr auto kAlerts = std::to_array<Row>({{1, 20, "battery low"},
                                             {2, 21, "the sensor was bumped"},
                                             {3, 23, "incompatible firmware"},
                                             {4, 24, "non-fatal parameter fault"},
                                             {5, 25, "flash memory full"},
                                             {6, 26, "laser battery low"},
                                             {7, -1, "storage temperature exceeded"},
                                             {8, 29, "temperature too high"},
                                             {9, 30, "temperature too low"},
                                             {10, 22, "control unit disconnected"},
                                             {11, -1, "power supply disconnected"},
                                             {12, -1, "field generator disconnected"},
                                             {13, -1, "hardware changed"},
                                             {14, -1, "clock out of step with the network"}});
constexpr auto kEvents = std::to_array<Row>({{1, -1, "tool plugged in"},
                                             {2, -1, "tool unplugged"},
                                             {3, -1, "interface unit plugged in"},
                                             {4, -1, "interface unit unplugged"}});

template <class Rows>
std::uint32_t codes_of(std::uint32_t bits, const Rows& rows) noexcept {
  std::uint32_t codes = 0;
  for (const Row& row : rows) {
    if (row.parameter_bit >= 0 && (bits >> row.parameter_bit & 1u) != 0) codes |= 1u << row.code;
  }
  return codes;
}

template <class Rows>
std::uint32_t bits_of(std::uint32_t codes, const Rows& rows) noexcept {
  std::uint32_t bits = 0;
  for (const Row& row : rows) {
    if (row.parameter_bit >= 0 && (codes >> row.code & 1u) != 0) bits |= 1u << row.parameter_bit;
  }
  return bits;
}

template <class Rows>
void put_words(std::uint32_t codes, const Rows& rows, std::string& into) {
  for (std::uint8_t code = 0; code < 32; ++code) {
    if ((codes >> code & 1u) == 0) continue;
    std::string word = "condition " + std::to_string(code);
    for (const Row& row : rows) {
      if (row.code == code) word = row.word;
    }
    if (!into.empty()) into += ", ";
    into += word;
  }
}

}  // namespace

void note_alert(SystemAlerts& alerts, std::uint8_t kind, std::uint16_t code) noexcept {
  if (code > 31) return;
  const std::uint32_t bit = 1u << code;
  if (kind == static_cast<std::uint8_t>(AlertKind::fault)) alerts.faults |= bit;
  if (kind == static_cast<std::uint8_t>(AlertKind::alert)) alerts.alerts |= bit;
  if (kind == static_cast<std::uint8_t>(AlertKind::event)) alerts.events |= bit;
}

SystemAlerts alerts_from_parameter(std::uint32_t bits) noexcept {
  return {.faults = codes_of(bits, kFaults), .alerts = codes_of(bits, kAlerts)};
}

std::uint32_t parameter_from_alerts(const SystemAlerts& alerts) noexcept {
  return bits_of(alerts.faults, kFaults) | bits_of(alerts.alerts, kAlerts);
}

std::string alert_words(const SystemAlerts& alerts) {
  std::string words;
  put_words(alerts.faults, kFaults, words);
  put_words(alerts.alerts, kAlerts, words);
  put_words(alerts.events, kEvents, words);
  return words;
}

}  // namespace orcart::ndi
