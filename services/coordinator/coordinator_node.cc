#include "services/coordinator/coordinator_node.h"

#include <iterator>
#include <stdexcept>

namespace nbs {

void CoordinatorNode::Start(Outbox& out) { Take(Begin(settings_), out); }

size_t CoordinatorNode::NextInput() const {
  switch (state_.awaiting) {
    case Awaiting::kPlan:
      return StreamOf<Plan>();
    case Awaiting::kExecution:
      return StreamOf<Execution>();
    case Awaiting::kMeshScan:
      return StreamOf<MeshScan>();
    case Awaiting::kNothing:
      return kNoInput;
  }
  throw std::logic_error("CoordinatorNode: unknown state");
}

void CoordinatorNode::Handle(const Message& message, Outbox& out) {
  if (const auto* plan = std::get_if<Plan>(&message)) return Take(Advance(settings_, state_, *plan), out);
  if (const auto* execution = std::get_if<Execution>(&message))
    return Take(Advance(settings_, state_, *execution), out);
  Take(Advance(settings_, state_, std::get<MeshScan>(message)), out);
}

void CoordinatorNode::Take(RunStep step, Outbox& out) {
  state_ = step.state;
  out.insert(out.end(), std::make_move_iterator(step.commands.begin()), std::make_move_iterator(step.commands.end()));
}

}  // namespace nbs
