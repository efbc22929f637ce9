#include "sim/rigid_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "sim/mesh_measures.h"

namespace nbs {
namespace {

using Eigen::Vector3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kFar_m = 0.005;
constexpr size_t kMostVertices = 20000;
constexpr int kMostSteps = 30;
constexpr double kSettled_m = 1e-7;
/// Of the weight of all vertices: holds what the surface leaves open.
constexpr double kHold = 1e-6;

std::vector<Vector3d> TakeVertices(const TriangleMesh& mesh) {
  const std::vector<Vector3d> all = CollectUsedVertices(mesh);
  const size_t step = all.size() / kMostVertices + 1;
  std::vector<Vector3d> taken;
  for (size_t i = 0; i < all.size(); i += step) taken.push_back(all[i]);
  return taken;
}

double CalcTukeyWeight(double distance_m) {
  const double share = distance_m / kFar_m;
  return share < 1.0 ? (1.0 - share * share) * (1.0 - share * share) : 0.0;
}

/// One step: the small motion about `middle_W` (turn vector, then shift; turns in units of 1 / extent) that brings the
/// moved points nearest to the planes of their closest points.
Vector6d FindStep(const std::vector<Vector3d>& points_W, const Pose& X_WM, const Vector3d& middle_W, double extent_m,
                  const TriangleScene& truth_W) {
  Matrix6d normal = Matrix6d::Zero();
  Vector6d right = Vector6d::Zero();
  double weight = 0.0;
  for (const Vector3d& point_W : points_W) {
    const Vector3d p_W = X_WM * point_W;
    const auto closest = truth_W.FindClosest(p_W, kFar_m);
    if (!closest) continue;
    Vector6d along;
    along << (p_W - middle_W).cross(closest->normal_W) / extent_m, closest->normal_W;
    const double w = CalcTukeyWeight(closest->distance_m);
    normal += w * along * along.transpose();
    right += w * closest->normal_W.dot(closest->p_W - p_W) * along;
    weight += w;
  }
  if (weight == 0.0) return Vector6d::Zero();
  normal.diagonal().array() += kHold * weight;
  return normal.ldlt().solve(right);
}

}  // namespace

Pose FitRigid(const TriangleMesh& mesh_W, const TriangleScene& truth_W) {
  Pose X_WM = Pose::Identity();
  const std::vector<Vector3d> points_W = TakeVertices(mesh_W);
  if (points_W.empty() || truth_W.box_W().isEmpty()) return X_WM;
  const Vector3d middle_W = truth_W.box_W().center();
  const double extent_m = std::max(0.5 * truth_W.box_W().diagonal().norm(), kFar_m);
  for (int step = 0; step < kMostSteps; ++step) {
    const Vector6d move = FindStep(points_W, X_WM, middle_W, extent_m, truth_W);
    const Vector3d turn = move.head<3>() / extent_m;
    Pose X_step = Pose::Identity();
    if (turn.norm() > 0.0) X_step.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    X_step.translation() = middle_W + move.tail<3>() - X_step.linear() * middle_W;
    X_WM = X_step * X_WM;
    if (move.norm() < kSettled_m) break;
  }
  return X_WM;
}

TriangleMesh MoveMesh(TriangleMesh mesh_W, const Pose& X_WM) {
  for (Eigen::Vector3f& p_W : mesh_W.vertices_W) p_W = (X_WM * p_W.cast<double>()).cast<float>();
  for (Eigen::Vector3f& n_W : mesh_W.normals_W) n_W = (X_WM.linear() * n_W.cast<double>()).cast<float>();
  return mesh_W;
}

}  // namespace nbs
