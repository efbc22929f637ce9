#include "services/mesher/scan_patches.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/planning/scan_path.h"
#include "services/mesher/stripe_check.h"

namespace nbs {
namespace {

using CellIndex = std::array<int, 3>;

/// Sums over the measurements of a cell.
struct CellSums {
  double count = 0.0;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d to_sensor = Eigen::Vector3d::Zero();
  double along = 0.0;

  Eigen::Vector3d mean_W() const { return p_W / count; }
};

using Cells = std::map<CellIndex, CellSums>;

CellIndex FindCell(const Eigen::Vector3d& p_W, double cell_m) {
  const Eigen::Vector3i cell = (p_W / cell_m).array().floor().matrix().cast<int>();
  return {cell.x(), cell.y(), cell.z()};
}

void AddStripe(const Profiler& profiler, const std::vector<Eigen::Vector3d>& beams_S, const Stripe& stripe,
               double along, double cell_m, Cells& cells) {
  for (size_t beam = 0; beam < beams_S.size(); ++beam) {
    const double range_m = stripe.ranges_m[beam];
    if (!(range_m > 0.0) || !(range_m <= 2.0 * profiler.max_depth_m)) continue;
    const Eigen::Vector3d beam_W = stripe.X_WS.linear() * beams_S[beam];
    const Eigen::Vector3d p_W = stripe.X_WS.translation() + range_m * beam_W;
    CellSums& sums = cells[FindCell(p_W, cell_m)];
    sums.count += 1.0;
    sums.p_W += p_W;
    sums.squares += p_W * p_W.transpose();
    sums.to_sensor -= beam_W;
    sums.along += along;
  }
}

/// The cell together with those around it whose means lie no farther off than one and a half cells.
CellSums AddUpAround(const Cells& cells, const CellIndex& at, const Eigen::Vector3d& mean_W, double cell_m) {
  CellSums all;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const auto found = cells.find({at[0] + dx, at[1] + dy, at[2] + dz});
        if (found == cells.end() || (found->second.mean_W() - mean_W).norm() > 1.5 * cell_m) continue;
        all.count += found->second.count;
        all.p_W += found->second.p_W;
        all.squares += found->second.squares;
      }
    }
  }
  return all;
}

/// The normal of the surface around a cell by principal components, without a side; nothing if there is no telling.
std::optional<Eigen::Vector3d> FindNormal(const CellSums& around, const ScanPatchSettings& settings) {
  if (around.count < settings.min_measurements) return std::nullopt;
  const Eigen::Vector3d mean_W = around.mean_W();
  const Eigen::Matrix3d covariance = around.squares / around.count - mean_W * mean_W.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  const double thickness = axes.eigenvalues()[0], across = axes.eigenvalues()[1];
  if (across < settings.min_spread_m * settings.min_spread_m) return std::nullopt;
  if (thickness > settings.max_thickness * across) return std::nullopt;
  return axes.eigenvectors().col(0);
}

void CollectPatches(const Cells& cells, int32_t scan, const ScanPatchSettings& settings,
                    std::vector<ScanPatch>& patches) {
  for (const auto& [at, sums] : cells) {
    std::optional<Eigen::Vector3d> normal_W =
        FindNormal(AddUpAround(cells, at, sums.mean_W(), settings.cell_m), settings);
    if (!normal_W) continue;
    const Eigen::Vector3d to_sensor = sums.to_sensor.normalized();
    if (normal_W->dot(to_sensor) < 0.0) *normal_W = -*normal_W;
    if (normal_W->dot(to_sensor) < settings.least_view_cosine) continue;
    patches.push_back({sums.mean_W(), *normal_W, scan, sums.along / sums.count});
  }
}

}  // namespace

double CalcAlong(const Stripe& stripe, int32_t last_index) {
  return last_index > 0 ? 2.0 * stripe.index / last_index - 1.0 : 0.0;
}

std::vector<int32_t> FindLastIndices(std::span<const Stripe> stripes) {
  std::vector<int32_t> last;
  for (const Stripe& stripe : stripes) {
    if (stripe.scan < 0 || stripe.scan >= kMaxScans)
      throw std::invalid_argument("FindLastIndices: scan " + std::to_string(stripe.scan));
    const auto scan = static_cast<size_t>(stripe.scan);
    if (scan >= last.size()) last.resize(scan + 1, -1);
    if (!stripe.end_of_scan) last[scan] = std::max(last[scan], stripe.index);
  }
  return last;
}

std::vector<ScanPatch> MakeScanPatches(const Profiler& profiler, std::span<const Stripe> stripes,
                                       const ScanPatchSettings& settings) {
  const std::vector<int32_t> last = FindLastIndices(stripes);
  const std::vector<Eigen::Vector3d> beams_S = CalcBeamDirections_S(profiler);
  std::vector<Cells> scans(last.size());
  for (const Stripe& stripe : stripes) {
    if (stripe.end_of_scan || !IsMeasurable(profiler, stripe)) continue;
    const auto scan = static_cast<size_t>(stripe.scan);
    AddStripe(profiler, beams_S, stripe, CalcAlong(stripe, last[scan]), settings.cell_m, scans[scan]);
  }
  std::vector<ScanPatch> patches;
  for (size_t scan = 0; scan < scans.size(); ++scan)
    CollectPatches(scans[scan], static_cast<int32_t>(scan), settings, patches);
  return patches;
}

}  // namespace nbs
