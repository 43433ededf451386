// One passport a turn.
#include "tools/evaluate/turned_scenes.hpp"

#include "realtime/optics/scope_turn.hpp"
#include "tools/evaluate/stated_errors.hpp"

namespace orcart {

TurnedScene::TurnedScene(const EvaluationScene& straight, const ErrorModel& assumed,
                         const RegistrationFile& registration, double turn_rad)
    : scope(turned(straight.scope, turn_rad)),
      scene(through(straight, scope)),
      model(with_stated(assumed, scope, registration)) {}

const TurnedScene& TurnedScenes::at(double turn_rad) {
  auto& made = made_[turn_rad];
  if (!made) made = std::make_unique<TurnedScene>(straight_, assumed_, registration_, turn_rad);
  return *made;
}

}  // namespace orcart
