// zlib reads plain and gzipped files alike.
#include "tools/surface/plain_bytes.hpp"

#include <zlib.h>

#include <memory>
#include <vector>

namespace orcart {

std::uint64_t plain_bytes(const std::string& file, std::uint64_t enough) {
  const auto close = [](gzFile_s* open) { gzclose(open); };
  const std::unique_ptr<gzFile_s, decltype(close)> open(gzopen(file.c_str(), "rb"), close);
  if (!open) return 0;
  std::vector<char> buffer(1U << 16U);
  std::uint64_t bytes = 0;
  while (bytes < enough) {
    const int got = gzread(open.get(), buffer.data(), static_cast<unsigned>(buffer.size()));
    if (got <= 0) break;
    bytes += static_cast<std::uint64_t>(got);
  }
  return bytes;
}

}  // namespace orcart
