// The simulated cart's devices and the world they measure, made from the configuration.
#pragma once

#include <functional>
#include <memory>

#include "board/sim/live_pedal.hpp"
#include "board/sim/movie_file.hpp"
#include "board/sim/ndi/fault_schedule.hpp"
#include "board/sim/simulated_encoder.hpp"
#include "board/sim/simulated_frame_source.hpp"
#include "board/sim/simulated_world.hpp"
#include "firmware-host/app/cart.hpp"
#include "firmware-host/app/panel_pictures.hpp"

namespace orcart {

/// Everything outlives the cart that borrows ports().
class SimulatedDevices {
 public:
  struct Request {
    const CartConfig& config;
    const Patient& patient;
    Clock& clock;
    PanelObserver* preview = nullptr;          ///< sees every picture as well
    LivePedal* pedal = nullptr;                ///< presses besides those of the script
    std::size_t pictures = 6;                  ///< panel pictures to keep, spread over the procedure
    std::function<void(double done)> drawing;  ///< progress of drawing what the camera will see
    ProcedureScript script{};                  ///< its seed, duration, side and entry are the configuration's
    std::vector<CameraFaultPeriod> camera_faults{};
    /// Real devices that stand in the place of simulated ones; nothing is drawn for a real camera.
    ByteLink* tracker = nullptr;
    FrameSource* camera = nullptr;
    GpioLines* real_pedal = nullptr;
    TurnEncoder* real_encoder = nullptr;
    EncoderFaults encoder_faults{};
    std::vector<Nanos> more_presses{};  ///< besides the script's, short ones, since the procedure's start
  };
  /// Plans the procedure, and draws its pictures into a movie file unless they lie there already.
  static Result<std::unique_ptr<SimulatedDevices>> create(const Request& request);
  ~SimulatedDevices();

  Ports ports();
  /// When the procedure starts: a while after creation, so that the tracker is up by then.
  Instant start() const;
  Instant end() const;
  const SimulatedWorld& world() const;
  const PanelPictures& pictures() const;
  /// What the tracker gets wrong; before any thread asks it.
  NdiFaultSchedule& tracker_faults();

 private:
  struct State;
  explicit SimulatedDevices(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace orcart
