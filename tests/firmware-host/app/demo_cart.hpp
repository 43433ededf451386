// The shipped demo's configuration, as text and as read.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace orcart::testing {

inline std::filesystem::path demo_cart() {
  return std::filesystem::path(std::getenv("ORCART_SOURCE_DIR")) / "share/carts/demo.toml";
}

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// `text` with the first `from` replaced; empty where it does not occur, so that a test cannot pass by
/// accident.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  return at == std::string::npos ? std::string{} : text.replace(at, from.size(), to);
}

}  // namespace orcart::testing
