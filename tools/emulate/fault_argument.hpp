// A fault as a person types it: KIND[:AMOUNT][@FROM[-UNTIL]][/EVERY], seconds from the start.
#pragma once

#include <string_view>

#include "board/sim/ndi/fault_schedule.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// `late:40@2-5/3`: every third reply is 40 ms late from second 2 to second 5. Refused in a sentence.
Result<NdiFaultWindow> parse_fault(std::string_view text, Instant start);

}  // namespace orcart
