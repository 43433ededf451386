// One branch a kind.
#include "firmware-host/app/open_pedal.hpp"

#include "board/linux/pedal/gpio_pedal.hpp"
#include "board/linux/pedal/keyboard_pedal.hpp"
#include "board/sim/simulated_gpio.hpp"

namespace orcart {
namespace {

template <class Pedal>
Result<std::unique_ptr<GpioLines>> as_lines(Result<std::unique_ptr<Pedal>> pedal) {
  if (!pedal) return tl::unexpected(pedal.error());
  return std::unique_ptr<GpioLines>(std::move(*pedal));
}

}  // namespace

Result<std::unique_ptr<GpioLines>> open_pedal(const PedalConfig& pedal, Clock& clock, LivePedal* live) {
  switch (pedal.kind) {
    case PedalKind::simulated:
      break;
    case PedalKind::gpio:
      return as_lines(GpioPedal::open(pedal.gpio, clock));
    case PedalKind::keyboard:
      return as_lines(KeyboardPedal::open(pedal.keyboard, clock));
    case PedalKind::none:
      return std::make_unique<SimulatedGpio>(clock, GpioScript{}, live);
  }
  return std::unique_ptr<GpioLines>{};
}

}  // namespace orcart
