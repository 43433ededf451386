// Any bytes as a tool definition, read by the driver's side and by the emulator's.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "board/sim/ndi/emulated_port.hpp"
#include "firmware-host/tracker/ndi/tool_definition.hpp"

namespace {

/// Puts a right head and checksum on a file of the right size: else nothing behind them would ever be read.
void sign(std::vector<std::uint8_t>& file) {
  const std::array<std::uint8_t, 4> head{'N', 'D', 'I', 0};
  std::copy(head.begin(), head.end(), file.begin());
  std::uint32_t sum = 0;
  for (std::size_t i = 6; i < file.size(); ++i) sum += file[i];
  file[4] = static_cast<std::uint8_t>(sum & 0xFFu);
  file[5] = static_cast<std::uint8_t>(sum >> 8 & 0xFFu);
}

void read(std::span<const std::uint8_t> file) {
  const auto bytes = std::as_bytes(file);
  const auto tool = orcart::ndi::parse_tool_definition(bytes, "fuzzed");
  orcart::EmulatedPort port;
  port.allocate();
  const bool fits = port.write(0, bytes) == orcart::NdiError::none;
  const bool accepted = fits && port.initialise() == orcart::NdiError::none;
  // What the driver uploads, the device must take.
  if (tool && !accepted) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read({data, size});
  std::vector<std::uint8_t> file(data, data + size);
  file.resize(orcart::ndi::kRomFileBytes);
  sign(file);
  read(file);
  return 0;
}
