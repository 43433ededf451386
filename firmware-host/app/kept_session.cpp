// Texts of the files as they are, ledgers into rows.
#include "firmware-host/app/kept_session.hpp"

#include "firmware-host/app/content_hash.hpp"
#include "firmware-host/app/turn_deviation.hpp"
#include "firmware-host/files/whole_file.hpp"

namespace orcart {
namespace {

constexpr std::uintmax_t kLargestText = 1U << 20;

Result<std::string> text_of(const std::filesystem::path& file) {
  auto bytes = read_whole_file(file, kLargestText);
  if (!bytes) return tl::unexpected(bytes.error());
  return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

// Too few samples for the percentile: the longest stands for it.
SessionBudget kept_budget(const StageLedger& ledger) {
  const HistogramSnapshot wall = ledger.wall().snapshot();
  return {.stage = std::string(ledger.name()),
          .count = wall.count(),
          .p50 = wall.median().value_or(Nanos{0}),
          .p99 = wall.percentile(0.99).value_or(wall.max()),
          .max = wall.max(),
          .misses = ledger.over_bound()};
}

/// As the cart reckons with it; nothing of a scope that does not turn.
Result<std::optional<double>> turn_deviation_of(const CartConfig& config, const ScopeModel& scope) {
  if (!scope.turning) return std::nullopt;
  const auto tracker = settings_of(config.tracker);
  if (!tracker) return tl::unexpected(tracker.error());
  return turn_deviation_rad(config, *scope.turning, *tracker);
}

std::string captures(std::uint64_t count) {
  return std::to_string(count) + (count == 1 ? " capture" : " captures");
}

}  // namespace

std::filesystem::path session_file(const std::filesystem::path& named, std::string utc) {
  std::error_code error;
  if (!std::filesystem::is_directory(named, error)) return named;
  std::erase(utc, ':');  // no letter of a file name on what a session may be copied to
  std::filesystem::path file = named / (utc + ".orcart");
  for (int i = 2; i <= 1000 && std::filesystem::exists(file, error); ++i)
    file = named / (utc + "-" + std::to_string(i) + ".orcart");
  return file;
}

Result<std::unique_ptr<KeptSession>> KeptSession::create(const Request& request) {
  const CartConfig& config = request.config;
  const auto cart = text_of(config.file);
  if (!cart) return tl::unexpected(cart.error());
  auto scope = text_of(config.scope);
  if (!scope) return tl::unexpected(scope.error());
  auto registration = text_of(config.registration);
  if (!registration) return tl::unexpected(registration.error());
  std::optional<Nanos> deviation;
  if (config.time_deviation_s) deviation = from_seconds(*config.time_deviation_s);
  const auto turn_deviation = turn_deviation_of(config, request.patient.scope);
  if (!turn_deviation) return tl::unexpected(turn_deviation.error());
  const std::string started_utc = utc_now();
  auto writer =
      SessionWriter::create(session_file(request.file, started_utc),
                            {.application_version = ORCART_VERSION,
                             .config_hash = hash_of(*cart),
                             .started_utc = started_utc,
                             .started_at = request.started_at,
                             .tracker_against_video = config.tracker_against_video,
                             .tracker_against_video_deviation = deviation,
                             .turn_rad = config.turn == TurnSource::told ? config.turn_rad.value_or(0) : 0,
                             .turn_deviation_rad = *turn_deviation});
  if (!writer) return tl::unexpected(writer.error());
  const auto picture_bytes =
      packed_bytes(config.camera.format, config.camera.width_px, config.camera.height_px);
  std::unique_ptr<KeptSession> session(new KeptSession(std::move(*writer), picture_bytes));
  if (auto written =
          session->writer_.write_calibration({.scope_toml = std::move(*scope),
                                              .registration_toml = std::move(*registration),
                                              .surface_hash = request.patient.surface.identity.hash});
      !written)
    return tl::unexpected(written.error());
  return session;
}

KeptSession::KeptSession(SessionWriter writer, std::size_t picture_bytes)
    : file_(writer.file()), writer_(std::move(writer)), stage_(writer_, kSessionSlots, picture_bytes) {}

// The names go before the database closes; what it still writes then has no name.
KeptSession::~KeptSession() {
  if (finished_ || stage_.kept() > 0) return;
  std::error_code ignored;
  for (const char* suffix : {"", "-wal", "-shm"}) std::filesystem::remove(file_.string() + suffix, ignored);
}

Result<void> KeptSession::finish(const std::array<StageLedger, kStageCount>& ledgers) {
  finished_ = true;
  std::vector<SessionBudget> budgets;
  budgets.reserve(ledgers.size());
  for (const StageLedger& ledger : ledgers) budgets.push_back(kept_budget(ledger));
  auto written = writer_.write_budgets(budgets);
  writer_.leave_wal();
  return written;
}

std::string KeptSession::sentence() const {
  std::string text = "Session: " + file_.string() + ", " + captures(stage_.kept()) + " kept";
  text += stage_.lost() == 0 ? ", none lost" : ", " + std::to_string(stage_.lost()) + " lost";
  if (stage_.failures() > 0)
    text += ", " + std::to_string(stage_.failures()) + " writes failed: " + stage_.last_error();
  return text + ".\n";
}

}  // namespace orcart
