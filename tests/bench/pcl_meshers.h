#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/geometry/triangle_mesh.h"

namespace nbs::bench {

/// A mesh of PCL's, and the CPU time of this thread that it took.
struct PeerMesh {
  TriangleMesh mesh_W;
  double normal_seconds = 0.0;
  double seconds = 0.0;    ///< Normals included.
  int64_t heap_bytes = 0;  ///< That the mesher held at the end; 0 if unknown.
};

struct PeerSettings {
  int normal_neighbours = 20;        ///< Of a point's normal; as in PCL's own tutorial.
  double normal_radius_m = 0.0;      ///< If positive, the normals are of all points within it instead.
  double max_edge_m = 0.006;         ///< GreedyProjectionTriangulation's search radius.
  double distance_multiplier = 2.5;  ///< Its mu.
  int max_neighbours = 100;
};

/// Normals by pcl::NormalEstimation, turned towards views_W, then pcl::GreedyProjectionTriangulation (Marton, Rusu,
/// Beetz, ICRA 2009, DOI 10.1109/ROBOT.2009.5152628), both on one thread.
///
/// @param points_W, views_W  Points and the unit directions from them towards the sensor.
PeerMesh MeshByGreedyProjection(const std::vector<Eigen::Vector3f>& points_W,
                                const std::vector<Eigen::Vector3f>& views_W, const PeerSettings& settings);

/// The same normals, then pcl::Poisson (Kazhdan, Bolitho, Hoppe, SGP 2006), which closes whatever is open.
///
/// @param cell_m  Edge of the finest cells, metres.
PeerMesh MeshByPoisson(const std::vector<Eigen::Vector3f>& points_W, const std::vector<Eigen::Vector3f>& views_W,
                       const PeerSettings& settings, double cell_m);

/// The mean point and view of each cell of `cell_m`, as pcl::VoxelGrid would thin them.
void ThinPoints(double cell_m, std::vector<Eigen::Vector3f>& points_W, std::vector<Eigen::Vector3f>& views_W);

}  // namespace nbs::bench
