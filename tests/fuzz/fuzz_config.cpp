// Any text as cart.toml: the reader and a section of every kind of key.
#include <cstddef>
#include <cstdint>

#include "firmware-host/app/tracker_config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto reader = orcart::TomlReader::parse({reinterpret_cast<const char*>(data), size}, "/tmp/fuzzed.toml");
  if (!reader) return 0;
  orcart::TrackerConfig tracker;
  orcart::read_tracker((*reader)->section("tracker"), tracker);
  const auto other = (*reader)->section("scope");
  (void)other.numbers("numbers", 0, std::vector<double>{});
  (void)other.texts("texts", std::vector<std::string>{});
  (void)other.matrix_3x4("matrix", std::array<double, 12>{});
  (void)other.flag("flag", false);
  for (const auto& table : (*reader)->sections("list")) (void)table.text("name", "x");
  (void)(*reader)->finish();
  return 0;
}
