#include "services/planner/surface_search.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "common/runtime/parallel.h"

namespace nbs {
namespace {

/// Seeds whose normals differ by more than this may lie side by side.
constexpr float kSeedCosine = 0.7f;
/// Elements whose normals differ by more than this from the seed's are not of its patch.
constexpr float kPatchCosine = 0.3f;
/// Moves that keep this share of the gain stay candidates.
constexpr double kNearlyAsGood = 0.9;
constexpr double kUnlike_m = 0.08;
constexpr double kUnlike_rad = 0.4;

struct Proposal {
  ScanPath path;
  double gain_nat = 0.0;
};

std::vector<uint32_t> ChooseSeeds(std::span<const SurfaceElement> elements, double spacing_m) {
  std::vector<uint32_t> seeds;
  for (uint32_t i = 0; i < elements.size(); ++i) {
    const auto is_near = [&](uint32_t seed) {
      return (elements[seed].p_W - elements[i].p_W).squaredNorm() < spacing_m * spacing_m &&
             elements[seed].normal_W.dot(elements[i].normal_W) > kSeedCosine;
    };
    if (std::ranges::none_of(seeds, is_near)) seeds.push_back(i);
  }
  return seeds;
}

/// The path straight on over a strip if the robot could drive it, otherwise those from aside that it could.
void AddDrivable(const Strip& strip, double standoff_m, const SurfaceSearchSettings& settings,
                 std::vector<ScanPath>& paths) {
  constexpr double kSlant_rad = 0.45;
  const auto add = [&](const Tilt& tilt) {
    const ScanPath path = MakeStripPath(strip, tilt, standoff_m, settings.limits);
    if (settings.could_drive && !settings.could_drive(path)) return false;
    paths.push_back(path);
    return true;
  };
  if (add({})) return;
  for (const double angle_rad : {kSlant_rad, -kSlant_rad, 2.0 * kSlant_rad, -2.0 * kSlant_rad}) {
    add({angle_rad, 0.0});
    add({0.0, angle_rad});
  }
}

/// The paths over the patch around a seed.
void AddSeedPaths(std::span<const SurfaceElement> elements, const SurfaceElement& seed, const Profiler& profiler,
                  const SurfaceSearchSettings& settings, std::vector<ScanPath>& paths) {
  Eigen::Vector3d mean_W = Eigen::Vector3d::Zero(), normal_W = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  double weight = 0.0;
  for (const SurfaceElement& e : elements) {
    if ((e.p_W - seed.p_W).squaredNorm() > settings.patch_radius_m * settings.patch_radius_m) continue;
    if (e.normal_W.dot(seed.normal_W) < kPatchCosine) continue;
    const Eigen::Vector3d p_W = (e.p_W - seed.p_W).cast<double>();
    mean_W += e.area_m2 * p_W;
    normal_W += e.area_m2 * e.normal_W.cast<double>();
    second += e.area_m2 * p_W * p_W.transpose();
    weight += e.area_m2;
  }
  if (weight <= 0.0 || normal_W.norm() < 1e-3 * weight) return;
  mean_W /= weight;
  normal_W.normalize();
  const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - normal_W * normal_W.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(flat * (second / weight - mean_W * mean_W.transpose()) *
                                                            flat);
  for (int axis : {2, 1}) {
    const Eigen::Vector3d along_W = axes.eigenvectors().col(axis);
    if (std::abs(along_W.dot(normal_W)) > 0.5) continue;  // A patch without extent has the normal for an axis.
    for (double extent_m : {settings.short_m, settings.long_m}) {
      const Strip strip{seed.p_W.cast<double>() + mean_W, normal_W, along_W, extent_m};
      AddDrivable(strip, profiler.standoff_m, settings, paths);
      if (!profiler.HasCamera()) continue;
      AddDrivable({strip.p_W, strip.normal_W, -strip.along_W, extent_m}, profiler.standoff_m, settings, paths);
    }
  }
}

/// The ways in which a path is varied, each by the scale or against it: its middle along x, y, z of S; turned about x,
/// y, z of S around the point it looks at; lengthened. With a camera also: rolled by half a turn.
constexpr int kMoves = 14;

ScanPath Move(const ScanPath& path, int move, double scale, double standoff_m, const PathLimits& limits) {
  constexpr std::array<double, 3> kShift_m = {0.06, 0.06, 0.04};
  constexpr std::array<double, 3> kTurn_rad = {0.3, 0.3, 0.4};
  constexpr double kLengthen_m = 0.12;
  if (move == kMoves) return RollPath(path);
  const int kind = move / 2, axis = kind % 3;
  const double by = move % 2 == 0 ? scale : -scale;
  Eigen::Matrix3d R_WS = path.X_WS_start.linear();
  Eigen::Vector3d half_W = 0.5 * (path.X_WS_end.translation() - path.X_WS_start.translation());
  Eigen::Vector3d target_W = path.X_WS_start.translation() + half_W + standoff_m * R_WS.col(2);
  if (kind < 3) {
    target_W += by * kShift_m.at(axis) * R_WS.col(axis);
  } else if (kind < 6) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(by * kTurn_rad.at(axis), Eigen::Vector3d(R_WS.col(axis))).toRotationMatrix();
    R_WS = turn * R_WS;
    half_W = turn * half_W;
  } else {
    const double length_m = std::clamp(2.0 * half_W.norm() + by * kLengthen_m, limits.min_m, limits.max_m);
    half_W *= 0.5 * length_m / half_W.norm();
  }
  ScanPath moved;
  moved.X_WS_start.linear() = R_WS;
  moved.X_WS_end.linear() = R_WS;
  moved.X_WS_start.translation() = target_W - standoff_m * R_WS.col(2) - half_W;
  moved.X_WS_end.translation() = target_W - standoff_m * R_WS.col(2) + half_W;
  return moved;
}

template <typename Part>
std::vector<Part> Join(const std::vector<std::vector<Part>>& parts) {
  std::vector<Part> all;
  for (const std::vector<Part>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

void SortByGain(std::vector<Proposal>& proposals) {
  std::ranges::stable_sort(proposals, [](const Proposal& a, const Proposal& b) { return a.gain_nat > b.gain_nat; });
}

std::vector<ScanPath> TakeBest(std::vector<Proposal> proposals, size_t count) {
  SortByGain(proposals);
  std::vector<ScanPath> best;
  for (size_t i = 0; i < std::min(count, proposals.size()); ++i) best.push_back(proposals[i].path);
  return best;
}

/// True if two paths have the sensor on the same side of the stripe.
bool IsSameRoll(const ScanPath& a, const ScanPath& b) {
  return a.X_WS_start.linear().col(1).dot(b.X_WS_start.linear().col(1)) > 0.0;
}

/// The first of `sorted` that are not alike, at most `count`; with `by_roll` two that are rolled by half a turn are
/// not.
std::vector<Proposal> TakeUnlike(const std::vector<Proposal>& sorted, size_t count, double alike_m, double alike_rad,
                                 bool by_roll = false) {
  std::vector<Proposal> taken;
  for (const Proposal& proposal : sorted) {
    if (taken.size() >= count) break;
    const auto is_alike = [&](const Proposal& other) {
      return AreAlike(proposal.path, other.path, alike_m, alike_rad) &&
             (!by_roll || IsSameRoll(proposal.path, other.path));
    };
    if (std::ranges::none_of(taken, is_alike)) taken.push_back(proposal);
  }
  return taken;
}

/// What the steps of one search share.
struct Search {
  const SurfacePrediction& prediction;
  const SurfaceView& view;
  const Profiler& profiler;
  double voxel_m;
  const SurfaceSearchSettings& settings;

  std::vector<Proposal> Rate(const std::vector<ScanPath>& paths, uint32_t element_step, int threads) const {
    const std::vector<double> gains_nat = view.CalcGains(prediction, paths, voxel_m, threads, element_step);
    std::vector<Proposal> proposals;
    proposals.reserve(paths.size());
    for (size_t i = 0; i < paths.size(); ++i) proposals.push_back({paths[i], gains_nat[i]});
    return proposals;
  }

  /// Over the patch around each seed.
  std::vector<ScanPath> Propose() const {
    const std::span<const SurfaceElement> elements = prediction.elements();
    const std::vector<uint32_t> seeds = ChooseSeeds(elements, settings.seed_spacing_m);
    std::vector<std::vector<ScanPath>> by_seed(seeds.size());
    ForEachIndex(seeds.size(), settings.threads,
                 [&](size_t i) { AddSeedPaths(elements, elements[seeds[i]], profiler, settings, by_seed[i]); });
    return Join(by_seed);
  }

  /// Moves a path in small steps as long as it gains; all on the way that come near the best of their round.
  std::vector<Proposal> Improve(Proposal best) const {
    const int moves = profiler.HasCamera() ? kMoves + 1 : kMoves;
    std::vector<Proposal> good;
    double scale = 1.0;
    for (int round = 0; round < settings.rounds; ++round) {
      std::vector<ScanPath> moved;
      for (int move = 0; move < moves; ++move) {
        const ScanPath path = Move(best.path, move, scale, profiler.standoff_m, settings.limits);
        if (!settings.could_drive || settings.could_drive(path)) moved.push_back(path);
      }
      const double gain_before = best.gain_nat;
      for (const Proposal& trial : Rate(moved, settings.element_step, 1)) {
        if (trial.gain_nat > kNearlyAsGood * gain_before) good.push_back(trial);
        if (trial.gain_nat > best.gain_nat) best = trial;
      }
      if (best.gain_nat <= gain_before) scale *= 0.5;
    }
    return good;
  }

  /// Each by itself, side by side.
  std::vector<Proposal> ImproveAll(const std::vector<Proposal>& starts) const {
    std::vector<std::vector<Proposal>> by_start(starts.size());
    ForEachIndex(starts.size(), settings.threads, [&](size_t i) { by_start[i] = Improve(starts[i]); });
    return Join(by_start);
  }
};

}  // namespace

std::vector<ScanPath> FindSurfacePaths(const SurfacePrediction& prediction, const SurfaceView& view,
                                       const Profiler& profiler, double voxel_m,
                                       const SurfaceSearchSettings& settings) {
  const Search search{prediction, view, profiler, voxel_m, settings};
  const std::vector<ScanPath> best =
      TakeBest(search.Rate(search.Propose(), settings.seed_step, settings.threads), settings.max_candidates);
  std::vector<Proposal> proposals = search.Rate(best, settings.element_step, settings.threads);
  SortByGain(proposals);
  const std::vector<Proposal> improved =
      search.ImproveAll(TakeUnlike(proposals, settings.improve, kUnlike_m, kUnlike_rad));
  proposals.insert(proposals.end(), improved.begin(), improved.end());
  SortByGain(proposals);
  std::vector<ScanPath> found;
  for (const Proposal& proposal :
       TakeUnlike(proposals, settings.max_candidates, settings.alike_m, settings.alike_rad, profiler.HasCamera())) {
    if (proposal.gain_nat > 0.0) found.push_back(proposal.path);
  }
  return found;
}

}  // namespace nbs
