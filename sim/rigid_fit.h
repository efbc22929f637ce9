#pragma once

#include "common/geometry/pose.h"
#include "common/geometry/triangle_mesh.h"
#include "sim/scene.h"

namespace nbs {

/// The rigid motion X_WM that lays a reconstruction best onto the true object: what anybody does who compares a model
/// with a reference, because an arm's absolute error moves all of the model alike and says nothing about its shape.
///
/// Least squares of the distances along the truth's normals (point to plane: Chen & Medioni, "Object modelling by
/// registration of multiple range images", Image and Vision Computing 10(3), 1992, DOI 10.1016/0262-8856(92)90066-C),
/// Tukey's weights, at most 30 steps. What the surface leaves open, as the turns of a sphere, does not move.
///
/// @param mesh_W   Only vertices that a triangle uses count, of many every so many.
/// @param truth_W  Farther than 5 mm from it a vertex does not count.
/// @returns        Identity if no vertex counts.
Pose FitRigid(const TriangleMesh& mesh_W, const TriangleScene& truth_W);

/// The mesh moved by X_WM, its normals turned.
TriangleMesh MoveMesh(TriangleMesh mesh_W, const Pose& X_WM);

}  // namespace nbs
