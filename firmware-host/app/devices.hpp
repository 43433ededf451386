// The devices of a run: real ones where cart.toml names them, simulated ones elsewhere.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/app/options.hpp"
#include "firmware-host/app/preview.hpp"
#include "firmware-host/app/simulated_devices.hpp"
#include "render/egl/context.hpp"

namespace orcart {

/// Everything outlives the cart that borrows ports().
class Devices {
 public:
  struct Request {
    CartConfig& config;  ///< takes over the refresh that the panel really has
    const Patient& patient;
    Clock& clock;
    PanelKind panel = PanelKind::png;
    Preview* preview = nullptr;
    std::optional<Nanos> run_for;
    std::function<void(double done)> drawing;
  };
  /// Opens tracker, camera, pedal, encoder (where one is asked) and panel in this order; what is refused says
  /// so in one sentence, and what was opened before is given back.
  static Result<std::unique_ptr<Devices>> open(const Request& request);
  ~Devices();

  Ports ports();
  NativeDisplay display() const;  ///< where EGL is to be opened
  Instant start() const;          ///< of the procedure
  Instant end() const;            ///< Instant::max() where only a person ends it
  /// The simulated world, where both tracker and camera measure it; null elsewhere.
  const SimulatedWorld* truth() const;
  std::vector<Picture> panel_pictures() const;
  const std::vector<std::string>& notes() const;  ///< sentences for the log

 private:
  struct State;
  explicit Devices(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace orcart
