#pragma once

#include <cstdint>
#include <vector>

#include "services/mesher/brick_grid.h"

namespace nbs {

/// One point on a surface, as measured.
struct Measurement {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();     ///< Metres.
  Eigen::Vector3f view_W = Eigen::Vector3f::Zero();  ///< Unit, from the point towards the sensor.
  float sigma_m = 0.0f;                              ///< Standard deviation along the beam, > 0.
};

/// What the measurements of one cell, seen from about the same side, come to.
struct Sample {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();         ///< Mean of the points, weighted by 1/sigma^2.
  Eigen::Vector3f view_sum_W = Eigen::Vector3f::Zero();  ///< Sum of the unit views.
  float weight = 0.0f;                                   ///< Sum of 1/sigma^2 in 1/mm^2.
  int32_t measurements = 0;
};

/// All measurements so far, summed up in cells so that memory grows with the surface and not with the number of points.
/// What was seen from opposite sides never shares a sample: each cell keeps one for each of the six axis directions
/// nearest to the view.
class MeasurementMap {
 public:
  /// @param cell_m  Edge of a cell, metres.
  explicit MeasurementMap(float cell_m) : grid_(cell_m) {}

  /// @param m  Finite, within BrickGrid::kReach_m.
  void Insert(const Measurement& m);

  /// Appends, cell by cell, the samples whose point lies within radius_m of p_W and whose mean view makes an angle with
  /// a cosine above `least_cosine` to side_W.
  ///
  /// @param side_W  Unit.
  void Gather(const Eigen::Vector3f& p_W, float radius_m, const Eigen::Vector3f& side_W, float least_cosine,
              std::vector<Sample>& samples) const;

 private:
  struct Entry {
    Sample sample;
    int32_t next = BrickGrid::kNone;
    int32_t side = 0;
  };

  BrickGrid grid_;
  std::vector<Entry> entries_;
};

}  // namespace nbs
