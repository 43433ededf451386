// The preview window where this build has one; without it, a sentence that says how to get it.
#pragma once

#include <memory>

#include "board/ports/panel.hpp"
#include "board/sim/live_pedal.hpp"
#include "board/sim/panel_observer.hpp"
#include "realtime/base/result.hpp"
#include "realtime/kernel/clock.hpp"

namespace orcart {

class Preview {
 public:
  static Result<std::unique_ptr<Preview>> open(const PanelMode& mode, Clock& clock);
  virtual ~Preview() = default;
  virtual PanelObserver& observer() = 0;
  virtual LivePedal& pedal() = 0;
  virtual bool quit_asked() const = 0;
};

}  // namespace orcart
