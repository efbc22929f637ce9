#pragma once

#include <memory>

#include "common/kinematics/arm_body.h"
#include "common/mapping/distance_field.h"
#include "common/mapping/voxel_grid.h"

namespace nbs::bench {

/// FCL's verdict on the same bodies in the same map: the obstacle cells as an octree, what must not be touched written
/// as occupied, because FCL passes over cells that do not exist.
class FclPeer {
 public:
  /// @param margin_m  Around every part: capsules are the thicker, boxes become the boxes and capsules whose union is
  /// the rounded box.
  FclPeer(const VoxelGrid& grid, Obstacles obstacles, double free_max_probability, const ArmBody& body,
          double margin_m);
  ~FclPeer();

  /// True if any part touches an obstacle. From the tool down, until one does.
  bool IsTouched(const Pose& X_WB, const LinkPoses& X_BL) const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace nbs::bench
