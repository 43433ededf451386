// A whole simulated cart on the wall clock, made for measuring: no pictures to draw beforehand, a press every
// half second.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "board/sim/ndi/simulated_byte_link.hpp"
#include "board/sim/simulated_frame_source.hpp"
#include "board/sim/simulated_gpio.hpp"
#include "board/sim/simulated_panel.hpp"
#include "board/sim/simulated_world.hpp"
#include "firmware-host/app/cart.hpp"

namespace orcart {

struct BenchCartWish {
  CartConfig config;
  double duration_s = 5;  ///< measured; the tracker's start and a warm-up come before
  StageWrapper* wrapper = nullptr;
  std::size_t traced = 0;
  std::vector<std::uint32_t> lost_edges{};  ///< sequence numbers of pedal edges that the driver loses
};

/// Owns devices, patient and cart. The thread that creates it starts and stops it.
class BenchCart {
 public:
  static Result<std::unique_ptr<BenchCart>> create(BenchCartWish wish);
  ~BenchCart();
  BenchCart(const BenchCart&) = delete;
  BenchCart& operator=(const BenchCart&) = delete;

  static constexpr Nanos kTrackerStart = 3s;
  static constexpr Nanos kWarmUp = 1500ms;  ///< after the tracker's start: two captures are painted in it
  static constexpr Nanos kPressEvery = 500ms;

  /// Starts the threads, sleeps through tracker start and warm-up, calls `warm`, sleeps through the measured
  /// time (calling `tick` with the share that is over) and stops the threads.
  Result<void> run(const std::function<void()>& warm, const std::function<void(double done)>& tick);

  Cart& cart();
  const CartConfig& config() const;
  /// When the measured time began.
  Instant measured_from() const;

 private:
  struct State;
  explicit BenchCart(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace orcart
