#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "services/mesher/streaming_mesher.h"

namespace nbs {

/// What must hold after every stripe, whatever came before.
struct InvariantSettings {
  /// R_max, and what two vertices may move before the stars around them are made anew.
  float max_edge_m = TriangulationSettings{}.max_bridge_m + 0.0002f;
  /// Of the angle between a triangle and the mean of its corners' normals.
  float least_facing_cosine = -0.5f;
};

/// The first fault of a set of triangles: an edge with more than two triangles or with two that disagree on the side; a
/// vertex that is none or has two fans; an edge that is too long; a triangle that faces away from its corners. Nothing
/// if there is none.
template <typename Triangles>
std::optional<std::string> FindFault(const Triangles& triangles, const VertexStore& vertices,
                                     const InvariantSettings& settings = {}) {
  std::vector<std::array<uint32_t, 2>> directed;
  for (const auto& t : triangles) {
    if (t[0] == t[1]) continue;
    Eigen::Vector3f normals_W = Eigen::Vector3f::Zero();
    for (int i = 0; i < 3; ++i) {
      const uint32_t a = t[i], b = t[(i + 1) % 3];
      if (a >= vertices.size() || vertices[a].state != Vertex::State::kReal)
        return "vertex " + std::to_string(a) + " is none";
      directed.push_back({a, b});
      normals_W += vertices[a].normal_W;
      const float length_m = (vertices[a].p_W - vertices[b].p_W).norm();
      if (!(length_m <= settings.max_edge_m)) return "an edge of " + std::to_string(1e3f * length_m) + " mm";
    }
    const Eigen::Vector3f& p_W = vertices[t[0]].p_W;
    const Eigen::Vector3f area_W = (vertices[t[1]].p_W - p_W).cross(vertices[t[2]].p_W - p_W);
    if (!(area_W.dot(normals_W) >= settings.least_facing_cosine * area_W.norm() * normals_W.norm()))
      return "a triangle at vertex " + std::to_string(t[0]) + " faces away";
  }
  std::sort(directed.begin(), directed.end());
  if (std::adjacent_find(directed.begin(), directed.end()) != directed.end()) return "an edge is taken twice";
  std::vector<uint32_t> fan_ends;
  for (const auto& [a, b] : directed) {
    if (!std::binary_search(directed.begin(), directed.end(), std::array<uint32_t, 2>{b, a})) fan_ends.push_back(a);
  }
  std::sort(fan_ends.begin(), fan_ends.end());
  const auto twice = std::adjacent_find(fan_ends.begin(), fan_ends.end());
  if (twice != fan_ends.end()) return "vertex " + std::to_string(*twice) + " has two fans";
  return std::nullopt;
}

}  // namespace nbs
