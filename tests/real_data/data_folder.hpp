// Where recordings of real devices lie: in $ORCART_DATA, or beside the repository.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>

namespace orcart::testing {

inline constexpr std::string_view kNoData =
    "real recordings are not there; ORCART_DATA would name their folder";

/// The folder of one set; nothing where it is absent.
inline std::optional<std::filesystem::path> data_folder(std::string_view set) {
  const char* stated = std::getenv("ORCART_DATA");
  const char* source = std::getenv("ORCART_SOURCE_DIR");
  std::filesystem::path root =
      source != nullptr ? std::filesystem::path(source) / "../shared/data" : "../shared/data";
  if (stated != nullptr && *stated != '\0') root = stated;
  const std::filesystem::path folder = root / set;
  return std::filesystem::is_directory(folder) ? std::optional{folder} : std::nullopt;
}

}  // namespace orcart::testing
