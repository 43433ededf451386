// A running 64-bit hash over numbers and bytes (FNV-1a), to tell whether a drawn movie belongs to a run.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>

namespace orcart {

class Fingerprint {
 public:
  template <class Number>
  Fingerprint& add(Number number) {
    char bytes[sizeof(Number)];
    std::memcpy(bytes, &number, sizeof(Number));
    return add_bytes({bytes, sizeof(Number)});
  }
  Fingerprint& add_bytes(std::string_view bytes) {
    for (const char byte : bytes) value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3ULL;
    return *this;
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace orcart
