// Opens the tracker that cart.toml names: the one place where a kind of link becomes a ByteLink.
#pragma once

#include <memory>

#include "board/ports/byte_link.hpp"
#include "firmware-host/app/tracker_config.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// Null for the simulated tracker. Refused in a sentence with the remedy: absent, busy, no permission, not
/// answering. `clock` outlives the link.
Result<std::unique_ptr<ByteLink>> open_tracker(const TrackerConfig& tracker, Clock& clock);

}  // namespace orcart
