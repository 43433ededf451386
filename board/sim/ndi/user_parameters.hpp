// The named parameters that Vega-like devices answer GET, SET and GETINFO for.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "board/sim/ndi/emulated_port.hpp"
#include "board/sim/ndi/wire_text.hpp"

namespace orcart {

class UserParameters {
 public:
  UserParameters() noexcept;

  /// `name=value`, for all names that begin with `name` where it ends in `*`.
  NdiError get(std::string_view name, WireText& reply) const noexcept;
  /// `name=value;type;attribute;minimum;maximum;enumeration;description`.
  NdiError describe(std::string_view name, WireText& reply) const noexcept;
  /// `assignment` is name=value.
  NdiError set(std::string_view assignment) noexcept;

 private:
  static constexpr std::size_t kCount = 14;
  std::array<std::int64_t, kCount> values_{};
};

}  // namespace orcart
