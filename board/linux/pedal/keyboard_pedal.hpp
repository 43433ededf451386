// A bought pedal that is a USB keyboard: one key of an input device, held for this program alone.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "board/linux/device_calls.hpp"
#include "board/linux/pedal/edge_ledger.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

struct KeyboardWish {
  std::string device;  ///< best a name that stays: /dev/input/by-id/usb-...-event-kbd
  std::string key;     ///< "b", "space", "f13" or a number of linux/input-event-codes.h
};

/// The key's code; nothing where the word names none.
std::optional<std::uint16_t> key_code_of(const std::string& key);
/// Every word that key_code_of() knows, for a sentence.
std::string known_keys();

/// One thread. Grabbed, so that a press types nothing elsewhere; given back with it. A device that is pulled
/// out is opened again in wait(), at most every 0.2 s. There is no trigger line: unsupported.
class KeyboardPedal final : public GpioLines {
 public:
  static Result<std::unique_ptr<KeyboardPedal>> open(const KeyboardWish& wish, Clock& clock,
                                                     DeviceCalls& calls = system_calls());

  void wait(Instant deadline) noexcept override;
  Result<PedalEdge, PortFault> take_edge() noexcept override;
  Result<void, PortFault> pulse_trigger(Instant, Nanos) noexcept override {
    return tl::unexpected(PortFault::unsupported);
  }

  static constexpr Nanos kRetry = 200ms;

 private:
  KeyboardPedal(const KeyboardWish& wish, std::uint16_t key, Clock& clock, DeviceCalls& calls)
      : wish_(wish), key_(key), clock_(clock), calls_(calls) {}
  Result<void> open_device();
  bool is_down() const noexcept;
  Result<void, PortFault> read_more() noexcept;
  void lose_device() noexcept;

  KeyboardWish wish_;
  std::uint16_t key_;
  Clock& clock_;
  DeviceCalls& calls_;
  OpenDevice device_;
  EdgeLedger ledger_;
  std::array<PedalEdge, 64> edges_{};  ///< read and not yet taken; a read brings 16 events at most
  std::size_t first_ = 0, count_ = 0;
  Instant retry_at_{};
};

/// What `orcart probe` shows of an input device that has keys.
struct KeyboardFacts {
  std::string path, name;
  std::string trouble;  ///< why it could not be opened; empty where it could
};
std::vector<KeyboardFacts> keyboards();

}  // namespace orcart
