// The axes by which the kernel tells how far a knob has turned, by name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace orcart {

/// Relative: steps since the last event. Absolute: where it stands, as the device itself knows it.
enum class AxisKind : std::uint8_t { relative, absolute };

struct EncoderAxis {
  AxisKind kind = AxisKind::relative;
  std::uint16_t code = 0;  ///< of linux/input-event-codes.h
};

/// "rel_dial", "abs_wheel": names as in linux/input-event-codes.h, in small letters; nothing where the word
/// names none.
std::optional<EncoderAxis> encoder_axis_of(const std::string& name);
/// Empty where this table has no name for it.
std::string name_of_axis(const EncoderAxis& axis);
/// Every word that encoder_axis_of() knows, for a sentence.
std::string known_axes();

}  // namespace orcart
