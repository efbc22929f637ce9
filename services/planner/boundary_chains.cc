#include "services/planner/boundary_chains.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

namespace nbs {
namespace {

constexpr int kStale = -1;  // key of an edge that no new boundary holds

/// One line unrolled to a plain list of edges.
struct Unrolled {
  std::vector<uint32_t> vertices;  // one more than edges
  std::vector<double> length;
  std::vector<Eigen::Vector3d> along;    // smoothed, unit
  std::vector<Eigen::Vector3d> normal;   // of the triangle, unit
  std::vector<Eigen::Vector3d> outward;  // smoothed, unit
  std::vector<int> key;                  // class, or kStale

  size_t edges() const { return length.size(); }
};

/// Sums `values` over the edges within `reach` of edge i to either side.
Eigen::Vector3d SumNear(const std::vector<Eigen::Vector3d>& values, const std::vector<double>& length, bool closed,
                        size_t i, double reach) {
  const size_t n = values.size();
  Eigen::Vector3d sum = values[i];
  for (int step : {-1, 1}) {
    size_t e = i;
    double way = 0.5 * length[i];
    for (size_t count = 1; count < (n + 1) / 2; ++count) {
      if (!closed && (step < 0 ? e == 0 : e + 1 == n)) break;
      e = (e + n + step) % n;
      if (way > reach) break;
      sum += values[e];
      way += length[e];
    }
  }
  return sum;
}

Unrolled Unroll(const BoundarySurface& surface, const BorderLine& line, double smoothing_m) {
  Unrolled list;
  std::vector<Eigen::Vector3d> step;
  std::vector<Eigen::Vector3d> side;
  for (uint32_t e : line.edges) {
    const BorderEdge& edge = surface.edges()[e];
    list.vertices.push_back(edge.from);
    step.push_back(surface.Position(edge.to) - surface.Position(edge.from));
    list.length.push_back(step.back().norm());
    list.normal.push_back(surface.CalcTriangleNormal(edge));
    side.push_back(step.back().cross(list.normal.back()));
  }
  list.vertices.push_back(surface.edges()[line.edges.back()].to);
  for (size_t i = 0; i < line.edges.size(); ++i) {
    list.along.push_back(SumNear(step, list.length, line.closed, i, smoothing_m).normalized());
    list.outward.push_back(SumNear(side, list.length, line.closed, i, smoothing_m).normalized());
  }
  return list;
}

/// Which edges lie within `gap_m` along the line of a vertex of the newest scan.
std::vector<bool> FindFresh(const BoundarySurface& surface, const Unrolled& list, bool closed, int scan, double gap_m) {
  const size_t n = list.edges();
  std::vector<bool> fresh(n, false);
  for (int direction : {1, -1}) {
    double way = INFINITY;
    for (size_t count = 0; count < (closed ? 2 * n : n); ++count) {
      const size_t i = direction > 0 ? count % n : n - 1 - count % n;
      if (surface.LastScan(list.vertices[direction > 0 ? i : i + 1]) == scan) way = 0.0;
      if (way <= gap_m) fresh[i] = true;
      way += list.length[i];
    }
  }
  return fresh;
}

BoundaryClass Classify(const Eigen::Vector3d& outward_S) {
  if (std::abs(outward_S.x()) >= std::abs(outward_S.y()))
    return outward_S.x() < 0.0 ? BoundaryClass::kLeft : BoundaryClass::kRight;
  return outward_S.y() > 0.0 ? BoundaryClass::kTop : BoundaryClass::kBottom;
}

/// Orientation of the sensor when it passed `p_W`.
Eigen::Matrix3d CalcRotationAt(const ScanPath& path, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d way = path.X_WS_end.translation() - path.X_WS_start.translation();
  const double fraction =
      way.squaredNorm() > 0.0 ? way.dot(p_W - path.X_WS_start.translation()) / way.squaredNorm() : 0.0;
  return Interpolate(path.X_WS_start, path.X_WS_end, std::clamp(fraction, 0.0, 1.0)).linear();
}

/// Begins the list at the first change of key, so that no run lies across its ends.
void RotateToChange(Unrolled& list) {
  const size_t n = list.edges();
  size_t first = 0;
  while (first < n && list.key[first] == list.key[(first + n - 1) % n]) ++first;
  if (first == 0 || first == n) return;
  list.vertices.pop_back();
  const auto rotate = [first](auto& values) {
    std::rotate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first), values.end());
  };
  rotate(list.vertices);
  rotate(list.length);
  rotate(list.along);
  rotate(list.normal);
  rotate(list.outward);
  rotate(list.key);
  list.vertices.push_back(list.vertices.front());
}

struct Run {
  size_t first = 0;
  size_t last = 0;  // one past
};

double CalcLength(const Unrolled& list, Run run) {
  double length = 0.0;
  for (size_t i = run.first; i < run.last; ++i) length += list.length[i];
  return length;
}

std::vector<Run> FindRuns(const std::vector<int>& key) {
  std::vector<Run> runs;
  for (size_t i = 0; i < key.size(); ++i) {
    if (i == 0 || key[i] != key[i - 1]) runs.push_back({i, i});
    runs.back().last = i + 1;
  }
  return runs;
}

/// A short run between two runs of one class takes their class.
void RemoveFlicker(Unrolled& list, double min_length_m) {
  const std::vector<Run> runs = FindRuns(list.key);
  for (size_t r = 1; r + 1 < runs.size(); ++r) {
    const int before = list.key[runs[r - 1].first];
    if (before != list.key[runs[r + 1].first] || CalcLength(list, runs[r]) >= min_length_m) continue;
    std::fill(list.key.begin() + static_cast<std::ptrdiff_t>(runs[r].first),
              list.key.begin() + static_cast<std::ptrdiff_t>(runs[r].last), before);
  }
}

/// Cuts a run where it turns away from its mean direction.
std::vector<Run> CutAtTurns(const Unrolled& list, Run run, double max_turn_rad) {
  std::vector<Run> pieces = {{run.first, run.first}};
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (size_t i = run.first; i < run.last; ++i) {
    if (direction.norm() > 0.0 && list.along[i].dot(direction.normalized()) < std::cos(max_turn_rad)) {
      pieces.push_back({i, i});
      direction.setZero();
    }
    direction += list.along[i] * list.length[i];
    pieces.back().last = i + 1;
  }
  return pieces;
}

/// Cuts a run in the fewest pieces of about equal length that do not exceed `max_length_m`.
std::vector<Run> CutToLength(const Unrolled& list, Run run, double max_length_m) {
  const double length = CalcLength(list, run);
  const double share = length / std::max(1.0, std::ceil(length / max_length_m));
  std::vector<Run> pieces = {{run.first, run.first}};
  double way = 0.0;
  for (size_t i = run.first; i < run.last; ++i) {
    if (way + 0.5 * list.length[i] > share * static_cast<double>(pieces.size())) pieces.push_back({i, i});
    way += list.length[i];
    pieces.back().last = i + 1;
  }
  return pieces;
}

BoundaryChain MakeChain(const Unrolled& list, Run run) {
  BoundaryChain chain;
  chain.boundary_class = static_cast<BoundaryClass>(list.key[run.first]);
  for (size_t i = run.first; i < run.last; ++i) {
    chain.vertices.push_back(list.vertices[i]);
    chain.length_m += list.length[i];
    chain.outward_W += list.outward[i] * list.length[i];
    chain.normal_W += list.normal[i] * list.length[i];
  }
  chain.vertices.push_back(list.vertices[run.last]);
  chain.outward_W.normalize();
  chain.normal_W.normalize();
  return chain;
}

void AppendChains(const Unrolled& list, const BoundaryChainSettings& settings, std::vector<BoundaryChain>& chains) {
  for (const Run& run : FindRuns(list.key)) {
    if (list.key[run.first] == kStale) continue;
    for (const Run& straight : CutAtTurns(list, run, settings.max_turn_rad)) {
      for (const Run& piece : CutToLength(list, straight, settings.max_length_m)) {
        if (CalcLength(list, piece) >= settings.min_length_m) chains.push_back(MakeChain(list, piece));
      }
    }
  }
}

/// Where a chain lies in the view of the scan: along y for left and right, along x for top and bottom.
double CalcPosition(const BoundarySurface& surface, const ScanPath& path, const BoundaryChain& chain) {
  const Pose X_SW = path.X_WS_start.inverse();
  Eigen::Vector3d mean_S = Eigen::Vector3d::Zero();
  for (uint32_t v : chain.vertices) mean_S += X_SW * surface.Position(v);
  mean_S /= static_cast<double>(chain.vertices.size());
  return chain.boundary_class <= BoundaryClass::kRight ? mean_S.y() : mean_S.x();
}

}  // namespace

std::vector<BoundaryChain> FindBoundaryChains(const BoundarySurface& surface, int scan, const ScanPath& path,
                                              const BoundaryChainSettings& settings) {
  std::vector<BoundaryChain> chains;
  for (const BorderLine& line : surface.lines()) {
    Unrolled list = Unroll(surface, line, settings.smoothing_m);
    const std::vector<bool> fresh = FindFresh(surface, list, line.closed, scan, settings.gap_m);
    for (size_t i = 0; i < list.edges(); ++i) {
      const Eigen::Matrix3d R_WS = CalcRotationAt(path, surface.Position(list.vertices[i]));
      list.key.push_back(fresh[i] ? static_cast<int>(Classify(R_WS.transpose() * list.outward[i])) : kStale);
    }
    if (line.closed) RotateToChange(list);
    RemoveFlicker(list, settings.min_length_m);
    AppendChains(list, settings, chains);
  }
  std::vector<std::tuple<BoundaryClass, double, uint32_t, size_t>> order;
  for (size_t i = 0; i < chains.size(); ++i) {
    const uint32_t lowest = *std::min_element(chains[i].vertices.begin(), chains[i].vertices.end());
    order.emplace_back(chains[i].boundary_class, CalcPosition(surface, path, chains[i]), lowest, i);
  }
  std::sort(order.begin(), order.end());
  std::vector<BoundaryChain> sorted;
  for (const auto& entry : order) sorted.push_back(std::move(chains[std::get<3>(entry)]));
  return sorted;
}

std::vector<BoundaryChain> CutRim(const BoundarySurface& surface, const BorderLine& line,
                                  const BoundaryChainSettings& settings) {
  if (line.edges.empty()) return {};
  Unrolled list = Unroll(surface, line, settings.smoothing_m);
  list.key.assign(list.edges(), static_cast<int>(BoundaryClass::kLeft));
  std::vector<BoundaryChain> chains;
  AppendChains(list, settings, chains);
  return chains;
}

}  // namespace nbs
