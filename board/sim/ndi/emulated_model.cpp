// The table of devices. Families and generations are NDI's, revisions are the emulator's own.
#include "board/sim/ndi/emulated_model.hpp"

#include <array>

namespace orcart {
namespace {

constexpr std::array<EmulatedModel, 5> kModels{{
    {NdiModel::polaris, "polaris", "Polaris", "POLARIS Rev 024", "", 115'200, false, false, true, '0'},
    {NdiModel::spectra, "spectra", "Polaris Spectra", "orcart.001", "G.001.005", 1'228'739, true, false, true,
     '0'},
    {NdiModel::vega, "vega", "Polaris Vega", "orcart.001", "G.003.007", 1'228'739, true, true, true, '0'},
    {NdiModel::lyra, "lyra", "Polaris Lyra", "orcart.001", "G.003.010", 1'228'739, true, true, true, '0'},
    {NdiModel::aurora, "aurora", "Aurora", "AURORA Rev 024", "D.001.007", 921'600, false, false, false, '1'},
}};

}  // namespace

bool EmulatedModel::knows(std::string_view command) const noexcept {
  if (command == "GET" || command == "SET" || command == "GETINFO") return has_parameters;
  if (command == "BX2") return has_frames;
  if (command == "APIREV") return !api_revision.empty();
  if (command == "PHRQ" || command == "PVWR") return has_wireless;
  return true;
}

const EmulatedModel& description_of(NdiModel model) noexcept {
  return kModels[static_cast<std::size_t>(model)];
}

std::optional<NdiModel> ndi_model_named(std::string_view word) noexcept {
  for (const EmulatedModel& row : kModels) {
    if (row.word == word) return row.model;
  }
  return std::nullopt;
}

}  // namespace orcart
