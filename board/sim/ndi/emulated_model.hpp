// Which NDI device the emulator plays: what each generation knows, and how it introduces itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace orcart {

/// From the oldest Polaris to the newest, and the electromagnetic one.
enum class NdiModel : std::uint8_t { polaris, spectra, vega, lyra, aurora };

struct EmulatedModel {
  NdiModel model;
  std::string_view word;          ///< on a command line
  std::string_view family;        ///< begins its version text
  std::string_view firmware;      ///< revision
  std::string_view api_revision;  ///< empty: it does not know APIREV
  std::uint32_t fastest_baud;
  bool has_parameters;  ///< GET, SET, GETINFO
  bool has_frames;      ///< BX2
  bool has_wireless;    ///< PHRQ and PVWR
  char system_letter;   ///< in a port's location: 0 optical, 1 magnetic

  /// False for commands that came with a later generation.
  bool knows(std::string_view command) const noexcept;
};

const EmulatedModel& description_of(NdiModel model) noexcept;
std::optional<NdiModel> ndi_model_named(std::string_view word) noexcept;

}  // namespace orcart
