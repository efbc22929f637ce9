#include "common/bus/service_main.h"
#include "services/simulator/simulator_node.h"
#include "sim/load_object.h"

int main(int argc, char** argv) {
  return nbs::RunService("simulator", argc, argv, [](const nbs::RunConfig& config) {
    return std::make_unique<nbs::SimulatorNode>(nbs::LoadObject(config), config);
  });
}
