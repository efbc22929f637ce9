#pragma once

#include <octomap/OcTree.h>

#include "common/mapping/voxel_grid.h"
#include "services/voxelmap/map_update.h"

namespace nbs {

/// OctoMap with our weights: each of them is a whole number of 1/1024 nat and so exact in its single precision.
class TreeOfOurModel : public octomap::OcTree {
 public:
  explicit TreeOfOurModel(double resolution_m) : octomap::OcTree(resolution_m) {
    const LogOddsSteps steps = MakeLogOddsSteps({});
    prob_hit_log = static_cast<float>(steps.hit / kLogOddsPerNat);
    prob_miss_log = static_cast<float>(-steps.miss / kLogOddsPerNat);
    clamping_thres_min = static_cast<float>(steps.lowest / kLogOddsPerNat);
    clamping_thres_max = static_cast<float>(steps.highest / kLogOddsPerNat);
    occ_prob_thres_log = static_cast<float>(kOccupiedLogOdds / kLogOddsPerNat);
  }
};

}  // namespace nbs
