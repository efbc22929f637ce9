#pragma once

#include "common/config/run_config.h"
#include "common/geometry/triangle_mesh.h"
#include "common/runtime/node.h"
#include "sim/pose_error.h"
#include "sim/scene.h"
#include "sim/simulated_profiler.h"

namespace nbs {

/// The physical world, simulated: answers robot states with the profiles that the instrument would take there.
///
/// Reads robot states, nothing else, for as long as it runs. A state with `scanning` gives one Profile of the same
/// utime, cast from where an arm that reports X_WF truly is (sim/pose_error.h) and the cell's hand-eye transform;
/// `end_of_scan` gives a Profile with end_of_scan set and no ranges; other states give nothing. The noise is keyed by
/// (seed, scan of the state, number of the profile within the scan). A table, if the cell has one, blocks beams and
/// gives no return: it is taken to be covered in black.
class SimulatorNode : public Node {
 public:
  /// @param object_W  The true object, metres, triangles counter-clockwise seen from outside.
  SimulatorNode(const TriangleMesh& object_W, const RunConfig& config);

  size_t NextInput() const override { return StreamOf<RobotState>(); }
  void Handle(const Message& message, Outbox& out) override;

 private:
  Pose X_FS_;
  PoseError pose_error_;
  TriangleScene scene_W_;
  SimulatedProfiler profiler_;
  int32_t scan_ = -1;
  int32_t profiles_in_scan_ = 0;
};

}  // namespace nbs
