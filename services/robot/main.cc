#include "common/bus/service_main.h"
#include "services/robot/robot_node.h"

int main(int argc, char** argv) {
  return nbs::RunService("robot", argc, argv,
                         [](const nbs::RunConfig& config) { return std::make_unique<nbs::RobotNode>(config); });
}
