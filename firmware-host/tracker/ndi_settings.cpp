// Checks the tracker's settings before anything is opened.
#include "firmware-host/tracker/ndi_settings.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "firmware-host/tracker/tracker_reply.hpp"

namespace orcart {
namespace {

constexpr double kMinRateHz = 1;
constexpr double kMaxRateHz = 400;
constexpr double kUsableShare = 0.9;

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

std::string known_bauds() {
  std::string list;
  for (const ndi::BaudCode& row : ndi::kBaudCodes) list += std::to_string(row.baud) + ", ";
  return list + "or 0 for a network device";
}

bool is_rate(double rate_hz) {
  return std::isfinite(rate_hz) && rate_hz >= kMinRateHz && rate_hz <= kMaxRateHz;
}

std::string unfit_sentence(const NdiSettings& settings) {
  const std::size_t bytes = poll_exchange_bytes(settings.tools.size());
  const double needed_ms = milliseconds(ndi::wire_time(bytes, settings.baud));
  const double most_hz = std::floor(kUsableShare * 1e3 / needed_ms);
  return "tracker poll rate " + number(settings.poll_rate_hz) + " Hz does not fit: a poll of " +
         std::to_string(settings.tools.size()) + " tools takes " + number(needed_ms) + " ms at " +
         std::to_string(settings.baud) + " baud; at most " + number(most_hz) + " Hz would be accepted";
}

}  // namespace

std::size_t poll_exchange_bytes(std::size_t tools) noexcept {
  constexpr std::size_t kCommand = 12;
  return kCommand + poll_reply_bytes(tools);
}

std::size_t poll_reply_bytes(std::size_t tools) noexcept {
  constexpr std::size_t kEnvelope = 6 + 1 + 2 + 2;  // header, count, system status, CRC
  constexpr std::size_t kTool = 2 + 8 * 4 + 4 + 4;
  return kEnvelope + tools * kTool;
}

bool rate_fits(std::size_t tools, double rate_hz, std::uint32_t baud) noexcept {
  return seconds(ndi::wire_time(poll_exchange_bytes(tools), baud)) * rate_hz <= kUsableShare;
}

Result<void> check(const NdiSettings& settings) {
  if (settings.tools.empty() || settings.tools.size() > kMaxTools) {
    return fail("tracker has " + std::to_string(settings.tools.size()) + " tools; 1 to " +
                std::to_string(kMaxTools) + " would be accepted");
  }
  for (const double rate_hz : {settings.poll_rate_hz, settings.device_rate_hz}) {
    if (!is_rate(rate_hz)) {
      return fail("tracker rate " + number(rate_hz) + " Hz is out of range; 1 to 400 would be accepted");
    }
  }
  if (settings.baud != 0 && !ndi::code_of_baud(settings.baud)) {
    return fail("tracker baud " + std::to_string(settings.baud) +
                " is none that NDI devices have; accepted are " + known_bauds());
  }
  if (!rate_fits(settings.tools.size(), settings.poll_rate_hz, settings.baud))
    return fail(unfit_sentence(settings));
  return {};
}

}  // namespace orcart
