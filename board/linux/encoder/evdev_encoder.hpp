// A rotary encoder as the kernel gives it: an input device of the driver rotary-encoder, or a USB knob, held
// for this program alone.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "board/linux/device_calls.hpp"
#include "board/linux/encoder/encoder_axis.hpp"
#include "board/ports/turn_encoder.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

struct EncoderWish {
  std::string device;  ///< best a name that stays: /dev/input/by-path/...; "event3" is /dev/input/event3
  std::string axis = "rel_dial";
};

/// One thread. Grabbed, so that a knob scrolls nothing elsewhere. A relative axis begins each run at 0, an
/// absolute one at what the device says. A new run begins where the kernel dropped events of a relative axis,
/// and when a device that was pulled out is opened again, which take_reading() tries at most every 0.2 s.
class EvdevEncoder final : public TurnEncoder {
 public:
  /// Refused with the device's name and the remedy: absent, no permission, held by another, no such axis.
  static Result<std::unique_ptr<EvdevEncoder>> open(const EncoderWish& wish, const Clock& clock,
                                                    DeviceCalls& calls = system_calls());

  Result<EncoderReading, PortFault> take_reading() noexcept override;

  static constexpr Nanos kRetry = 200ms;

 private:
  EvdevEncoder(std::string node, std::string axis_name, EncoderAxis axis, const Clock& clock,
               DeviceCalls& calls)
      : node_(std::move(node)), axis_name_(std::move(axis_name)), axis_(axis), clock_(clock), calls_(calls) {}
  Result<void> open_device();
  bool ask_where_it_stands() noexcept;
  void begin_run(Instant at) noexcept;
  void keep(Instant at) noexcept;
  Result<void, PortFault> read_more() noexcept;
  void accept(std::uint16_t type, std::uint16_t code, std::int32_t value, Instant at) noexcept;
  void lose_device() noexcept;

  std::string node_, axis_name_;
  EncoderAxis axis_;
  const Clock& clock_;
  DeviceCalls& calls_;
  OpenDevice device_;
  std::int64_t counts_ = 0;
  std::uint32_t run_ = 0;
  bool moved_ = false;                         ///< since the last report
  bool dropped_ = false;                       ///< events are worth nothing until the next report
  std::array<EncoderReading, 32> readings_{};  ///< read and not yet taken; a read brings 32 events at most
  std::size_t first_ = 0, count_ = 0;
  Instant retry_at_{};
};

/// What `orcart probe` shows of an input device that may be an encoder.
struct EncoderFacts {
  std::string path, name;
  std::vector<std::string> axes;
};
/// Those that can be opened and have a known axis; mice, touch pads and tablets are left out.
std::vector<EncoderFacts> encoders();

}  // namespace orcart
