#include "services/mesher/measurement_map.h"

namespace nbs {
namespace {

/// Number of the axis direction nearest to v: 0 +x, 1 -x, 2 +y, 3 -y, 4 +z, 5 -z.
int CalcSide(const Eigen::Vector3f& v) {
  int axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (v[axis] < 0.0f ? 1 : 0);
}

void Add(const Measurement& m, Sample& sample) {
  const float sigma_mm = 1e3f * m.sigma_m;
  const float weight = 1.0f / (sigma_mm * sigma_mm);
  sample.weight += weight;
  sample.p_W += (m.p_W - sample.p_W) * (weight / sample.weight);
  sample.view_sum_W += m.view_W;
  ++sample.measurements;
}

}  // namespace

void MeasurementMap::Insert(const Measurement& m) {
  const int side = CalcSide(m.view_W);
  int32_t& head = grid_.Touch(m.p_W);
  for (int32_t i = head; i != BrickGrid::kNone; i = entries_[i].next) {
    if (entries_[i].side != side) continue;
    Add(m, entries_[i].sample);
    return;
  }
  Entry entry;
  entry.next = head;
  entry.side = side;
  Add(m, entry.sample);
  head = static_cast<int32_t>(entries_.size());
  entries_.push_back(entry);
}

void MeasurementMap::Gather(const Eigen::Vector3f& p_W, float radius_m, const Eigen::Vector3f& side_W,
                            float least_cosine, std::vector<Sample>& samples) const {
  const float squared_radius = radius_m * radius_m;
  grid_.ForEachCell(p_W, radius_m, [&](int32_t head) {
    for (int32_t i = head; i != BrickGrid::kNone; i = entries_[i].next) {
      const Sample& s = entries_[i].sample;
      if ((s.p_W - p_W).squaredNorm() <= squared_radius &&
          s.view_sum_W.dot(side_W) > least_cosine * s.view_sum_W.norm())
        samples.push_back(s);
    }
  });
}

}  // namespace nbs
