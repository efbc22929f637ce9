#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "services/mesher/brick_grid.h"
#include "services/mesher/paged_vector.h"

namespace nbs {

/// One point on a surface, as measured.
struct Measurement {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();     ///< Metres.
  Eigen::Vector3f view_W = Eigen::Vector3f::Zero();  ///< Unit, from the point towards the sensor.
  float sigma_m = 0.0f;                              ///< Standard deviation along the beam, > 0.
};

/// What the measurements of one cell, seen from about the same side, come to.
struct Sample {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();     ///< Mean of the points, weighted by 1/sigma^2.
  Eigen::Vector3f view_W = Eigen::Vector3f::Zero();  ///< Mean of the unit views: its product with a unit normal is the
                                                     ///< mean cosine of the incidence.
  float weight = 0.0f;                               ///< Sum of 1/sigma^2 in 1/mm^2.
  int32_t measurements = 0;
};

/// All measurements so far, summed up in cells so that memory grows with the surface and not with the number of points.
/// What belongs to opposite sides never shares a sample: each cell keeps one for each of the six axis directions
/// nearest to a side.
///
/// Samples lie side by side in clusters of 4 x 4 x 4 cells, found by one bit each, at 18 bytes a sample: their
/// places are kept to a 65535th of a cell.
class MeasurementMap {
 public:
  /// @param cell_m  Edge of a cell, metres.
  explicit MeasurementMap(float cell_m)
      : cell_m_(cell_m), inverse_cell_(1.0f / cell_m), place_m_(cell_m / kPlaces), clusters_at_(kEdge * cell_m) {}

  /// @param m       Finite, within BrickGrid::kReach_m.
  /// @param side_W  The side of the surface that was measured: its normal if it is known, otherwise the view.
  void Insert(const Measurement& m, const Eigen::Vector3f& side_W);

  /// Appends, cluster by cluster, the samples whose point lies within radius_m of p_W and whose mean view makes an
  /// angle with a cosine above `least_cosine` to side_W.
  ///
  /// @param side_W  Unit.
  void Gather(const Eigen::Vector3f& p_W, float radius_m, const Eigen::Vector3f& side_W, float least_cosine,
              std::vector<Sample>& samples) const;

  /// Forgets the samples whose point lies within radius_m of p_W.
  void Forget(const Eigen::Vector3f& p_W, float radius_m);

 private:
  static constexpr int kEdge = 4, kSides = 6;
  static constexpr int kMostMeasurements = 0xffff;
  static constexpr float kPlaces = 65535.0f;

  // Packed: most of the mesher's memory but the vertices is samples.
  struct [[gnu::packed]] Entry {
    float weight;
    std::array<uint16_t, 3> place;  // Within the cell, in 1/65535 of its edge: 31 nm at 2 mm.
    std::array<int16_t, 3> view_W;  // In 1/32767.
    uint16_t measurements;
  };
  static_assert(sizeof(Entry) == 18);
  struct Cluster {
    std::array<uint64_t, kSides> occupied{};  // By side: bit 16 x + 4 y + z, if the cell has a sample of that side.
    Eigen::Vector3i origin = Eigen::Vector3i::Zero();  // First cell.
    uint16_t size = 0, capacity = 0;
    std::unique_ptr<Entry[]> entries;  // Ascending by side, then cell.
  };

  Eigen::Vector3i CellOf(const Eigen::Vector3f& p_W) const { return (p_W * inverse_cell_).array().floor().cast<int>(); }
  Cluster& FindOrMakeCluster(const Eigen::Vector3f& p_W);
  static int CalcRank(const Cluster& cluster, int side, int bit);
  static void Open(Cluster& cluster, int rank);
  static void Close(Cluster& cluster, int rank);
  /// The corner of a cell with the least coordinates.
  Eigen::Vector3f CalcCorner(const Cluster& cluster, int bit) const {
    return cell_m_ * (cluster.origin + Eigen::Vector3i(bit >> 4, bit >> 2 & 3, bit & 3)).cast<float>();
  }
  Eigen::Vector3f CalcPoint(const Cluster& cluster, int bit, const Entry& entry) const {
    return CalcCorner(cluster, bit) + place_m_ * Eigen::Vector3f(entry.place[0], entry.place[1], entry.place[2]);
  }
  void Add(const Measurement& m, const Eigen::Vector3f& corner_W, Entry& entry) const;
  uint64_t MakeMask(const Cluster& cluster, const Eigen::Vector3f& p_W, float radius_m) const;

  float cell_m_, inverse_cell_, place_m_;
  BrickGrid clusters_at_;
  PagedVector<Cluster> clusters_;
  std::vector<int32_t> free_;  // Clusters without a place; they hold nothing.
};

}  // namespace nbs
