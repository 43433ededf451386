// Runs the simulated cart on the wall clock and gathers what it measured.
#pragma once

#include <functional>

#include "tools/latency/bench_cart.hpp"
#include "tools/latency/latency_report.hpp"

namespace orcart {

enum class MachineLoad { idle, every_core_busy };

struct CartRunWish {
  CartConfig config;
  double duration_s = 10;
  MachineLoad load = MachineLoad::idle;
  bool guarded =
      false;  ///< counts what is asked of heap, locks and kernel; costs time, so figures are not pure
};

struct MeasuredRun {
  LatencyRun run;
  std::string render_class, renderer;
};
Result<MeasuredRun> measure_cart(const CartRunWish& wish, const std::function<void(double)>& tick);

}  // namespace orcart
