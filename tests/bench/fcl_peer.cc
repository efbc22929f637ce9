#include "tests/bench/fcl_peer.h"

#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <octomap/OcTree.h>

#include <vector>

namespace nbs::bench {
namespace {

std::shared_ptr<const octomap::OcTree> MakeTree(const VoxelGrid& grid, Obstacles obstacles,
                                                double free_max_probability) {
  const GridShape& shape = grid.shape();
  const int16_t free = CalcLogOdds(free_max_probability);
  const auto tree = std::make_shared<octomap::OcTree>(shape.resolution_m);
  for (int z = 0; z < shape.size.z(); ++z) {
    for (int y = 0; y < shape.size.y(); ++y) {
      for (int x = 0; x < shape.size.x(); ++x) {
        const int16_t l = grid.At(x, y, z);
        if (!IsOccupied(l) && (obstacles == Obstacles::kOccupied || (l <= free && l != kUnobserved))) continue;
        const Eigen::Vector3d p_W = shape.origin_W + shape.resolution_m * (Eigen::Array3d(x, y, z) + 0.5).matrix();
        tree->setNodeValue(p_W.x(), p_W.y(), p_W.z(), 3.5F, true);
      }
    }
  }
  tree->updateInnerOccupancy();
  tree->prune();
  return tree;
}

struct Shape {
  int link = 0;
  std::shared_ptr<fcl::CollisionGeometryd> geometry;
  fcl::Transform3d X_LG;
};

Shape MakeShape(int link, const Capsule& c, double margin_m) {
  const Eigen::Vector3d along = c.p_B - c.p_A;
  Shape shape{link, nullptr, fcl::Transform3d::Identity()};
  shape.X_LG.translation() = 0.5 * (c.p_A + c.p_B);
  if (along.norm() < 1e-9) {
    shape.geometry = std::make_shared<fcl::Sphered>(c.radius_m + margin_m);
    return shape;
  }
  shape.geometry = std::make_shared<fcl::Capsuled>(c.radius_m + margin_m, along.norm());
  shape.X_LG.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along).toRotationMatrix();
  return shape;
}

/// A box with a margin is three boxes, each the larger along one axis, and a capsule along each of its edges.
void AddShapes(int link, const Block& block, double margin_m, std::vector<Shape>& shapes) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d half = block.half + margin_m * Eigen::Vector3d::Unit(axis);
    Shape shape{link, std::make_shared<fcl::Boxd>(2.0 * half), fcl::Transform3d::Identity()};
    shape.X_LG.matrix() = block.X_LC.matrix();
    shapes.push_back(shape);
    for (int edge = 0; edge < 4; ++edge) {
      Eigen::Vector3d p = block.half;
      if ((edge & 1) != 0) p[(axis + 1) % 3] *= -1.0;
      if ((edge & 2) != 0) p[(axis + 2) % 3] *= -1.0;
      Eigen::Vector3d q = p;
      q[axis] *= -1.0;
      shapes.push_back(MakeShape(link, {block.X_LC * p, block.X_LC * q, 0.0}, margin_m));
    }
  }
}

}  // namespace

struct FclPeer::World {
  std::shared_ptr<fcl::OcTreed> tree;
  std::vector<Shape> shapes;
};

FclPeer::FclPeer(const VoxelGrid& grid, Obstacles obstacles, double free_max_probability, const ArmBody& body,
                 double margin_m)
    : world_(std::make_unique<World>()) {
  world_->tree = std::make_shared<fcl::OcTreed>(MakeTree(grid, obstacles, free_max_probability));
  world_->tree->computeLocalAABB();
  for (auto part = body.parts().rbegin(); part != body.parts().rend(); ++part) {
    for (const Capsule& c : part->capsules) world_->shapes.push_back(MakeShape(part->link, c, margin_m));
    for (const Block& block : part->blocks) AddShapes(part->link, block, margin_m, world_->shapes);
  }
  for (const Shape& shape : world_->shapes) shape.geometry->computeLocalAABB();
}

FclPeer::~FclPeer() = default;

bool FclPeer::IsTouched(const Pose& X_WB, const LinkPoses& X_BL) const {
  fcl::CollisionRequestd request;
  for (const Shape& shape : world_->shapes) {
    fcl::Transform3d X_WG;
    X_WG.matrix() = (X_WB * X_BL[static_cast<size_t>(shape.link)]).matrix() * shape.X_LG.matrix();
    fcl::CollisionResultd result;
    if (fcl::collide(shape.geometry.get(), X_WG, world_->tree.get(), fcl::Transform3d::Identity(), request, result) > 0)
      return true;
  }
  return false;
}

}  // namespace nbs::bench
