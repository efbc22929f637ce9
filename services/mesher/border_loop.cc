#include "services/mesher/border_loop.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace nbs {
namespace {

/// Where the border goes on from `at`, having come from `from`. Where several gaps meet, the gap on the left of the way
/// in ends at the first border clockwise from the way back.
uint32_t FindNext(const MeshTopology& mesh, const VertexStore& vertices, uint32_t from, uint32_t at,
                  std::vector<uint32_t>& successors) {
  mesh.FindBorderSuccessors(at, successors);
  if (successors.size() == 1) return successors[0];
  const Vertex& v = vertices[at];
  const Eigen::Vector3f x_W = v.normal_W.unitOrthogonal();
  const Eigen::Vector3f y_W = v.normal_W.cross(x_W);
  const auto angle_of = [&](uint32_t id) {
    const Eigen::Vector3f d = vertices[id].p_W - v.p_W;
    return std::atan2(d.dot(y_W), d.dot(x_W));
  };
  const float back = angle_of(from);
  uint32_t best = MeshTopology::kNone;
  float best_turn = std::numeric_limits<float>::max();
  for (uint32_t id : successors) {
    float turn = back - angle_of(id);
    if (turn <= 0.0f) turn += 2.0f * std::numbers::pi_v<float>;
    if (turn > best_turn || (turn == best_turn && id > best)) continue;
    best = id;
    best_turn = turn;
  }
  return best;
}

}  // namespace

BorderWalk FindBorderLoop(const MeshTopology& mesh, const VertexStore& vertices, uint32_t start, uint32_t second,
                          size_t most_edges, const NumberSet& known_open, std::vector<uint32_t>& loop) {
  std::vector<uint32_t> successors;
  mesh.FindBorderSuccessors(start, successors);
  bool simple = successors.size() == 1;
  loop.assign({start});
  uint32_t from = start, at = second;
  while (at != start) {
    if (simple && known_open.Contains(at)) return BorderWalk::kLong;
    if (loop.size() == most_edges) return simple ? BorderWalk::kLong : BorderWalk::kTangled;
    if (at == MeshTopology::kNone || std::find(loop.begin(), loop.end(), at) != loop.end()) return BorderWalk::kTangled;
    loop.push_back(at);
    const uint32_t next = FindNext(mesh, vertices, from, at, successors);
    simple = simple && successors.size() == 1;
    from = at;
    at = next;
  }
  return loop.size() >= 3 ? BorderWalk::kClosed : BorderWalk::kTangled;
}

}  // namespace nbs
