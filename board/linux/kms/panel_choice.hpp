// Which connector and which mode of a display card the panel gets, decided without a card.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "realtime/base/result.hpp"

namespace orcart {

enum class Rotation : std::uint16_t { none = 0, quarter = 90, half = 180, three_quarters = 270 };

struct PanelWish {
  std::string device;                  ///< /dev/dri/card0; empty: the first card that has a connected panel
  std::string connector;               ///< "HDMI-A-1"; empty: the first connected one
  int width_px = 0, height_px = 0;     ///< as drawn, so after the rotation; 0: the panel's preferred mode
  double refresh_hz = 0;               ///< 0: the fastest of that size
  Rotation rotation = Rotation::none;  ///< by which the panel is turned clockwise
  std::string tty;  ///< "/dev/tty7": kept from the console while the panel is shown; empty: none
};

struct DisplayMode {
  int width_px = 0, height_px = 0;
  double refresh_hz = 0;
  bool preferred = false;
};

struct DisplayConnector {
  std::uint32_t id = 0;
  std::string name;
  bool connected = false;
  std::vector<DisplayMode> modes;
};

/// Indices into what was offered.
struct PanelChoice {
  std::size_t connector = 0, mode = 0;
};

/// Refreshes that differ by at most this are one: 59.94 is taken for 60.
inline constexpr double kRefreshTolerance_hz = 0.6;

/// Refused in one sentence: a connector that is not there or has no panel (with those that have), a mode that
/// the panel lacks (with those it has).
Result<PanelChoice> choose(const PanelWish& wish, const std::vector<DisplayConnector>& offered);

/// "1280x800 at 59.8 Hz".
std::string text_of(const DisplayMode& mode);

}  // namespace orcart
