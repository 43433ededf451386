// What a recorded dialogue contains, counted, and what is wrong in it, listed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware-host/tracker/ndi/dialogue.hpp"
#include "firmware-host/tracker/ndi/tracking_reply.hpp"

namespace orcart::ndi {

/// CRCs are counted one by one: a command or text reply has one, a binary reply two (header and body).
/// Transforms, missing and disabled tools are counted in good replies to TX and BX; those whose options this
/// program does not know are counted, but not placed.
struct DialogueFigures {
  std::uint64_t commands = 0;
  std::uint64_t replies = 0;
  std::uint64_t crc_good = 0;
  std::uint64_t crc_bad = 0;
  std::uint64_t transforms = 0;
  std::uint64_t missing = 0;
  std::uint64_t disabled = 0;
  std::uint64_t errors = 0;           ///< ERRORhh
  std::uint64_t unanswered = 0;       ///< commands without a reply, and replies without their carriage return
  std::vector<std::string> remarks;   ///< one sentence for each thing that is wrong
  std::vector<HandleReading> placed;  ///< the transforms, in the order of the recording
};

DialogueFigures count_dialogue(const Dialogue& dialogue);

}  // namespace orcart::ndi
