// One table.
#include "board/linux/encoder/encoder_axis.hpp"

#include <linux/input-event-codes.h>

#include <string_view>

namespace orcart {
namespace {

struct NamedAxis {
  std::string_view name;
  EncoderAxis axis;
};
constexpr AxisKind kRelative = AxisKind::relative, kAbsolute = AxisKind::absolute;
constexpr NamedAxis kAxes[] = {{"rel_dial", {kRelative, REL_DIAL}},     {"rel_wheel", {kRelative, REL_WHEEL}},
                               {"rel_hwheel", {kRelative, REL_HWHEEL}}, {"rel_misc", {kRelative, REL_MISC}},
                               {"rel_x", {kRelative, REL_X}},           {"rel_y", {kRelative, REL_Y}},
                               {"rel_z", {kRelative, REL_Z}},           {"rel_rx", {kRelative, REL_RX}},
                               {"rel_ry", {kRelative, REL_RY}},         {"rel_rz", {kRelative, REL_RZ}},
                               {"abs_wheel", {kAbsolute, ABS_WHEEL}},   {"abs_misc", {kAbsolute, ABS_MISC}},
                               {"abs_x", {kAbsolute, ABS_X}},           {"abs_y", {kAbsolute, ABS_Y}},
                               {"abs_z", {kAbsolute, ABS_Z}},           {"abs_rx", {kAbsolute, ABS_RX}},
                               {"abs_ry", {kAbsolute, ABS_RY}},         {"abs_rz", {kAbsolute, ABS_RZ}}};

}  // namespace

std::optional<EncoderAxis> encoder_axis_of(const std::string& name) {
  for (const NamedAxis& named : kAxes)
    if (named.name == name) return named.axis;
  return std::nullopt;
}

std::string name_of_axis(const EncoderAxis& axis) {
  for (const NamedAxis& named : kAxes)
    if (named.axis.kind == axis.kind && named.axis.code == axis.code) return std::string(named.name);
  return {};
}

std::string known_axes() {
  std::string names;
  for (const NamedAxis& named : kAxes) names += (names.empty() ? "" : ", ") + std::string(named.name);
  return names;
}

}  // namespace orcart
