#include "common/geometry/borders.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace nbs {
namespace {

using Triangle = std::array<uint32_t, 3>;
constexpr uint32_t kNone = 0xffffffffu;

bool IsEmpty(const Triangle& t) { return t[0] == t[1]; }

/// Half-edge in the bucket of its lower vertex.
struct Entry {
  uint32_t higher = 0;
  uint32_t half_edge = 0;  // 3 * triangle + corner that it starts from

  auto operator<=>(const Entry&) const = default;
};

/// All half-edges sorted by lower vertex: bucket v is entries[start[v]] … entries[start[v + 1] - 1].
struct Buckets {
  std::vector<uint32_t> start;
  std::vector<Entry> entries;
};

uint32_t CountVertices(std::span<const Triangle> triangles) {
  uint32_t count = 0;
  for (const Triangle& t : triangles) {
    if (!IsEmpty(t)) count = std::max({count, t[0] + 1, t[1] + 1, t[2] + 1});
  }
  return count;
}

Buckets SortByLowerVertex(std::span<const Triangle> triangles) {
  Buckets buckets;
  buckets.start.assign(CountVertices(triangles) + 1, 0);
  for (const Triangle& t : triangles) {
    if (IsEmpty(t)) continue;
    for (int c = 0; c < 3; ++c) ++buckets.start[std::min(t[c], t[(c + 1) % 3]) + 1];
  }
  for (size_t v = 1; v < buckets.start.size(); ++v) buckets.start[v] += buckets.start[v - 1];
  buckets.entries.resize(buckets.start.back());
  std::vector<uint32_t> fill(buckets.start.begin(), buckets.start.end() - 1);
  for (uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    if (IsEmpty(t)) continue;
    for (uint32_t c = 0; c < 3; ++c) {
      const uint32_t a = t[c];
      const uint32_t b = t[(c + 1) % 3];
      buckets.entries[fill[std::min(a, b)]++] = {std::max(a, b), 3 * i + c};
    }
  }
  return buckets;
}

BorderEdge MakeBorderEdge(std::span<const Triangle> triangles, uint32_t half_edge) {
  const uint32_t i = half_edge / 3;
  const uint32_t c = half_edge % 3;
  return {triangles[i][c], triangles[i][(c + 1) % 3], i};
}

/// Orders the half-edges at multi-fan vertices around the gaps.
class GapMatcher {
 public:
  GapMatcher(std::span<const BorderEdge> edges, std::span<const Triangle> triangles,
             std::span<const Eigen::Vector3f> positions_W)
      : edges_(edges), triangles_(triangles), positions_W_(positions_W) {}

  /// Sets next[e] for every arriving edge e of one vertex that finds a leaving one. Smallest gaps are joined first.
  void Match(uint32_t vertex, std::span<const uint32_t> arriving, std::span<const uint32_t> leaving,
             std::vector<uint32_t>& next) const {
    struct Gap {
      double angle;
      uint32_t in, out;
      auto operator<=>(const Gap&) const = default;
    };
    const Eigen::Matrix<double, 3, 2> plane = CalcTangentPlane(vertex, arriving, leaving);
    std::vector<Gap> gaps;
    for (uint32_t in : arriving) {
      for (uint32_t out : leaving) {
        double angle = CalcAngle(plane, vertex, edges_[out].to) - CalcAngle(plane, vertex, edges_[in].from);
        if (angle <= 0.0) angle += 2.0 * std::numbers::pi;
        gaps.push_back({angle, in, out});
      }
    }
    std::sort(gaps.begin(), gaps.end());
    std::vector<uint32_t> taken;
    for (const Gap& gap : gaps) {
      if (next[gap.in] != kNone || std::find(taken.begin(), taken.end(), gap.out) != taken.end()) continue;
      next[gap.in] = gap.out;
      taken.push_back(gap.out);
    }
  }

 private:
  Eigen::Vector3d Position(uint32_t v) const { return positions_W_[v].cast<double>(); }

  Eigen::Vector3d CalcAreaVector(uint32_t triangle) const {
    const Triangle& t = triangles_[triangle];
    return (Position(t[1]) - Position(t[0])).cross(Position(t[2]) - Position(t[0]));
  }

  Eigen::Matrix<double, 3, 2> CalcTangentPlane(uint32_t vertex, std::span<const uint32_t> arriving,
                                               std::span<const uint32_t> leaving) const {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (auto list : {arriving, leaving}) {
      for (uint32_t e : list) normal += CalcAreaVector(edges_[e].triangle).normalized();
    }
    if (normal.norm() < 1e-9) normal = CalcAreaVector(edges_[arriving.front()].triangle);
    normal.normalize();
    const Eigen::Vector3d reference = Position(edges_[arriving.front()].from) - Position(vertex);
    Eigen::Vector3d u = reference - normal * normal.dot(reference);
    if (u.norm() < 1e-12) u = normal.unitOrthogonal();
    u.normalize();
    Eigen::Matrix<double, 3, 2> plane;
    plane << u, normal.cross(u);
    return plane;
  }

  double CalcAngle(const Eigen::Matrix<double, 3, 2>& plane, uint32_t vertex, uint32_t neighbour) const {
    const Eigen::Vector2d d = plane.transpose() * (Position(neighbour) - Position(vertex));
    return std::atan2(d.y(), d.x());
  }

  std::span<const BorderEdge> edges_;
  std::span<const Triangle> triangles_;
  std::span<const Eigen::Vector3f> positions_W_;
};

/// The edge that follows each edge on its line, or kNone.
std::vector<uint32_t> FindNextEdges(std::span<const BorderEdge> edges, const GapMatcher& matcher) {
  std::vector<uint32_t> next(edges.size(), kNone);
  std::vector<uint32_t> by_to(edges.size());
  for (uint32_t e = 0; e < edges.size(); ++e) by_to[e] = e;
  std::stable_sort(by_to.begin(), by_to.end(), [&](uint32_t a, uint32_t b) { return edges[a].to < edges[b].to; });
  std::vector<uint32_t> leaving;
  size_t out = 0;
  for (size_t first = 0, last; first < by_to.size(); first = last) {
    const uint32_t vertex = edges[by_to[first]].to;
    last = first + 1;
    while (last < by_to.size() && edges[by_to[last]].to == vertex) ++last;
    while (out < edges.size() && edges[out].from < vertex) ++out;
    leaving.clear();
    for (size_t e = out; e < edges.size() && edges[e].from == vertex; ++e) leaving.push_back(static_cast<uint32_t>(e));
    if (leaving.empty()) continue;
    if (last - first == 1 && leaving.size() == 1) {
      next[by_to[first]] = leaving.front();
    } else {
      matcher.Match(vertex, std::span(by_to).subspan(first, last - first), leaving, next);
    }
  }
  return next;
}

/// Walks one line from `start`, marking what it passes.
BorderLine Walk(const std::vector<uint32_t>& next, uint32_t start, std::vector<bool>& passed) {
  BorderLine line;
  uint32_t e = start;
  for (; e != kNone && !passed[e]; e = next[e]) {
    passed[e] = true;
    line.edges.push_back(e);
  }
  line.closed = e == start;
  return line;
}

void FinishLine(std::span<const BorderEdge> edges, BorderLine& line) {
  if (line.closed) {
    const auto lowest = std::min_element(line.edges.begin(), line.edges.end());  // edges are ordered by their start
    std::rotate(line.edges.begin(), lowest, line.edges.end());
  }
  for (uint32_t e : line.edges) line.vertices.push_back(edges[e].from);
  if (!line.closed) line.vertices.push_back(edges[line.edges.back()].to);
}

}  // namespace

std::vector<BorderEdge> FindBorderEdges(std::span<const Triangle> triangles) {
  Buckets buckets = SortByLowerVertex(triangles);
  std::vector<BorderEdge> edges;
  for (size_t v = 0; v + 1 < buckets.start.size(); ++v) {
    const std::span<Entry> bucket(buckets.entries.data() + buckets.start[v], buckets.start[v + 1] - buckets.start[v]);
    std::sort(bucket.begin(), bucket.end());
    for (size_t i = 0, j; i < bucket.size(); i = j) {
      for (j = i + 1; j < bucket.size() && bucket[j].higher == bucket[i].higher;) ++j;
      if (j - i == 1) edges.push_back(MakeBorderEdge(triangles, bucket[i].half_edge));
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const BorderEdge& a, const BorderEdge& b) { return a.from != b.from ? a.from < b.from : a.to < b.to; });
  return edges;
}

std::vector<BorderLine> FindBorderLines(std::span<const BorderEdge> edges, std::span<const Triangle> triangles,
                                        std::span<const Eigen::Vector3f> positions_W) {
  const std::vector<uint32_t> next = FindNextEdges(edges, GapMatcher(edges, triangles, positions_W));
  std::vector<bool> has_previous(edges.size(), false);
  for (uint32_t e : next) {
    if (e != kNone) has_previous[e] = true;
  }
  std::vector<bool> passed(edges.size(), false);
  std::vector<BorderLine> lines;
  for (bool closed : {false, true}) {
    for (uint32_t e = 0; e < edges.size(); ++e) {
      if (!passed[e] && (closed || !has_previous[e])) lines.push_back(Walk(next, e, passed));
    }
  }
  for (BorderLine& line : lines) FinishLine(edges, line);
  std::stable_sort(lines.begin(), lines.end(), [](const BorderLine& a, const BorderLine& b) {
    const uint32_t lowest_a = *std::min_element(a.vertices.begin(), a.vertices.end());
    const uint32_t lowest_b = *std::min_element(b.vertices.begin(), b.vertices.end());
    return lowest_a != lowest_b ? lowest_a < lowest_b : a.edges.front() < b.edges.front();
  });
  return lines;
}

BorderMeasure CalcBorderMeasure(const BorderLine& line, std::span<const Eigen::Vector3f> positions_W) {
  BorderMeasure measure;
  const auto position = [&](size_t i) -> Eigen::Vector3d {
    return positions_W[line.vertices[i % line.vertices.size()]].cast<double>();
  };
  for (size_t i = 0; i < line.edges.size(); ++i) {
    const double length = (position(i + 1) - position(i)).norm();
    measure.length_m += length;
    measure.centroid_W += 0.5 * length * (position(i) + position(i + 1));
  }
  if (measure.length_m > 0.0) measure.centroid_W /= measure.length_m;
  if (!line.closed) return measure;
  for (size_t i = 0; i < line.edges.size(); ++i) {
    measure.area_vector_W += 0.5 * (position(i) - measure.centroid_W).cross(position(i + 1) - measure.centroid_W);
  }
  return measure;
}

}  // namespace nbs
