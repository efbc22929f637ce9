#include "tests/bench/pcl_meshers.h"

#include <pcl/features/normal_3d.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/surface/gp3.h>
#include <pcl/surface/poisson.h>

#include <array>
#include <cmath>
#include <ctime>
#include <map>
#include <numbers>

namespace nbs::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using NormalCloud = pcl::PointCloud<pcl::PointNormal>;

double CpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Cloud::Ptr MakeCloud(const std::vector<Eigen::Vector3f>& points_W) {
  const Cloud::Ptr cloud(new Cloud);
  for (const Eigen::Vector3f& p : points_W) cloud->push_back({p.x(), p.y(), p.z()});
  return cloud;
}

NormalCloud::Ptr EstimateNormals(const Cloud::Ptr& cloud, const std::vector<Eigen::Vector3f>& views_W,
                                 const PeerSettings& settings) {
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(pcl::search::KdTree<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>));
  if (settings.normal_radius_m > 0.0) {
    estimation.setRadiusSearch(settings.normal_radius_m);
  } else {
    estimation.setKSearch(settings.normal_neighbours);
  }
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  const NormalCloud::Ptr oriented(new NormalCloud);
  for (size_t i = 0; i < cloud->size(); ++i) {
    Eigen::Vector3f n = normals[i].getNormalVector3fMap();
    if (!n.allFinite()) continue;
    if (n.dot(views_W[i]) < 0.0f) n = -n;
    pcl::PointNormal p;
    p.getVector3fMap() = (*cloud)[i].getVector3fMap();
    p.getNormalVector3fMap() = n;
    oriented->push_back(p);
  }
  return oriented;
}

template <typename Point>
void CopyPoints(const pcl::PointCloud<Point>& cloud, const std::vector<pcl::Vertices>& polygons, TriangleMesh& mesh_W) {
  for (const Point& p : cloud) mesh_W.vertices_W.push_back(p.getVector3fMap());
  for (const pcl::Vertices& polygon : polygons) {
    std::array<uint32_t, 3> t{};
    for (size_t i = 0; i < 3; ++i) t[i] = static_cast<uint32_t>(polygon.vertices[i]);
    mesh_W.triangles.push_back(t);
  }
}

}  // namespace

PeerMesh MeshByGreedyProjection(const std::vector<Eigen::Vector3f>& points_W,
                                const std::vector<Eigen::Vector3f>& views_W, const PeerSettings& settings) {
  PeerMesh result;
  const double begin = CpuSeconds();
  const NormalCloud::Ptr cloud = EstimateNormals(MakeCloud(points_W), views_W, settings);
  result.normal_seconds = CpuSeconds() - begin;
  pcl::GreedyProjectionTriangulation<pcl::PointNormal> triangulation;
  triangulation.setSearchRadius(settings.max_edge_m);
  triangulation.setMu(settings.distance_multiplier);
  triangulation.setMaximumNearestNeighbors(settings.max_neighbours);
  triangulation.setMaximumSurfaceAngle(std::numbers::pi / 4.0);
  triangulation.setMinimumAngle(std::numbers::pi / 18.0);
  triangulation.setMaximumAngle(2.0 * std::numbers::pi / 3.0);
  triangulation.setNormalConsistency(true);
  triangulation.setConsistentVertexOrdering(true);
  triangulation.setInputCloud(cloud);
  triangulation.setSearchMethod(pcl::search::KdTree<pcl::PointNormal>::Ptr(new pcl::search::KdTree<pcl::PointNormal>));
  std::vector<pcl::Vertices> polygons;
  triangulation.reconstruct(polygons);
  result.seconds = CpuSeconds() - begin;
  CopyPoints(*cloud, polygons, result.mesh_W);
  return result;
}

PeerMesh MeshByPoisson(const std::vector<Eigen::Vector3f>& points_W, const std::vector<Eigen::Vector3f>& views_W,
                       const PeerSettings& settings, double cell_m) {
  PeerMesh result;
  const double begin = CpuSeconds();
  const NormalCloud::Ptr cloud = EstimateNormals(MakeCloud(points_W), views_W, settings);
  result.normal_seconds = CpuSeconds() - begin;
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : points_W) box.extend(p);
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setThreads(1);
  const double width = poisson.getScale() * static_cast<double>(box.sizes().maxCoeff());
  poisson.setDepth(std::max(4, static_cast<int>(std::lround(std::log2(width / cell_m)))));
  poisson.setInputCloud(cloud);
  NormalCloud vertices;
  std::vector<pcl::Vertices> polygons;
  poisson.performReconstruction(vertices, polygons);
  result.seconds = CpuSeconds() - begin;
  CopyPoints(vertices, polygons, result.mesh_W);
  return result;
}

void ThinPoints(double cell_m, std::vector<Eigen::Vector3f>& points_W, std::vector<Eigen::Vector3f>& views_W) {
  struct Sum {
    Eigen::Vector3f p_W = Eigen::Vector3f::Zero(), view_W = Eigen::Vector3f::Zero();
    float count = 0.0f;
  };
  std::map<std::array<int, 3>, Sum> cells;
  for (size_t i = 0; i < points_W.size(); ++i) {
    const Eigen::Vector3i cell = (points_W[i] / static_cast<float>(cell_m)).array().floor().cast<int>();
    Sum& sum = cells[{cell.x(), cell.y(), cell.z()}];
    sum.p_W += points_W[i];
    sum.view_W += views_W[i];
    sum.count += 1.0f;
  }
  points_W.clear();
  views_W.clear();
  for (const auto& [key, sum] : cells) {
    points_W.push_back(sum.p_W / sum.count);
    views_W.push_back(sum.view_W.normalized());
  }
}

}  // namespace nbs::bench
