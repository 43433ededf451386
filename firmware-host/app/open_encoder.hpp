// The turn encoder that cart.toml names, opened.
#pragma once

#include <memory>

#include "board/ports/turn_encoder.hpp"
#include "firmware-host/app/device_config.hpp"
#include "realtime/base/result.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// Null for a simulated one, which is made together with the rest of the simulated cart. Refused in a
/// sentence.
Result<std::unique_ptr<TurnEncoder>> open_encoder(const EncoderConfig& encoder, const Clock& clock);

}  // namespace orcart
