// Signs of life for the service manager, as long as every real-time thread moves: 20 Hz, a thread without
// rights of its own. A cart whose thread hangs is killed and started again.
#pragma once

#include <string_view>
#include <vector>

#include "firmware-host/app/service_manager.hpp"
#include "realtime/kernel/clock.hpp"
#include "realtime/kernel/worker_thread.hpp"

namespace orcart {

/// A thread that is watched: each turn of its loop is a sign of life.
struct WatchedThread {
  std::string_view name;
  const ThreadLedger* ledger = nullptr;
};

class HeartbeatStage final : public Stage {
 public:
  /// A thread without a turn for this long hangs; looked at each kLook, so noticed by 200 ms.
  static constexpr Nanos kHung = 150ms;
  static constexpr Nanos kLook = 50ms;

  /// Lent, and outlive this.
  HeartbeatStage(const ServiceManager& manager, std::vector<WatchedThread> threads);

  std::string_view name() const noexcept override { return "heartbeat"; }
  /// One look. Worked: a sign of life was sent, a quarter of the manager's patience after the last.
  StepReport step(Instant now) noexcept override;
  /// The thread that hangs; empty while all move.
  std::string_view hung() const noexcept { return hung_; }

 private:
  struct Seen {
    std::uint64_t turns = 0;
    Instant at{};
  };
  void look(Instant now) noexcept;
  void say_what_changed(std::string_view before) const noexcept;

  const ServiceManager& manager_;
  std::vector<WatchedThread> threads_;
  std::vector<Seen> seen_;
  std::string_view hung_;
  Instant next_sign_{};
};

/// READY at construction, STOPPING at the end; without a manager no thread is started.
class Heartbeat {
 public:
  Heartbeat(ServiceManager manager, std::vector<WatchedThread> threads, Clock& clock);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

 private:
  ServiceManager manager_;
  HeartbeatStage stage_;
  WorkerThread thread_;
};

}  // namespace orcart
