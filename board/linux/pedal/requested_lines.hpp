// A pedal's line and a trigger's line as requested from the kernel; libgpiod 1.6 and 2.x each have a file
// that does it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "board/linux/pedal/edge_ledger.hpp"
#include "board/ports/port_fault.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

enum class LineBias : std::uint8_t { as_is, pull_up, pull_down, disabled };
enum class ActiveLevel : std::uint8_t { high, low };
enum class TriggerLevel : std::uint8_t { idle, raised };

/// Chips by path (/dev/gpiochip0), name (gpiochip0) or label; lines by name or number.
struct GpioWish {
  std::string chip, line;
  LineBias bias = LineBias::as_is;
  ActiveLevel pressed = ActiveLevel::high;  ///< the level of a pedal that is down
  std::string trigger_line;                 ///< on the same chip; empty: there is none
  ActiveLevel raised = ActiveLevel::high;
};

struct GpioTrouble {
  PortFault fault = PortFault::io;
  std::string sentence;  ///< for the person: what was asked, what is wrong, the one thing to do
};

/// Lines held until destroyed. One thread. Reading takes no memory.
class RequestedLines {
 public:
  virtual ~RequestedLines() = default;
  /// The oldest edge; nothing_yet where there is none; disconnected once the chip is gone.
  virtual Result<RawEdge, PortFault> read() noexcept = 0;
  virtual Result<EdgeKind, PortFault> level() noexcept = 0;
  /// unsupported where no trigger line was asked for.
  virtual Result<void, PortFault> set_trigger(TriggerLevel level) noexcept = 0;
  /// Until there is an edge, a fault or the deadline; true where read() has something to tell.
  virtual bool wait(Instant deadline) noexcept = 0;
};

/// Whoever requests lines: libgpiod on a cart, a played one in tests.
class LineKeeper {
 public:
  virtual ~LineKeeper() = default;
  /// Absent, busy, without permission: refused in a sentence.
  virtual Result<std::unique_ptr<RequestedLines>, GpioTrouble> request(const GpioWish& wish) noexcept = 0;
};

/// The kernel's lines through libgpiod.
LineKeeper& kernel_lines() noexcept;

/// What `orcart probe` shows of a chip.
struct GpioLineFacts {
  unsigned number = 0;
  std::string name, consumer;  ///< empty where there is none
};
struct GpioChipFacts {
  std::string path, name, label;
  std::vector<GpioLineFacts> lines;
  std::string trouble;  ///< why it could not be opened; empty where it could
};
std::vector<GpioChipFacts> gpio_chips();

/// The sentence for an error number met while requesting `what` ("line 4 of gpiochip0").
GpioTrouble gpio_trouble(const std::string& what, int error_number);

}  // namespace orcart
