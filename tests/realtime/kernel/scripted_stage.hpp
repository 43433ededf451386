// A stage for the runners' tests: notes when it was stepped and does what the test tells it.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

#include "realtime/kernel/stage.hpp"

namespace orcart::testing {

class ScriptedStage final : public Stage {
 public:
  /// `act` is called in each step with the step's number, from 0; it may be empty.
  explicit ScriptedStage(std::string_view name, std::function<void(std::size_t)> act = {})
      : name_(name), act_(std::move(act)) {
    instants_.reserve(kKept);
  }

  std::string_view name() const noexcept override { return name_; }

  StepReport step(Instant now) noexcept override {
    if (instants_.size() < kKept) instants_.push_back(now);
    if (act_) act_(steps_);
    ++steps_;
    return {.worked = true, .items = 1};
  }

  /// The first kKept instants. Not while another thread steps.
  const std::vector<Instant>& instants() const { return instants_; }

 private:
  static constexpr std::size_t kKept = 1000;

  std::string_view name_;
  std::function<void(std::size_t)> act_;
  std::vector<Instant> instants_;
  std::size_t steps_ = 0;
};

}  // namespace orcart::testing
