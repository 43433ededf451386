// Counts the bytes of a file as they are once uncompressed.
#pragma once

#include <cstdint>
#include <string>

namespace orcart {

/// How many bytes a file holds, gunzipped where it is a gzip, counted up to `enough`. 0 where it cannot be
/// read; what comes before damage counts.
std::uint64_t plain_bytes(const std::string& file, std::uint64_t enough);

}  // namespace orcart
