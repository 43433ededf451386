// One part of a view a step; the rest is carried, and a view waits where no patch is free.
#include "firmware-host/stages/mapper_stage.hpp"

#include "realtime/optics/scope_turn.hpp"

namespace orcart {

MapperStage::MapperStage(Mapper& mapper, std::vector<CutoutPatch>& patches, const Clock& clock,
                         const MapperStageSettings& settings, Lanes& lanes)
    : mapper_(mapper), patches_(patches), clock_(clock), settings_(settings), lanes_(lanes) {
  free_.reserve(patches.size());
  for (std::uint32_t i = 0; i < patches.size(); ++i) free_.push_back(i);
}

StepReport MapperStage::step(Instant) noexcept {
  std::uint32_t home = 0;
  while (free_.size() < patches_.size() && lanes_.patches_home.try_pop(home)) free_.push_back(home);
  if (free_.empty() || (!in_view_ && !begin_next())) return {};

  const std::uint32_t patch = free_.back();
  if (!mapper_.next(patches_[patch])) {
    in_view_ = false;
    return {};
  }
  free_.pop_back();
  in_view_ = !patches_[patch].last_part;
  (void)lanes_.orders.try_push({.kind = PaintOrderKind::paint,
                                .frame = view_.matched.frame,
                                .request = view_.request,
                                .patch = patch,
                                .X_MC = X_MC_,
                                .turn_rad = view_.matched.turn_rad,
                                .pose_kind = view_.matched.pose.kind,
                                .pose_distance = view_.matched.pose.distance,
                                .velocity = velocity_,
                                .matched_at = view_.decided_at,
                                .mapped_at = clock_.now()});
  return {.worked = true,
          .carried = in_view_,
          .items = static_cast<std::uint32_t>(patches_[patch].triangles.size())};
}

bool MapperStage::begin_next() noexcept {
  if (!lanes_.selected.try_pop(view_)) return false;
  const Pose<S, C> X_SC = optics_at(settings_.scope, view_.matched.turn_rad).X_SC;
  X_MC_ = settings_.X_MR * view_.matched.pose.X_RS * X_SC;
  velocity_.reset();
  if (view_.velocity) velocity_ = twist_seen_from(X_SC) * *view_.velocity;
  mapper_.begin(X_MC_, settings_.mode);
  in_view_ = true;
  return true;
}

}  // namespace orcart
