#pragma once

#include "common/config/run_config.h"
#include "common/runtime/node.h"
#include "services/coordinator/run_logic.h"

namespace nbs {

/// Runs the state machine of run_logic.h: PLAN, EXECUTION and MESH_SCAN in, PLAN_REQUEST, TRAJECTORY and RUN_STATE out.
class CoordinatorNode : public Node {
 public:
  /// @throws ConfigError if the run's method is unknown.
  explicit CoordinatorNode(const RunConfig& config) : settings_(MakeRunSettings(config)) {}

  void Start(Outbox& out) override;
  /// What the state machine awaits; kNoInput when the run is over.
  size_t NextInput() const override;
  void Handle(const Message& message, Outbox& out) override;

 private:
  void Take(RunStep step, Outbox& out);

  RunSettings settings_;
  RunLogicState state_;
};

}  // namespace nbs
