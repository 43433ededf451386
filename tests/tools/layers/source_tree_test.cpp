// The layer check over the whole source tree: no file breaks a rule, and every room says what it is for.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/tools/layers/layer_rules.hpp"

namespace orcart::layers {
namespace {

namespace fs = std::filesystem;

fs::path source_dir() {
  const char* dir = std::getenv("ORCART_SOURCE_DIR");
  return dir != nullptr ? dir : ".";
}

bool is_source(const fs::path& path) {
  return path.extension() == ".cpp" || path.extension() == ".hpp" || path.extension() == ".h";
}

constexpr const char* kRooms[] = {"realtime", "board", "render", "firmware-host", "tools", "tests"};

std::vector<Source> all_sources() {
  std::vector<Source> sources;
  for (const char* room : kRooms)
    for (const auto& entry : fs::recursive_directory_iterator(source_dir() / room)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      std::ifstream file(entry.path(), std::ios::binary);
      sources.push_back({fs::relative(entry.path(), source_dir()).generic_string(),
                         std::string(std::istreambuf_iterator<char>(file), {})});
    }
  return sources;
}

TEST(SourceTree, KeepsTheRulesOfTheHouse) {
  const auto sources = all_sources();
  ASSERT_GT(sources.size(), 30U) << "the source tree was not found at " << source_dir();
  for (const Source& source : sources)
    for (const Finding& finding : check(source))
      ADD_FAILURE() << finding.path << ":" << finding.line << ": " << finding.what;
}

TEST(SourceTree, ExplainsEveryRoom) {
  for (const char* room : kRooms) EXPECT_TRUE(fs::exists(source_dir() / room / "README.md")) << room;
}

}  // namespace
}  // namespace orcart::layers
