// Tells two contents apart: FNV-1a, 64 bits (Fowler, Noll, Vo), as 16 hexadecimal digits. No protection.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace orcart {

/// Of a text's bytes, or of a range of std::uint8_t.
template <class Bytes>
std::string hash_of(const Bytes& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const auto byte : bytes) hash = (hash ^ static_cast<std::uint8_t>(byte)) * 0x100000001b3;
  char hex[17];
  std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(hash));
  return hex;
}

}  // namespace orcart
