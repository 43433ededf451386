// The scene at each turn of an angled scope's light post: its optics there, and what the passport leaves open
// of them.
#pragma once

#include <map>
#include <memory>

#include "firmware-host/files/scope_file.hpp"
#include "tools/evaluate/error_model.hpp"
#include "tools/evaluate/scene.hpp"

namespace orcart {

/// Stays where it is made: the scene borrows the scope.
struct TurnedScene {
  TurnedScene(const EvaluationScene& straight, const ErrorModel& assumed,
              const RegistrationFile& registration, double turn_rad);
  TurnedScene(const TurnedScene&) = delete;
  TurnedScene& operator=(const TurnedScene&) = delete;

  ScopeModel scope;       ///< the passport at this turn
  EvaluationScene scene;  ///< through it
  ErrorModel model;       ///< with what passport and registration state, in the axes that C has there
};

/// Borrows what the scene it is made of borrows, that scene's scope included. One thread makes, any reads.
class TurnedScenes {
 public:
  TurnedScenes(const EvaluationScene& straight, ErrorModel assumed, RegistrationFile registration)
      : straight_(straight), assumed_(std::move(assumed)), registration_(std::move(registration)) {}

  /// Made once a turn; lives as long as this.
  const TurnedScene& at(double turn_rad);

 private:
  EvaluationScene straight_;
  ErrorModel assumed_;
  RegistrationFile registration_;
  std::map<double, std::unique_ptr<TurnedScene>> made_;
};

}  // namespace orcart
