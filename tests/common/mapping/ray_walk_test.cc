#include "common/mapping/ray_walk.h"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

namespace nbs {
namespace {

constexpr double kResolution = 0.005;

GridShape MakeShape(int x, int y, int z) {
  return {Eigen::Vector3d(-0.02, 0.01, -0.05), kResolution, Eigen::Vector3i(x, y, z)};
}

std::vector<int64_t> List(const GridShape& shape, const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB) {
  std::vector<int64_t> cells;
  WalkRay(MakeRayWalk(shape, p_WA, p_WB), [&](int64_t index) {
    cells.push_back(index);
    return true;
  });
  return cells;
}

Eigen::Vector3i ToCell(const GridShape& shape, int64_t index) {
  return Eigen::Vector3i(index % shape.size.x(), index / shape.size.x() % shape.size.y(),
                         index / shape.size.x() / shape.size.y());
}

/// Length in cells of the part of a segment that lies in a cell grown by `margin` cells; negative if it misses it.
double CalcLengthInside(const GridShape& shape, int64_t index, const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB,
                        double margin) {
  const Eigen::Vector3d low = ToCell(shape, index).cast<double>();
  const Eigen::Vector3d a = (p_WA - shape.origin_W) / shape.resolution_m - low;
  const Eigen::Vector3d d = (p_WB - p_WA) / shape.resolution_m;
  double t_in = 0.0, t_out = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(d[axis]) < 1e-12) {
      if (a[axis] < -margin || a[axis] > 1.0 + margin) return -1.0;
      continue;
    }
    const double t0 = (-margin - a[axis]) / d[axis], t1 = (1.0 + margin - a[axis]) / d[axis];
    t_in = std::max(t_in, std::min(t0, t1));
    t_out = std::min(t_out, std::max(t0, t1));
  }
  return (t_out - t_in) * d.norm();
}

void ExpectCellsOfSegment(const GridShape& shape, const Eigen::Vector3d& p_WA, const Eigen::Vector3d& p_WB) {
  const std::vector<int64_t> cells = List(shape, p_WA, p_WB);
  const std::set<int64_t> listed(cells.begin(), cells.end());
  ASSERT_EQ(listed.size(), cells.size()) << "a cell comes twice";
  for (size_t i = 1; i < cells.size(); ++i) {
    ASSERT_EQ((ToCell(shape, cells[i]) - ToCell(shape, cells[i - 1])).cwiseAbs().sum(), 1) << "no common face";
  }
  for (int64_t index = 0; index < shape.cells(); ++index) {
    if (listed.contains(index)) {
      ASSERT_GE(CalcLengthInside(shape, index, p_WA, p_WB, 1e-6), 0.0) << "cell " << index << " is not passed";
    } else {
      ASSERT_LE(CalcLengthInside(shape, index, p_WA, p_WB, 0.0), 1e-6) << "cell " << index << " is missing";
    }
  }
}

class RandomPoint {
 public:
  explicit RandomPoint(uint64_t seed) : engine_(seed) {}
  Eigen::Vector3d In(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const Eigen::Vector3d u(uniform(engine_), uniform(engine_), uniform(engine_));
    return low + (high - low).cwiseProduct(u);
  }

 private:
  std::mt19937_64 engine_;
};

TEST(RayWalk, ListsEveryCellThatASegmentPassesAndNoOther) {
  const GridShape shape = MakeShape(9, 7, 11);
  const Eigen::Vector3d low = shape.origin_W, high = low + shape.size.cast<double>() * kResolution;
  RandomPoint random(1);
  for (int i = 0; i < 2000; ++i) ExpectCellsOfSegment(shape, random.In(low, high), random.In(low, high));
}

TEST(RayWalk, CutsASegmentToTheBox) {
  const GridShape shape = MakeShape(9, 7, 11);
  const Eigen::Vector3d low = shape.origin_W, high = low + shape.size.cast<double>() * kResolution,
                        far = Eigen::Vector3d::Constant(0.05);
  RandomPoint random(2);
  for (int i = 0; i < 4000; ++i)
    ExpectCellsOfSegment(shape, random.In(low - far, high + far), random.In(low - far, high + far));
}

TEST(RayWalk, KeepsToTheCellsOfSegmentsAlongAnAxis) {
  const GridShape shape = MakeShape(9, 7, 11);
  RandomPoint random(3);
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 50; ++i) {
      Eigen::Vector3d a = random.In(shape.origin_W, shape.origin_W + shape.size.cast<double>() * kResolution);
      Eigen::Vector3d b = a;
      b[axis] += (i % 2 == 0 ? 1.0 : -1.0) * 0.1;
      ExpectCellsOfSegment(shape, a, b);
    }
  }
}

TEST(RayWalk, StepsThroughACornerAlongZThenYThenX) {
  const GridShape shape = MakeShape(4, 4, 4);
  const Eigen::Vector3d a = shape.origin_W + Eigen::Vector3d::Constant(0.5 * kResolution);
  const std::vector<int64_t> cells = List(shape, a, a + Eigen::Vector3d::Constant(kResolution));
  EXPECT_EQ(cells, (std::vector<int64_t>{shape.Index(0, 0, 0), shape.Index(0, 0, 1), shape.Index(0, 1, 1),
                                         shape.Index(1, 1, 1)}));
}

TEST(RayWalk, OfAPointIsItsCell) {
  const GridShape shape = MakeShape(4, 4, 4);
  const Eigen::Vector3d a = shape.origin_W + Eigen::Vector3d(0.6, 1.5, 3.9) * kResolution;
  EXPECT_EQ(List(shape, a, a), std::vector<int64_t>{shape.Index(0, 1, 3)});
  EXPECT_EQ(FindCell(shape, a), shape.Index(0, 1, 3));
}

TEST(RayWalk, OutsideTheBoxIsEmpty) {
  const GridShape shape = MakeShape(4, 4, 4);
  const Eigen::Vector3d out(1.0, 1.0, 1.0);
  EXPECT_TRUE(List(shape, out, out + Eigen::Vector3d::UnitX()).empty());
  EXPECT_TRUE(List(shape, out, out).empty());
  EXPECT_EQ(FindCell(shape, out), -1);
}

TEST(RayWalk, OfEndsThatAreNotFiniteOrVeryFarAwayIsEmpty) {
  const GridShape shape = MakeShape(4, 4, 4);
  const Eigen::Vector3d in = shape.origin_W + Eigen::Vector3d::Constant(0.01);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    EXPECT_TRUE(List(shape, in, Eigen::Vector3d(bad, 0.0, 0.0)).empty());
    EXPECT_TRUE(List(shape, Eigen::Vector3d(0.0, bad, 0.0), in).empty());
  }
  EXPECT_EQ(FindCell(shape, Eigen::Vector3d(0.0, 0.0, std::numeric_limits<double>::quiet_NaN())), -1);
}

TEST(RayWalk, EndsInTheLastCellForEveryEndNearAFace) {
  // Ends a rounding away from faces, where a crossing and the end fall on the same tick.
  const GridShape shape = MakeShape(40, 40, 40);
  RandomPoint random(4);
  for (int i = 0; i < 20000; ++i) {
    const auto near_face = [&] {
      const Eigen::Vector3d face = random.In(Eigen::Vector3d::Zero(), shape.size.cast<double>()).array().floor();
      const Eigen::Vector3d off = random.In(Eigen::Vector3d::Constant(-1e-9), Eigen::Vector3d::Constant(1e-9));
      return Eigen::Vector3d(shape.origin_W + (face + off) * kResolution);
    };
    const Eigen::Vector3d a = near_face(), b = near_face();
    if (FindCell(shape, a) < 0 || FindCell(shape, b) < 0) continue;
    const std::vector<int64_t> cells = List(shape, a, b);
    ASSERT_EQ(cells.front(), FindCell(shape, a));
    ASSERT_EQ(cells.back(), FindCell(shape, b));
    const int64_t steps = (ToCell(shape, cells.back()) - ToCell(shape, cells.front())).cwiseAbs().sum();
    ASSERT_EQ(static_cast<int64_t>(cells.size()), steps + 1);
  }
}

std::vector<int64_t> ListByOctomap(const octomap::OcTree& tree, const GridShape& shape, const octomap::point3d& a,
                                   const octomap::point3d& b) {
  octomap::KeyRay ray;
  tree.computeRayKeys(a, b, ray);
  const Eigen::Vector3i first = (shape.origin_W / shape.resolution_m).array().round().cast<int>() + 32768;
  std::vector<int64_t> cells;
  const auto add = [&](const octomap::OcTreeKey& key) {
    cells.push_back(shape.Index(key[0] - first.x(), key[1] - first.y(), key[2] - first.z()));
  };
  for (const octomap::OcTreeKey& key : ray) add(key);
  add(tree.coordToKey(b));
  return cells;
}

TEST(RayWalk, VisitsTheCellsOfOctomapButForNearTies) {
  const GridShape shape = {Eigen::Vector3d::Constant(-0.5), kResolution, Eigen::Vector3i::Constant(200)};
  const octomap::OcTree tree(kResolution);
  RandomPoint random(5);
  int different = 0;
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Vector3f a = random.In(shape.origin_W, -shape.origin_W).cast<float>(),
                          b = random.In(shape.origin_W, -shape.origin_W).cast<float>();
    const std::vector<int64_t> theirs = ListByOctomap(tree, shape, {a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()});
    if (List(shape, a.cast<double>(), b.cast<double>()) != theirs) ++different;
  }
  // OctoMap normalises the direction in single precision.
  EXPECT_LE(different, 30);
}

TEST(RayWalk, BreaksExactTiesLikeOctomap) {
  const GridShape shape = {Eigen::Vector3d::Constant(-0.25), 0.25, Eigen::Vector3i::Constant(20)};
  const octomap::OcTree tree(0.25);
  for (const Eigen::Vector3f& d :
       {Eigen::Vector3f(3, 3, 3), Eigen::Vector3f(3, 3, 0), Eigen::Vector3f(0, 2, 2), Eigen::Vector3f(2, 0, 2)}) {
    const Eigen::Vector3f a = Eigen::Vector3f::Constant(0.125F), b = a + d;
    EXPECT_EQ(List(shape, a.cast<double>(), b.cast<double>()),
              ListByOctomap(tree, shape, {a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}));
  }
}

}  // namespace
}  // namespace nbs
