// A recorded conversation with an NDI device, read from the notations in which such recordings are passed on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "realtime/base/result.hpp"

namespace orcart::ndi {

enum class Speaker : std::uint8_t { host, device };

/// One command or one reply, with its carriage return where it had one. A binary reply recorded in pieces is
/// whole.
struct DialogueRecord {
  Speaker speaker = Speaker::host;
  int number = 0;  ///< as the recording counts
  std::string bytes;
  bool cut_off = false;  ///< the recording ends in the middle of it
};

using Dialogue = std::vector<DialogueRecord>;

/// Three notations, told apart by their content: log lines `N. command[len] text` with \xHH escapes; the same
/// unescaped, the last carriage return of a message stored as a line feed; and `sent:N = text` / `recv:N =
/// text`. Whatever a program writes in front of a record on its line (a time, a level) is passed over; lines
/// may end as on any system. Empty entries are left out. Refused: a file that holds no record of any of them.
/// Any bytes are safe.
Result<Dialogue> parse_dialogue(std::string_view content, std::string_view name);
Result<Dialogue> read_dialogue(const std::filesystem::path& file);

}  // namespace orcart::ndi
