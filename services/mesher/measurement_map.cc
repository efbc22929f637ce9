#include "services/mesher/measurement_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace nbs {
namespace {

constexpr float kViewUnit = 32767.0f;

/// Number of the axis direction nearest to v: 0 +x, 1 -x, 2 +y, 3 -y, 4 +z, 5 -z.
int CalcSide(const Eigen::Vector3f& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (v[axis] < 0.0f ? 1 : 0);
}

/// Bits of the cells from `low` to `high` along one axis, each from 0 to 3, `stride` bits apart, with the `bits` of the
/// axes below at each.
uint64_t Repeat(uint64_t bits, int low, int high, int stride) {
  uint64_t mask = 0;
  for (int i = low; i <= high; ++i) mask |= bits << (stride * i);
  return mask;
}

}  // namespace

MeasurementMap::Cluster& MeasurementMap::FindOrMakeCluster(const Eigen::Vector3f& p_W) {
  int32_t& number = clusters_at_.Touch(p_W);
  if (number == BrickGrid::kNone) {
    if (free_.empty()) {
      free_.push_back(static_cast<int32_t>(clusters_.size()));
      clusters_.Append();
    }
    number = free_.back();
    free_.pop_back();
    const float inverse = 1.0f / (kEdge * cell_m_);
    clusters_[static_cast<size_t>(number)].origin = kEdge * (p_W * inverse).array().floor().cast<int>();
  }
  return clusters_[static_cast<size_t>(number)];
}

int MeasurementMap::CalcRank(const Cluster& cluster, int side, int bit) {
  int rank = std::popcount(cluster.occupied[side] & ((uint64_t{1} << bit) - 1));
  for (int i = 0; i < side; ++i) rank += std::popcount(cluster.occupied[i]);
  return rank;
}

void MeasurementMap::Open(Cluster& cluster, int rank) {
  Entry* begin = cluster.entries.get();
  if (cluster.size == cluster.capacity) {
    cluster.capacity = static_cast<uint16_t>(cluster.size + std::max(2, cluster.size / 8));
    auto grown = std::make_unique<Entry[]>(cluster.capacity);
    std::copy(begin, begin + cluster.size, grown.get());
    cluster.entries = std::move(grown);
    begin = cluster.entries.get();
  }
  std::copy_backward(begin + rank, begin + cluster.size, begin + cluster.size + 1);
  ++cluster.size;
}

void MeasurementMap::Close(Cluster& cluster, int rank) {
  Entry* begin = cluster.entries.get();
  std::copy(begin + rank + 1, begin + cluster.size, begin + rank);
  if (--cluster.size > 0) return;
  cluster.entries.reset();
  cluster.capacity = 0;
}

void MeasurementMap::Add(const Measurement& m, const Eigen::Vector3f& corner_W, Entry& entry) const {
  const float sigma_mm = 1e3f * m.sigma_m;
  const float weight = 1.0f / (sigma_mm * sigma_mm);
  const float share = weight / (entry.weight + weight), view_share = 1.0f / static_cast<float>(entry.measurements + 1);
  const Eigen::Vector3f place = (kPlaces * inverse_cell_) * (m.p_W - corner_W);
  for (int i = 0; i < 3; ++i) {
    const float mean_place = entry.place[i] + share * (place[i] - entry.place[i]);
    entry.place[i] = static_cast<uint16_t>(std::lround(std::clamp(mean_place, 0.0f, kPlaces)));
    const float mean_view = entry.view_W[i] + view_share * (kViewUnit * m.view_W[i] - entry.view_W[i]);
    entry.view_W[i] = static_cast<int16_t>(std::lround(mean_view));
  }
  entry.weight += weight;
  entry.measurements = static_cast<uint16_t>(std::min(entry.measurements + 1, kMostMeasurements));
}

void MeasurementMap::Insert(const Measurement& m, const Eigen::Vector3f& side_W) {
  const int side = CalcSide(side_W);
  Cluster& cluster = FindOrMakeCluster(m.p_W);
  const Eigen::Vector3i cell = (CellOf(m.p_W) - cluster.origin).cwiseMax(0).cwiseMin(kEdge - 1);
  const int bit = 16 * cell.x() + 4 * cell.y() + cell.z();
  const int rank = CalcRank(cluster, side, bit);
  if ((cluster.occupied[side] >> bit & 1) == 0) {
    Open(cluster, rank);
    cluster.occupied[side] |= uint64_t{1} << bit;
    cluster.entries[rank] = {};
  }
  Add(m, CalcCorner(cluster, bit), cluster.entries[rank]);
}

uint64_t MeasurementMap::MakeMask(const Cluster& cluster, const Eigen::Vector3f& p_W, float radius_m) const {
  const Eigen::Vector3i low = (CellOf(p_W - Eigen::Vector3f::Constant(radius_m)) - cluster.origin).cwiseMax(0);
  const Eigen::Vector3i high = (CellOf(p_W + Eigen::Vector3f::Constant(radius_m)) - cluster.origin).cwiseMin(kEdge - 1);
  return Repeat(Repeat(Repeat(1, low.z(), high.z(), 1), low.y(), high.y(), 4), low.x(), high.x(), 16);
}

void MeasurementMap::Gather(const Eigen::Vector3f& p_W, float radius_m, const Eigen::Vector3f& side_W,
                            float least_cosine, std::vector<Sample>& samples) const {
  const float squared_radius = radius_m * radius_m;
  const float least_signed_square = least_cosine * std::abs(least_cosine);
  clusters_at_.ForEachCell(p_W, radius_m, [&](int32_t number) {
    const Cluster& cluster = clusters_[static_cast<size_t>(number)];
    const uint64_t box = MakeMask(cluster, p_W, radius_m);
    const Entry* first = cluster.entries.get();
    for (const uint64_t occupied : cluster.occupied) {
      for (uint64_t cells = occupied & box; cells != 0; cells &= cells - 1) {
        const Entry& entry = first[std::popcount(occupied & ((cells & -cells) - 1))];
        const Eigen::Vector3f sample_p_W = CalcPoint(cluster, std::countr_zero(cells), entry);
        if ((sample_p_W - p_W).squaredNorm() > squared_radius) continue;
        const Eigen::Vector3f view_W(entry.view_W[0], entry.view_W[1], entry.view_W[2]);  // In 1/32767.
        const float along = view_W.dot(side_W);
        if (along * std::abs(along) <= least_signed_square * view_W.squaredNorm()) continue;
        samples.push_back({sample_p_W, view_W * (1.0f / kViewUnit), entry.weight, entry.measurements});
      }
      first += std::popcount(occupied);
    }
  });
}

void MeasurementMap::Forget(const Eigen::Vector3f& p_W, float radius_m) {
  std::vector<int32_t> numbers;
  clusters_at_.ForEachCell(p_W, radius_m, [&](int32_t number) { numbers.push_back(number); });
  for (int32_t number : numbers) {
    Cluster& cluster = clusters_[static_cast<size_t>(number)];
    const uint64_t box = MakeMask(cluster, p_W, radius_m);
    for (int side = 0; side < kSides; ++side) {
      for (uint64_t cells = cluster.occupied[side] & box; cells != 0; cells &= cells - 1) {
        const int bit = std::countr_zero(cells), rank = CalcRank(cluster, side, bit);
        if ((CalcPoint(cluster, bit, cluster.entries[rank]) - p_W).norm() > radius_m) continue;
        Close(cluster, rank);
        cluster.occupied[side] &= ~(uint64_t{1} << bit);
      }
    }
    if (cluster.size > 0) continue;
    clusters_at_.Clear(cell_m_ * (cluster.origin.cast<float>() + Eigen::Vector3f::Constant(0.5f * kEdge)));
    free_.push_back(number);
  }
}

}  // namespace nbs
