#pragma once

#include <Eigen/Core>
#include <vector>

namespace nbs {

/// `count` unit directions spread evenly over the sphere, from +z down to -z, on a Fibonacci spiral (Gonzalez,
/// Mathematical Geosciences 42, 2010).
std::vector<Eigen::Vector3d> MakeSphereDirections(int count);

}  // namespace nbs
