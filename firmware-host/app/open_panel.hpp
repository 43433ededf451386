// Opens the panel of `--panel kms`, and says on which display EGL is to be opened for it.
#pragma once

#include <memory>

#include "board/ports/panel.hpp"
#include "firmware-host/app/device_config.hpp"
#include "realtime/kernel/clock.hpp"
#include "render/egl/context.hpp"

namespace orcart {

/// `display` belongs to the panel: GL contexts on it end before the panel does.
struct OpenedPanel {
  std::unique_ptr<Panel> panel;
  NativeDisplay display;
  std::string sentence;  ///< for the log: card, mode, and whether pictures are copied
};

/// Sets the mode. Refused in a sentence with the remedy. `clock` outlives the panel.
Result<OpenedPanel> open_panel(const PanelConfig& config, Clock& clock);

}  // namespace orcart
