// The session file of a run: made before anything is drawn or armed, finished with the run's budgets.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include "firmware-host/app/cart_config.hpp"
#include "firmware-host/app/patient.hpp"
#include "firmware-host/app/topology.hpp"
#include "firmware-host/session/session_stage.hpp"

namespace orcart {

/// `named` itself, or, where that is a folder, a free name in it after `utc` (2026-01-31T10:20:30Z becomes
/// 2026-01-31T102030Z.orcart; more of one second are told apart by -2 to -1000): the same words start a cart
/// again.
std::filesystem::path session_file(const std::filesystem::path& named, std::string utc);

/// Outlives the cart that borrows stage(). The thread that makes it finishes it. One that was never finished
/// and kept nothing takes its file away again.
class KeptSession {
 public:
  struct Request {
    const std::filesystem::path& file;  ///< or a folder, see session_file()
    const CartConfig& config;
    const Patient& patient;
    Instant started_at{};
  };
  /// Refuses a file that exists. The calibration is in it from the start.
  static Result<std::unique_ptr<KeptSession>> create(const Request& request);
  ~KeptSession();
  KeptSession(const KeptSession&) = delete;
  KeptSession& operator=(const KeptSession&) = delete;

  SessionStage& stage() { return stage_; }
  /// After the cart has stopped: how each stage kept its budget.
  Result<void> finish(const std::array<StageLedger, kStageCount>& ledgers);
  /// How many captures were kept, lost or failed, in one line for a person.
  std::string sentence() const;

 private:
  KeptSession(SessionWriter writer, std::size_t picture_bytes);

  std::filesystem::path file_;
  SessionWriter writer_;
  SessionStage stage_;
  bool finished_ = false;
};

}  // namespace orcart
