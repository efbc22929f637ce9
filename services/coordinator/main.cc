#include "common/bus/service_main.h"
#include "services/coordinator/coordinator_node.h"

int main(int argc, char** argv) {
  return nbs::RunService("coordinator", argc, argv,
                         [](const nbs::RunConfig& config) { return std::make_unique<nbs::CoordinatorNode>(config); });
}
