// The named parameters that Vega-like devices answer GET, SET and GETINFO for.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "board/sim/ndi/emulated_model.hpp"
#include "board/sim/ndi/emulated_port.hpp"
#include "board/sim/ndi/wire_text.hpp"

namespace orcart {

class UserParameters {
 public:
  UserParameters(const EmulatedModel& model, double frame_rate_hz) noexcept;

  /// `name=value`, for all names that begin with `name` where it ends in `*`.
  NdiError get(std::string_view name, WireText& reply) const noexcept;
  /// `name=value;type;attribute;minimum;maximum;enumeration;description`, likewise.
  NdiError describe(std::string_view name, WireText& reply) const noexcept;
  /// `assignment` is name=value.
  NdiError set(std::string_view assignment) noexcept;
  /// For values that the device itself changes; a name that does not exist changes nothing.
  void assign(std::string_view name, std::int64_t value) noexcept;
  std::int64_t value(std::string_view name) const noexcept;

 private:
  static constexpr std::size_t kCount = 30;
  std::array<std::int64_t, kCount> values_{};
  std::array<std::string_view, kCount> texts_{};
};

}  // namespace orcart
