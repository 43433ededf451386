// What a camera driver's stamp means, and how an exposure follows from it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "board/ports/frame_source.hpp"

namespace orcart {

/// Belongs to the chain of camera unit, mode and grabber, and is measured, not guessed.
enum class StampMeaning : std::uint8_t {
  start_of_exposure,
  end_of_exposure,
  start_of_readout,  ///< the picture's first line left the sensor or reached the grabber
  end_of_readout,    ///< its last line did: V4L2's usual end of frame
  dequeued,          ///< the driver's stamp means nothing: the instant of the dequeue counts
};

struct NamedStampMeaning {
  std::string_view name;
  StampMeaning meaning;
};
/// As cart.toml spells them.
inline constexpr std::array<NamedStampMeaning, 5> kStampMeanings{{
    {"start_of_exposure", StampMeaning::start_of_exposure},
    {"end_of_exposure", StampMeaning::end_of_exposure},
    {"start_of_readout", StampMeaning::start_of_readout},
    {"end_of_readout", StampMeaning::end_of_readout},
    {"dequeued", StampMeaning::dequeued},
}};

constexpr std::optional<StampMeaning> stamp_meaning_of(std::string_view name) {
  for (const NamedStampMeaning& known : kStampMeanings)
    if (known.name == name) return known.meaning;
  return std::nullopt;
}

struct StampSettings {
  StampMeaning meaning = StampMeaning::end_of_exposure;
  Nanos exposure{};        ///< where the driver does not tell
  Nanos after_exposure{};  ///< readout and dequeue meanings: from the exposure's end to the stamp
};

struct Exposure {
  Instant start{}, end{};
};

constexpr Exposure exposure_of(const FrameBuffer& buffer, Instant dequeued_at,
                               const StampSettings& settings) {
  const Nanos length = buffer.exposure > Nanos{0} ? buffer.exposure : settings.exposure;
  switch (settings.meaning) {
    case StampMeaning::start_of_exposure:
      return {.start = buffer.stamp, .end = buffer.stamp + length};
    case StampMeaning::end_of_exposure:
      return {.start = buffer.stamp - length, .end = buffer.stamp};
    case StampMeaning::start_of_readout:
    case StampMeaning::end_of_readout:
    case StampMeaning::dequeued:
      break;
  }
  const Instant stamp = settings.meaning == StampMeaning::dequeued ? dequeued_at : buffer.stamp;
  const Instant end = stamp - settings.after_exposure;
  return {.start = end - length, .end = end};
}

}  // namespace orcart
