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
  const std::size_t bytes = poll_exchange_bytes(settings.tools.size(), settings.poll);
  const double needed_ms = milliseconds(ndi::wire_time(bytes, settings.baud));
  const double most_hz = std::floor(kUsableShare * 1e3 / needed_ms);
  return "tracker poll rate " + number(settings.poll_rate_hz) + " Hz does not fit: a poll of " +
         std::to_string(settings.tools.size()) + " tools takes " + number(needed_ms) + " ms at " +
         std::to_string(settings.baud) + " baud; at most " + number(most_hz) + " Hz would be accepted";
}

}  // namespace

std::string TrackedTool::name() const {
  if (!wired) return definition.part_number;
  return "in port " + std::to_string(wired->number) +
         (wired->channel > 0 ? ", channel " + std::to_string(wired->channel) : "");
}

std::size_t poll_exchange_bytes(std::size_t tools, PollForm form) noexcept {
  constexpr std::size_t kCommand = 12, kFrameCommand = 53;
  return (form == PollForm::bx2 ? kFrameCommand : kCommand) + poll_reply_bytes(tools, form);
}

std::size_t poll_reply_bytes(std::size_t tools, PollForm form) noexcept {
  constexpr std::size_t kHeaderAndCrc = 8;
  constexpr std::size_t kFloats = 8 * 4;
  switch (form) {
    case PollForm::tx:  // count, then handle, 51 letters, status, frame, line feed; system status, CRC
      return 2 + tools * (2 + 51 + 8 + 8 + 1) + 4 + 5;
    case PollForm::bx2:  // two levels of components, and one alert
      return kHeaderAndCrc + 4 + 12 + 16 + 4 + 12 + tools * (4 + kFloats) + 16;
    default:  // count, then handle, state, port status, frame; system status
      return kHeaderAndCrc + 1 + tools * (2 + kFloats + 8) + 2;
  }
}

bool rate_fits(const PollLoad& load, std::uint32_t baud) noexcept {
  const std::size_t bytes = poll_exchange_bytes(load.tools, load.form);
  return seconds(ndi::wire_time(bytes, baud)) * load.rate_hz <= kUsableShare;
}

PollLoad load_of(const NdiSettings& settings) noexcept {
  return {.tools = settings.tools.size(), .rate_hz = settings.poll_rate_hz, .form = settings.poll};
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
  if (settings.beeps_when_tracking < 0 || settings.beeps_when_tracking > 9) {
    return fail("tracker is to beep " + std::to_string(settings.beeps_when_tracking) +
                " times; 0 to 9 would be accepted");
  }
  if (!rate_fits(load_of(settings), settings.baud)) return fail(unfit_sentence(settings));
  return {};
}

}  // namespace orcart
