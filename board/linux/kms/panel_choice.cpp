// Sentences and comparisons; no card.
#include "board/linux/kms/panel_choice.hpp"

#include <cmath>
#include <cstdio>
#include <optional>

namespace orcart {
namespace {

std::string joined_names(const std::vector<DisplayConnector>& all) {
  std::string text;
  for (const DisplayConnector& one : all) text += (text.empty() ? "" : ", ") + one.name;
  return text.empty() ? "none" : text;
}

std::string joined_modes(const DisplayConnector& connector) {
  std::string text;
  for (const DisplayMode& mode : connector.modes) text += (text.empty() ? "" : ", ") + text_of(mode);
  return text.empty() ? "none" : text;
}

Result<std::size_t> connector_for(const PanelWish& wish, const std::vector<DisplayConnector>& offered) {
  for (std::size_t i = 0; i < offered.size(); ++i) {
    if (!wish.connector.empty() && offered[i].name != wish.connector) continue;
    if (offered[i].connected && !offered[i].modes.empty()) return i;
    if (!wish.connector.empty())
      return fail("panel connector " + wish.connector + " of " + wish.device +
                  " has no panel; plug one in and switch it on");
  }
  if (!wish.connector.empty())
    return fail("panel connector " + wish.connector + " is not on " + wish.device + "; it has " +
                joined_names(offered));
  return fail("no panel is connected to " + wish.device + "; its connectors are " + joined_names(offered));
}

}  // namespace

std::string text_of(const DisplayMode& mode) {
  char text[64];
  std::snprintf(text, sizeof text, "%dx%d at %.1f Hz", mode.width_px, mode.height_px, mode.refresh_hz);
  return text;
}

Result<PanelChoice> choose(const PanelWish& wish, const std::vector<DisplayConnector>& offered) {
  const auto at = connector_for(wish, offered);
  if (!at) return tl::unexpected(at.error());
  const DisplayConnector& connector = offered[*at];
  const bool turned = wish.rotation == Rotation::quarter || wish.rotation == Rotation::three_quarters;
  const int width = turned ? wish.height_px : wish.width_px, height = turned ? wish.width_px : wish.height_px;
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < connector.modes.size(); ++i) {
    const DisplayMode& mode = connector.modes[i];
    const bool any_size = width == 0 || height == 0;
    if (!any_size && (mode.width_px != width || mode.height_px != height)) continue;
    if (wish.refresh_hz > 0 && std::abs(mode.refresh_hz - wish.refresh_hz) > kRefreshTolerance_hz) continue;
    if (!best) {
      best = i;
      continue;
    }
    const DisplayMode& held = connector.modes[*best];
    const bool closer = wish.refresh_hz > 0 ? std::abs(mode.refresh_hz - wish.refresh_hz) <
                                                  std::abs(held.refresh_hz - wish.refresh_hz)
                                            : mode.refresh_hz > held.refresh_hz;
    if (any_size ? mode.preferred && !held.preferred : closer) best = i;
  }
  if (best) return PanelChoice{*at, *best};
  char wanted[64];
  std::snprintf(wanted, sizeof wanted, "%dx%d at %g Hz", width, height, wish.refresh_hz);
  return fail("the panel at " + connector.name + " of " + wish.device + " has no mode of " + wanted +
              "; it has " + joined_modes(connector));
}

}  // namespace orcart
