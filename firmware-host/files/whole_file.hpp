// Reads a whole file within a stated size, and writes one so that no reader ever finds half of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "realtime/base/result.hpp"

namespace orcart {

/// The file's bytes; refuses a folder, a missing or unreadable file and one over `largest_bytes`.
Result<std::vector<std::byte>> read_whole_file(const std::filesystem::path& file,
                                               std::uintmax_t largest_bytes);

/// Writes a file beside (`.NAME.part-PID`), makes it durable, and renames it over `file`; on an error nothing
/// is left. A link stays one: what it leads to is replaced. A device or a pipe is written into as it is, and
/// refused where it has no reader.
Result<void> write_whole_file(const std::filesystem::path& file, std::span<const std::byte> bytes);
Result<void> write_whole_file(const std::filesystem::path& file, std::string_view text);

/// The name that a chain of symbolic links ends at, which may not be there; `file` itself where it is none.
std::filesystem::path behind_links(const std::filesystem::path& file);

}  // namespace orcart
