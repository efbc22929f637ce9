#include <memory>

#include "common/bus/service_main.h"
#include "services/mesher/mesher_node.h"

int main(int argc, char** argv) {
  return nbs::RunService("mesher", argc, argv,
                         [](const nbs::RunConfig& config) { return std::make_unique<nbs::MesherNode>(config); });
}
