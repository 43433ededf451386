// A whole simulated cart in the shipped ventricle, small enough to run in seconds.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "board/sim/simulated_gpio.hpp"
#include "firmware-host/app/cart.hpp"
#include "firmware-host/app/simulated_devices.hpp"
#include "tests/path/lent_frames.hpp"

namespace orcart::testing {

/// A scope that looks off its shaft and whose light post is turned.
struct AngledWish {
  double view_deg = 30;
  TurnSource follow = TurnSource::marker;
  double marker_noise_mm = 0;
  EncoderFaults encoder{};
  std::optional<double> told_rad = 0;  ///< told, encoder
  double most_mismatch_deg = 2;
};

/// What a test wants to be different from the demo.
struct RigWish {
  std::optional<AngledWish> angled{};  ///< nothing: the demo's straight scope
  double duration_s = 5;
  double camera_hz = 10;
  double texel_mm = 0.4;
  ProcedureScript script{};
  std::vector<CameraFaultPeriod> camera_faults{};
  std::vector<Nanos> more_presses{};
  std::vector<Stretch>
      holds{};  ///< since the start; where there are any, the pedal does this and nothing else
};

/// Three places: a press that is taken back by the double press at the second, a press at the third, one
/// while the tracker does not see the scope.
RigWish presses();
/// Two places: a press, then a stream that a double press takes back as a whole.
RigWish stream();

/// demo.toml without noise, with a small panel and coarse texels. Movies are kept in the build folder.
class CartRig {
 public:
  /// Fails the test and returns nothing where the cart cannot be made.
  static std::unique_ptr<CartRig> create(const RigWish& wish);

  /// Makes the cart: after faults were told to the devices.
  [[nodiscard]] bool arm(SessionStage* session = nullptr, StageWrapper* wrapper = nullptr,
                         std::size_t traced = 0);
  /// Runs until `since_start` of the procedure.
  void run_until(Nanos since_start);
  /// Runs until the panel has shown the last.
  void run_to_end() { run_until(devices->end() - devices->start() + 500ms); }
  /// Steps of 5 ms from where it stands until `holds` or the end; how long that took since `from`,
  /// Nanos::max() where it never did.
  Nanos until(Instant from, const std::function<bool(const Status&)>& holds);

  Instant at(Nanos since_start) const { return devices->start() + since_start; }
  /// The atlas as it is.
  std::vector<std::uint8_t> painting() { return cart->painter().read_back().rgba; }

  CartConfig config;
  Patient patient;
  SimulatedClock clock;
  std::unique_ptr<SimulatedDevices> devices;
  std::unique_ptr<LentFrames> camera;
  std::unique_ptr<SimulatedGpio> held_pedal;  ///< null where the script presses
  std::unique_ptr<Cart> cart;
};

}  // namespace orcart::testing
