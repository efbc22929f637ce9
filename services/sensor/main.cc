#include "common/bus/service_main.h"
#include "services/sensor/sensor_node.h"

int main(int argc, char** argv) {
  return nbs::RunService("sensor", argc, argv,
                         [](const nbs::RunConfig& config) { return std::make_unique<nbs::SensorNode>(config); });
}
