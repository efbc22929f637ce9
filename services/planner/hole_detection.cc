#include "services/planner/hole_detection.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace nbs {
namespace {

/// Mean of the vertex normals along a loop, weighted with the length of its edges; shorter than 1 where they disagree.
Eigen::Vector3d CalcMeanBorderNormal(const BoundarySurface& surface, const BorderLine& line) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double length = 0.0;
  for (uint32_t e : line.edges) {
    const BorderEdge& edge = surface.edges()[e];
    const double edge_length = (surface.Position(edge.to) - surface.Position(edge.from)).norm();
    sum += 0.5 * edge_length * (surface.Normal(edge.from) + surface.Normal(edge.to));
    length += edge_length;
  }
  return length > 0.0 ? Eigen::Vector3d(sum / length) : sum;
}

/// `mean` where it is trustworthy, else the plane fit, else whatever there is.
Eigen::Vector3d ChooseNormal(const Eigen::Vector3d& mean, const Eigen::Vector3d& outward_area, double loop_length,
                             double max_disagreement_rad) {
  const double disc =
      loop_length * loop_length / (4.0 * std::numbers::pi);  // largest area that a loop of this length can hold
  const bool plane_known = outward_area.norm() > 0.1 * disc;
  const bool mean_known = mean.norm() > 0.5;
  if (mean_known &&
      (!plane_known || mean.normalized().dot(outward_area.normalized()) >= std::cos(max_disagreement_rad)))
    return mean.normalized();
  if (plane_known) return outward_area.normalized();
  return mean.norm() > 1e-6 ? mean.normalized() : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
}

bool IsHole(const BorderLine& line, const HoleDetectionSettings& settings) {
  const int edges = static_cast<int>(line.edges.size());
  return line.closed && edges >= settings.min_edges && edges <= settings.max_edges;
}

/// Every position on the loops.
Eigen::Matrix3Xd CollectPoints(const BoundarySurface& surface, const std::vector<Hole>& holes) {
  std::vector<Eigen::Vector3d> points_W;
  for (const Hole& hole : holes) {
    for (uint32_t v : surface.lines()[hole.line].vertices) points_W.push_back(surface.Position(v));
  }
  Eigen::Matrix3Xd matrix(3, points_W.size());
  for (size_t i = 0; i < points_W.size(); ++i) matrix.col(i) = points_W[i];
  return matrix;
}

/// Appends the tilted looks at a strip: about the path, then about the stripe.
void AppendLooks(const Strip& strip, const Profiler& profiler, const HoleDetectionSettings& settings,
                 std::vector<ScanPath>& paths) {
  for (double tilt : settings.tilts_rad) {
    paths.push_back(MakeStripPath(strip, {.about_along_rad = tilt}, profiler.standoff_m, settings.rims.limits));
    if (tilt != 0.0)
      paths.push_back(MakeStripPath(strip, {.about_across_rad = tilt}, profiler.standoff_m, settings.rims.limits));
  }
}

void AppendHolePaths(const BoundarySurface& surface, const std::vector<Hole>& holes, const Profiler& profiler,
                     const HoleDetectionSettings& settings, std::vector<ScanPath>& paths) {
  const Strip strip = MakeHoleStrip(surface, holes, settings.overhang_m);
  AppendLooks(strip, profiler, settings, paths);
  AppendLooks(ExtendToBox(strip, surface.box_W(), settings.overhang_m, settings.rims.limits), profiler, settings,
              paths);
}

/// Paths for the lines that are too long for holes.
void AppendRimPaths(const BoundarySurface& surface, const Profiler& profiler, const HoleDetectionSettings& settings,
                    std::vector<ScanPath>& paths) {
  for (size_t i = 0; i < surface.lines().size(); ++i) {
    const BorderLine& line = surface.lines()[i];
    if (IsHole(line, settings) || CalcBorderMeasure(line, surface.positions_W()).length_m < settings.min_rim_m)
      continue;
    if (line.closed) AppendHolePaths(surface, {MakeHole(surface, i, settings)}, profiler, settings, paths);
    for (const BoundaryChain& chain : CutRim(surface, line, settings.rims.chains)) {
      const std::vector<ScanPath> beside = MakeChainPaths(surface, chain, profiler, settings.rims);
      paths.insert(paths.end(), beside.begin(), beside.end());
    }
  }
}

}  // namespace

Hole MakeHole(const BoundarySurface& surface, size_t line, const HoleDetectionSettings& settings) {
  const BorderLine& loop = surface.lines()[line];
  const BorderMeasure measure = CalcBorderMeasure(loop, surface.positions_W());
  Hole hole;
  hole.line = line;
  hole.edges = loop.edges.size();
  hole.length_m = measure.length_m;
  hole.centre_W = measure.centroid_W;
  hole.normal_W = ChooseNormal(CalcMeanBorderNormal(surface, loop), -measure.area_vector_W, measure.length_m,
                               settings.max_disagreement_rad);
  hole.area_m2 = std::abs(measure.area_vector_W.dot(hole.normal_W));
  return hole;
}

std::vector<Hole> FindHoles(const BoundarySurface& surface, const HoleDetectionSettings& settings) {
  std::vector<Hole> holes;
  for (size_t i = 0; i < surface.lines().size(); ++i) {
    if (IsHole(surface.lines()[i], settings)) holes.push_back(MakeHole(surface, i, settings));
  }
  std::stable_sort(holes.begin(), holes.end(), [](const Hole& a, const Hole& b) { return a.area_m2 > b.area_m2; });
  return holes;
}

Strip MakeHoleStrip(const BoundarySurface& surface, const std::vector<Hole>& holes, double overhang_m) {
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();
  for (const Hole& hole : holes) normal_W += (hole.area_m2 + 1e-9) * hole.normal_W;
  normal_W = normal_W.norm() > 1e-15 ? normal_W.normalized() : holes.front().normal_W;
  const Eigen::Matrix3Xd points_W = CollectPoints(surface, holes);
  const Eigen::Vector3d mean_W = points_W.rowwise().mean();

  Eigen::Matrix<double, 3, 2> plane;
  plane.col(0) = normal_W.unitOrthogonal();
  plane.col(1) = normal_W.cross(plane.col(0));
  const Eigen::Matrix2Xd flat = plane.transpose() * (points_W.colwise() - mean_W);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(flat * flat.transpose());
  const Eigen::Vector3d along_W = plane * solver.eigenvectors().col(1);
  const Eigen::Vector3d across_W = along_W.cross(normal_W);

  const Eigen::VectorXd t = along_W.transpose() * (points_W.colwise() - mean_W);
  const Eigen::VectorXd s = across_W.transpose() * (points_W.colwise() - mean_W);
  Strip strip;
  strip.p_W = mean_W + 0.5 * (t.minCoeff() + t.maxCoeff()) * along_W + 0.5 * (s.minCoeff() + s.maxCoeff()) * across_W;
  strip.normal_W = normal_W;
  strip.along_W = along_W;
  strip.extent_m = t.maxCoeff() - t.minCoeff() + 2.0 * overhang_m;
  return strip;
}

std::vector<std::vector<size_t>> FindSimilarHoles(const std::vector<Hole>& holes,
                                                  const HoleDetectionSettings& settings) {
  std::vector<std::vector<size_t>> groups;
  for (const Hole& seed : holes) {
    std::vector<size_t> group;
    for (size_t i = 0; i < holes.size(); ++i) {
      const bool near = (holes[i].centre_W - seed.centre_W).norm() <= settings.combine_distance_m;
      if (near && holes[i].normal_W.dot(seed.normal_W) >= std::cos(settings.combine_angle_rad)) group.push_back(i);
    }
    if (group.size() > 1 && std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  return groups;
}

std::vector<Candidate> FindHoleCandidates(const BoundarySurface& surface, int born_scan, const Profiler& profiler,
                                          const HoleDetectionSettings& settings) {
  std::vector<Hole> holes = FindHoles(surface, settings);
  if (static_cast<int>(holes.size()) > settings.max_holes)
    holes.resize(static_cast<size_t>(std::max(0, settings.max_holes)));
  std::vector<ScanPath> paths;
  AppendRimPaths(surface, profiler, settings, paths);
  for (const std::vector<size_t>& group : FindSimilarHoles(holes, settings)) {
    std::vector<Hole> members;
    for (size_t i : group) members.push_back(holes[i]);
    AppendHolePaths(surface, members, profiler, settings, paths);
  }
  for (const Hole& hole : holes) AppendHolePaths(surface, {hole}, profiler, settings, paths);

  std::vector<Candidate> candidates;
  for (const ScanPath& path : paths) candidates.push_back({0, CandidateSource::kHole, born_scan, 0, path});
  RemoveAlike(candidates, settings.alike_m, settings.alike_rad);
  for (size_t i = 0; i < candidates.size(); ++i) candidates[i].rank = static_cast<int32_t>(i);
  return candidates;
}

}  // namespace nbs
