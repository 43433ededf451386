// Any bytes as commands to the emulated tracker, whose every reply must be one that the driver's framing
// takes.
#include <cstddef>
#include <cstdint>
#include <string>

#include "board/sim/ndi/ndi_emulator.hpp"
#include "firmware-host/tracker/ndi/framing.hpp"
#include "realtime/base/crc16.hpp"

namespace {

class StillTool final : public orcart::ToolMotion {
 public:
  orcart::TrueToolPose pose_of(int, orcart::Instant) const noexcept override { return {}; }
};

/// The line as it is, and once more with a right CRC where it has the form for one.
std::string with_crc(std::string line) {
  if (line.find(':') == std::string::npos) return line;
  const unsigned crc = orcart::crc16(std::string_view(line));
  for (int shift = 12; shift >= 0; shift -= 4) line += "0123456789ABCDEF"[crc >> shift & 0xFu];
  return line;
}

void say(orcart::NdiEmulator& device, const std::string& line, orcart::Instant& now) {
  device.receive(std::as_bytes(std::span{line.data(), line.size()}), now);
  now += std::chrono::milliseconds(20);
  std::array<std::byte, 8192> reply{};
  const std::size_t size = device.read(reply, now);
  if (size == 0) return;
  const auto frame = orcart::ndi::find_binary_reply(std::span{reply}.first(size));
  const auto text = orcart::ndi::find_ascii_reply(std::span{reply}.first(size));
  const auto complete = orcart::ndi::FrameStatus::complete;
  if (frame.status != complete && text.status != complete) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const StillTool motion;
  static constexpr std::array kModels{orcart::NdiModel::polaris, orcart::NdiModel::vega,
                                      orcart::NdiModel::aurora};
  orcart::NdiEmulator device({.model = kModels[data[0] % kModels.size()], .has_line = false}, motion);
  orcart::Instant now = orcart::instant_from_nanos(1'000'000'000);
  const std::string_view text{reinterpret_cast<const char*>(data + 1), size - 1};
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line(text.substr(at, end - at));
    say(device, with_crc(line) + '\r', now);
    at = end + 1;
  }
  return 0;
}
