#include <memory>

#include "common/bus/service_main.h"
#include "services/voxelmap/voxelmap_node.h"

int main(int argc, char** argv) {
  return nbs::RunService("voxelmap", argc, argv,
                         [](const nbs::RunConfig& config) { return std::make_unique<nbs::VoxelmapNode>(config); });
}
