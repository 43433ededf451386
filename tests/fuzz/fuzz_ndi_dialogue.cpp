// Any file as a recorded dialogue: read, count, and never count more than there is.
#include <cstddef>
#include <cstdint>

#include "firmware-host/tracker/ndi/dialogue_figures.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto dialogue = orcart::ndi::parse_dialogue({reinterpret_cast<const char*>(data), size}, "fuzzed");
  if (!dialogue) return 0;
  const auto figures = orcart::ndi::count_dialogue(*dialogue);
  if (figures.commands + figures.replies != dialogue->size()) __builtin_trap();
  if (figures.crc_good + figures.crc_bad > figures.commands + 2 * figures.replies) __builtin_trap();
  return 0;
}
