// Cuts the surface for the frames that are to be painted, a bounded part a step. Thread: mapping. Rate:
// topology. Budget: row "mapper".
#pragma once

#include <vector>

#include "firmware-host/stages/lanes.hpp"
#include "realtime/kernel/clock.hpp"
#include "realtime/kernel/stage.hpp"
#include "realtime/mapper/mapper.hpp"

namespace orcart {

struct MapperStageSettings {
  TextureMode mode = TextureMode::perspective;
  Pose<M, R> X_MR;   ///< registration
  ScopeModel scope;  ///< the passport, with hand-eye and [turning]
};

class MapperStage final : public Stage {
 public:
  /// `patches` are lent to the painter by number and come home by their lane; all are free at first.
  MapperStage(Mapper& mapper, std::vector<CutoutPatch>& patches, const Clock& clock,
              const MapperStageSettings& settings, Lanes& lanes);

  std::string_view name() const noexcept override { return "mapper"; }
  StepReport step(Instant now) noexcept override;

 private:
  bool begin_next() noexcept;

  Mapper& mapper_;
  std::vector<CutoutPatch>& patches_;
  const Clock& clock_;
  MapperStageSettings settings_;
  Lanes& lanes_;
  std::vector<std::uint32_t> free_;
  Selection view_;  ///< whose parts are being made
  Pose<M, C> X_MC_;
  std::optional<Twist> velocity_;
  bool in_view_ = false;
};

}  // namespace orcart
