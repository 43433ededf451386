// Opens the pedal that cart.toml names: the one place where a kind of pedal becomes GpioLines.
#pragma once

#include <memory>

#include "board/ports/gpio_lines.hpp"
#include "board/sim/live_pedal.hpp"
#include "firmware-host/app/device_config.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

/// Null for the simulated pedal, which presses by the simulated procedure's script. `live`, where given, is
/// what presses in place of no pedal. Refused in a sentence with the remedy. `clock` and `live` outlive it.
Result<std::unique_ptr<GpioLines>> open_pedal(const PedalConfig& pedal, Clock& clock, LivePedal* live);

}  // namespace orcart
