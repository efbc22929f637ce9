#pragma once

#include <filesystem>
#include <set>

#include "common/config/run_config.h"
#include "common/geometry/triangle_mesh.h"
#include "services/reporter/run_record.h"
#include "sim/render.h"

namespace nbs {

/// Draws the mesh of a run as it was after some of its scans: FOLDER/after-05-front.png and after-05-back.png for the
/// fifth. All pictures are of one scale, and the borders are red.
class Snapshots {
 public:
  /// @param frame_W  Shown in every picture: a box around the object.
  /// @param after    Numbers of scans, from 1.
  Snapshots(std::filesystem::path folder, const Eigen::AlignedBox3d& frame_W, std::set<int> after);

  /// The mesh after the next scan.
  void Add(const TriangleMesh& mesh_W);

  /// After the last scan: what would have come later shows the last mesh. Without a scan nothing is drawn.
  void Finish();

 private:
  void Draw(const TriangleMesh& mesh_W, int scans) const;

  std::filesystem::path folder_;
  View view_;
  std::set<int> after_;
  int scans_ = 0;
  TriangleMesh last_W_;
};

}  // namespace nbs
