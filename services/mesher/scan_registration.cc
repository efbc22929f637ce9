#include "services/mesher/scan_registration.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "services/mesher/brick_grid.h"

namespace nbs {
namespace {

constexpr int kUnknowns = 6;  // Of a scan: middle, slope.
using Row = Eigen::Matrix<double, kUnknowns, 1>;

/// The normal equations of all pairs.
struct Equations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd right;
};

/// Solves one system after the other, each with pairs found where the one before has moved the scans.
class Registration {
 public:
  Registration(std::span<const ScanPatch> patches, int scan_count, const ScanRegistrationSettings& settings)
      : patches_(patches), settings_(settings), corrections_(static_cast<size_t>(scan_count)) {}

  void Improve(double tolerance_m) {
    Equations equations = MakePrior();
    AddPairs(tolerance_m, equations);
    const Eigen::VectorXd solution = equations.matrix.ldlt().solve(equations.right);
    for (size_t scan = 0; scan < corrections_.size(); ++scan) {
      const auto at = static_cast<Eigen::Index>(scan) * kUnknowns;
      corrections_[scan] = {solution.segment<3>(at), solution.segment<3>(at + 3)};
    }
  }

  const std::vector<ScanCorrection>& corrections() const { return corrections_; }

 private:
  Equations MakePrior() const {
    Row weights;
    weights << Eigen::Vector3d::Constant(settings_.middle_prior), Eigen::Vector3d::Constant(settings_.slope_prior);
    const auto scans = static_cast<Eigen::Index>(corrections_.size());
    const Eigen::VectorXd diagonal = weights.replicate(scans, 1);
    return {diagonal.asDiagonal(), Eigen::VectorXd::Zero(scans * kUnknowns)};
  }

  void AddPairs(double tolerance_m, Equations& equations) {
    moved_W_.clear();
    for (const ScanPatch& patch : patches_)
      moved_W_.push_back(patch.p_W + corrections_[static_cast<size_t>(patch.scan)].CalcOffset(patch.along));
    const BrickGrid grid = SortIn();
    for (uint32_t i = 0; i < patches_.size(); ++i) {
      FindPartners(grid, i);
      for (const Partner& partner : partners_) {
        if (partner.found) AddPair(i, partner.patch, tolerance_m, equations);
      }
    }
  }

  /// The patches by where they are now: each cell has a list of them.
  BrickGrid SortIn() {
    BrickGrid grid(static_cast<float>(settings_.reach_m));
    next_in_cell_.clear();
    for (const Eigen::Vector3d& p_W : moved_W_) {
      int32_t& head = grid.Touch(p_W.cast<float>());
      next_in_cell_.push_back(std::exchange(head, static_cast<int32_t>(next_in_cell_.size())));
    }
    return grid;
  }

  /// For each scan its patch that is nearest to patch i, looks the same way and is within reach.
  void FindPartners(const BrickGrid& grid, uint32_t i) {
    const double reach_squared = settings_.reach_m * settings_.reach_m;
    partners_.assign(corrections_.size(), {false, 0, reach_squared});
    grid.ForEachCell(moved_W_[i].cast<float>(), static_cast<float>(settings_.reach_m), [&](int32_t head) {
      for (int32_t j = head; j != BrickGrid::kNone; j = next_in_cell_[j]) Consider(i, static_cast<uint32_t>(j));
    });
  }

  void Consider(uint32_t i, uint32_t j) {
    if (patches_[j].scan == patches_[i].scan) return;
    if (patches_[j].normal_W.dot(patches_[i].normal_W) < settings_.least_cosine) return;
    Partner& partner = partners_[static_cast<size_t>(patches_[j].scan)];
    const double squared = (moved_W_[j] - moved_W_[i]).squaredNorm();
    if (squared < partner.squared_m2) partner = {true, j, squared};
  }

  /// Adds w (n . (p_i + t_i - p_j - t_j))^2 with Tukey's weight at where the two are now.
  void AddPair(uint32_t i, uint32_t j, double tolerance_m, Equations& equations) const {
    const ScanPatch &a = patches_[i], &b = patches_[j];
    const Eigen::Vector3d normal_W = (a.normal_W + b.normal_W).normalized();
    const Eigen::Vector3d apart_W = moved_W_[i] - moved_W_[j];
    const double now_m = normal_W.dot(apart_W);
    if ((apart_W - now_m * normal_W).norm() > settings_.max_aside_m || std::abs(now_m) >= tolerance_m) return;
    const double share = now_m / tolerance_m;
    const double weight = (1.0 - share * share) * (1.0 - share * share);
    const double reported_m = normal_W.dot(a.p_W - b.p_W);
    Row row_a, row_b;
    row_a << normal_W, a.along * normal_W;
    row_b << -normal_W, -b.along * normal_W;
    const Eigen::Index at_a = a.scan * kUnknowns, at_b = b.scan * kUnknowns;
    equations.matrix.block<kUnknowns, kUnknowns>(at_a, at_a) += weight * row_a * row_a.transpose();
    equations.matrix.block<kUnknowns, kUnknowns>(at_a, at_b) += weight * row_a * row_b.transpose();
    equations.matrix.block<kUnknowns, kUnknowns>(at_b, at_a) += weight * row_b * row_a.transpose();
    equations.matrix.block<kUnknowns, kUnknowns>(at_b, at_b) += weight * row_b * row_b.transpose();
    equations.right.segment<kUnknowns>(at_a) -= weight * reported_m * row_a;
    equations.right.segment<kUnknowns>(at_b) -= weight * reported_m * row_b;
  }

  struct Partner {
    bool found = false;
    uint32_t patch = 0;
    double squared_m2 = 0.0;
  };

  std::span<const ScanPatch> patches_;
  const ScanRegistrationSettings& settings_;
  std::vector<ScanCorrection> corrections_;
  std::vector<Eigen::Vector3d> moved_W_;  // The patches, corrected as far as known.
  std::vector<int32_t> next_in_cell_;
  std::vector<Partner> partners_;  // Of one patch, by scan.
};

}  // namespace

std::vector<ScanCorrection> RegisterScans(std::span<const ScanPatch> patches, int scan_count,
                                          const ScanRegistrationSettings& settings) {
  for (const ScanPatch& patch : patches) {
    if (patch.scan < 0 || patch.scan >= scan_count)
      throw std::invalid_argument("RegisterScans: a patch of scan " + std::to_string(patch.scan));
  }
  Registration registration(patches, scan_count, settings);
  double tolerance_m = settings.first_tolerance_m;
  for (int round = 0; round < settings.rounds; ++round) {
    registration.Improve(tolerance_m);
    tolerance_m = std::max(settings.last_tolerance_m, settings.tolerance_shrinks * tolerance_m);
  }
  return registration.corrections();
}

std::vector<Stripe> MakeRegisteredStripes(const Profiler& profiler, std::vector<Stripe> stripes) {
  const std::vector<int32_t> last = FindLastIndices(stripes);
  const std::vector<ScanCorrection> corrections =
      RegisterScans(MakeScanPatches(profiler, stripes), static_cast<int>(last.size()));
  for (Stripe& stripe : stripes) {
    if (stripe.end_of_scan) continue;
    const auto scan = static_cast<size_t>(stripe.scan);
    stripe.X_WS.translation() += corrections[scan].CalcOffset(CalcAlong(stripe, last[scan]));
  }
  return stripes;
}

}  // namespace nbs
