#pragma once

#include <vector>

#include "common/config/run_config.h"
#include "common/mapping/voxel_grid.h"
#include "services/reporter/report_picture.h"
#include "services/reporter/run_record.h"
#include "services/reporter/run_traces.h"

namespace nbs {

/// What the pictures of a report show.
struct RunPictures {
  std::vector<ReportPicture> sides;   ///< The mesh from four sides, its border red.
  std::vector<ReportPicture> paths;   ///< The same sides; where the middle beam of each scan went over the surface.
  std::vector<ReportPicture> voxels;  ///< The voxel space: what is occupied, and a cut with what is unknown.
  std::vector<ReportPicture> scans;   ///< The robot half-way on each scan path, with the mesh as far as it was then.
};

/// Draws the pictures of a run. Without a mesh there are only those of the voxel space; scans without a motion have no
/// picture of the robot.
///
/// @param model_W  The mesh that the run leaves.
RunPictures DrawRun(const RunConfig& config, const RunRecord& record, const TriangleMesh& model_W,
                    const VoxelGrid& voxels, const RunTraces& traces);

}  // namespace nbs
