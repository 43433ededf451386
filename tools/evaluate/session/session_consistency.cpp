// Keeps the pictures of a few captures, compares each new one with them.
#include "tools/evaluate/session/session_consistency.hpp"

#include <chrono>
#include <deque>

#include "firmware-host/files/surface_file.hpp"
#include "tools/evaluate/marker_bodies.hpp"
#include "tools/evaluate/pair_prediction.hpp"
#include "tools/evaluate/stated_errors.hpp"
#include "tools/evaluate/turned_scenes.hpp"

namespace orcart {

namespace {

constexpr std::size_t kSeenTogether = 5;  ///< patches: fewer may be without texture by chance

std::string name_of(const StoredCapture& capture) {
  return "capture " + std::to_string(capture.id);
}

struct Earlier {
  const StoredCapture* capture;
  TakenPicture taken;
  const TurnedScene* scene;
  Capture moving;
};

/// With the deviations that the cart reckoned with, where nobody tells others.
ErrorModel as_recorded(const ErrorModel& told, const RecordedSession& session) {
  ErrorModel model = told;
  if (const auto time_s = session.time_deviation_s(); time_s && model.time_from == ErrorFrom::assumed)
    model = with_time(model, *time_s, ErrorFrom::session);
  if (const auto turn_rad = session.turn_deviation_rad();
      turn_rad && model.light_post_from == ErrorFrom::assumed)
    model = with_turn(model, *turn_rad, ErrorFrom::session);
  return model;
}

/// Counts for each gap the pairs that reach across it.
std::vector<SessionGap> gaps_of(const RecordedSession& session, const std::vector<SessionPair>& pairs) {
  std::vector<SessionGap> gaps;
  const auto& captures = session.captures();
  for (std::size_t i = 1; i < captures.size(); ++i) {
    SessionGap gap{.after = name_of(captures[i - 1]),
                   .before = name_of(captures[i]),
                   .from_s = session.at_s(captures[i - 1]),
                   .to_s = session.at_s(captures[i])};
    for (const SessionPair& pair : pairs) {
      if (pair.first_s > gap.from_s || pair.second_s < gap.to_s) continue;
      ++gap.pairs;
      gap.alarms += pair.pair.alarm() ? 1 : 0;
    }
    gaps.push_back(std::move(gap));
  }
  return gaps;
}

Result<void> compare_all(RecordedSession& session, const SessionCommand& command,
                         const EvaluationScene& scene, const EvaluateProgress& progress,
                         SessionReport& report) {
  TurnedScenes turned(scene, report.model, session.registration());
  const ErrorModel& model = report.model;
  RandomStream random(command.seed, 4'000'000);
  const auto fiducials = fiducials_of_chance(scene, model.fiducials, random);
  std::deque<Earlier> earlier;
  const auto& captures = session.captures();
  const auto velocities = capture_velocities(captures, model, report.velocities);
  for (std::size_t i = 0; i < captures.size(); ++i) {
    progress("comparing captures", static_cast<double>(i) / static_cast<double>(captures.size()));
    auto now = session.taken(captures[i]);
    if (!now) return tl::unexpected(now.error());
    const TurnedScene& at = turned.at(captures[i].facts.turn_rad);
    now->scope = &at.scope;
    const Capture moving{.X_MC = now->X_MC, .velocity = velocities[i]};
    for (const Earlier& before : earlier) {
      SessionPair pair{.pair = {.first = name_of(*before.capture),
                                .second = name_of(captures[i]),
                                .found = compare(scene, before.taken, *now, {}, random)},
                       .first_s = session.at_s(*before.capture),
                       .second_s = session.at_s(captures[i])};
      if (pair.pair.found.patches.empty()) {
        ++(pair.pair.found.looked_at >= kSeenTogether ? report.unmatched : report.without_overlap);
        continue;
      }
      pair.pair.predicted_mm = predicted_apart_mm(fiducials, pair.pair.found,
                                                  {before.scene->scene, before.scene->model, before.moving},
                                                  {at.scene, at.model, moving});
      report.pairs.push_back(std::move(pair));
    }
    earlier.push_back({.capture = &captures[i], .taken = *std::move(now), .scene = &at, .moving = moving});
    if (earlier.size() > static_cast<std::size_t>(command.earlier)) earlier.pop_front();
  }
  report.gaps = gaps_of(session, report.pairs);
  return {};
}

}  // namespace

std::size_t SessionReport::alarms() const {
  std::size_t count = 0;
  for (const SessionPair& pair : pairs) count += pair.pair.alarm() ? 1 : 0;
  return count;
}

std::optional<SessionGap> SessionReport::break_in_time() const {
  std::optional<SessionGap> worst;
  for (const SessionGap& gap : gaps)
    if (gap.alarms >= 2 && gap.alarms == gap.pairs && (!worst || gap.alarms > worst->alarms)) worst = gap;
  return worst;
}

Result<SessionReport> evaluate_session(const SessionCommand& command, const EvaluateProgress& progress) {
  const auto began = std::chrono::steady_clock::now();
  auto session = RecordedSession::open(command.session);
  if (!session) return tl::unexpected(session.error());
  const auto surface = read_surface(command.surface);
  if (!surface) return tl::unexpected(surface.error());
  if (surface->identity.hash != session->surface_hash())
    return fail(command.surface.string() + ": is surface " + surface->identity.hash + ", the session " +
                command.session.string() + " painted " + session->surface_hash() +
                "; bring the surface of that session");
  if (session->captures().size() < 2)
    return fail(command.session.string() + ": holds " + std::to_string(session->captures().size()) +
                " captures that were not undone; two or more are accepted");
  if (session->turned_on_the_way() && !session->scope().turning)
    return fail(command.session.string() +
                ": the scope's light post was turned while it ran, but its passport has no [turning]");
  auto rays = RayScene::create(surface->mesh);
  if (!rays) return tl::unexpected(rays.error());
  auto scope_markers = markers_of_body(command.scope_rom),
       reference_markers = markers_of_body(command.reference_rom);
  if (!scope_markers) return tl::unexpected(scope_markers.error());
  if (!reference_markers) return tl::unexpected(reference_markers.error());
  const EvaluationScene scene{.mesh = surface->mesh,
                              .rays = *rays,
                              .scope = session->scope(),
                              .seen_from = command.seen_from,
                              .X_MR = session->registration().X_MR,
                              .scope_markers_mm = *std::move(scope_markers),
                              .reference_markers_mm = *std::move(reference_markers)};
  if (auto told = check_turn_told(command.model, session->scope()); !told)
    return tl::unexpected(told.error());
  SessionReport report{
      .model = with_stated(as_recorded(command.model, *session), session->scope(), session->registration()),
      .session = command.session.filename().string(),
      .surface = command.surface.filename().string(),
      .captures = session->captures().size(),
      .undone = session->undone()};
  if (auto compared = compare_all(*session, command, scene, progress, report); !compared)
    return tl::unexpected(compared.error());
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (command.page.empty()) return report;
  if (auto page = write_page(command.page, report); !page) return tl::unexpected(page.error());
  return report;
}

}  // namespace orcart
