#include "services/planner/surface_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/runtime/parallel.h"

namespace nbs {
namespace {

/// The prediction is coarse: walls so near before an element do not hide it.
constexpr float kBlind_m = 0.020f;

/// Whether an element can be seen from a point: walks the line in steps as long as the room around allows, at least
/// a block, which is as exact as a prediction in blocks deserves.
bool IsInSight(const SurfacePrediction& prediction, const Eigen::Vector3f& from_W, const Eigen::Vector3f& element_W) {
  const GridShape& shape = prediction.shape();
  const auto block_m = static_cast<float>(shape.resolution_m);
  // In blocks, from the element to the sensor: what hides an element is mostly near it.
  const Eigen::Array3f start = (element_W - shape.origin_W.cast<float>()).array() / block_m;
  const Eigen::Array3f line = (from_W - element_W).array() / block_m;
  const float length = line.matrix().norm();
  const Eigen::Array3f along = line / length;
  const float steps_per_room = 1.0f / along.abs().maxCoeff();
  // Outside all is free: the line ends where it leaves the blocks.
  const Eigen::Array3f way = (along < 0.0f).select(start, shape.size.cast<float>().array() - start) / along.abs();
  const float end = std::min(length, way.minCoeff() - 1e-3f);
  const uint8_t* room = prediction.room().data();
  const auto row = static_cast<int64_t>(shape.size.x()), layer = row * shape.size.y();
  float done = kBlind_m / block_m;
  while (done < end) {
    const auto x = static_cast<int>(start.x() + along.x() * done), y = static_cast<int>(start.y() + along.y() * done),
               z = static_cast<int>(start.z() + along.z() * done);
    const int free_blocks = room[z * layer + y * row + x] - 1;
    if (free_blocks < 0) return false;
    done += std::max(1.0f, static_cast<float>(free_blocks) * steps_per_room);
  }
  return true;
}

}  // namespace

SurfaceView::SurfaceView(const Profiler& profiler, double incidence_margin_rad)
    : min_depth_m_(static_cast<float>(profiler.min_depth_m)),
      max_depth_m_(static_cast<float>(profiler.max_depth_m)),
      tan_half_fan_(static_cast<float>(std::tan(0.5 * profiler.fan_rad))),
      min_cosine_(static_cast<float>(std::cos(profiler.max_incidence_rad - incidence_margin_rad))),
      camera_baseline_m_(static_cast<float>(profiler.camera_baseline_m)) {}

template <typename Visit>
void SurfaceView::VisitSeen(const SurfacePrediction& prediction, const ScanPath& path, uint32_t element_step,
                            Visit&& visit) const {
  const Eigen::Vector3f start_W = path.X_WS_start.translation().cast<float>();
  const Eigen::Vector3f way_W = path.X_WS_end.translation().cast<float>() - start_W;
  const Eigen::Matrix3f R_WS = path.X_WS_start.linear().cast<float>();
  const float way_y = way_W.dot(R_WS.col(1));
  if (std::abs(way_y) < 1e-6f) return;
  const Eigen::Vector3f to_camera_W = camera_baseline_m_ * R_WS.col(1);
  const std::span<const SurfaceElement> elements = prediction.elements();
  for (uint32_t i = element_step / 2; i < elements.size(); i += element_step) {
    const SurfaceElement& element = elements[i];
    const float fraction = (element.p_W - start_W).dot(R_WS.col(1)) / way_y;
    if (!(fraction >= 0.0f && fraction <= 1.0f)) continue;
    const Eigen::Vector3f emitter_W = start_W + fraction * way_W;
    const Eigen::Vector3f beam_W = element.p_W - emitter_W;
    const float depth = beam_W.dot(R_WS.col(2));
    if (depth < min_depth_m_ || depth > max_depth_m_) continue;
    if (std::abs(beam_W.dot(R_WS.col(0))) > depth * tan_half_fan_) continue;
    if (-beam_W.dot(element.normal_W) < beam_W.norm() * min_cosine_) continue;
    if (!IsInSight(prediction, emitter_W, element.p_W)) continue;
    if (camera_baseline_m_ != 0.0f && !IsInSight(prediction, emitter_W + to_camera_W, element.p_W)) continue;
    visit(i, beam_W);
  }
}

double SurfaceView::CalcArea(const SurfacePrediction& prediction, const ScanPath& path, uint32_t element_step) const {
  double area_m2 = 0.0;
  VisitSeen(prediction, path, element_step, [&](uint32_t i, const Eigen::Vector3f& beam_W) {
    const SurfaceElement& element = prediction.elements()[i];
    area_m2 += element.area_m2 * prediction.CalcTrust(element, beam_W);
  });
  return element_step * area_m2;
}

double SurfaceView::CalcGain(const SurfacePrediction& prediction, const ScanPath& path, double voxel_m) const {
  return CalcArea(prediction, path, 1) / (voxel_m * voxel_m) * std::numbers::ln2;
}

std::vector<double> SurfaceView::CalcGains(const SurfacePrediction& prediction, std::span<const ScanPath> paths,
                                           double voxel_m, int threads, uint32_t element_step) const {
  std::vector<double> gains_nat(paths.size());
  ForEachIndex(paths.size(), threads, [&](size_t i) {
    gains_nat[i] = CalcArea(prediction, paths[i], element_step) / (voxel_m * voxel_m) * std::numbers::ln2;
  });
  return gains_nat;
}

std::vector<Sighting> SurfaceView::FindSeen(const SurfacePrediction& prediction, const ScanPath& path) const {
  std::vector<Sighting> seen;
  VisitSeen(prediction, path, 1, [&seen](uint32_t i, const Eigen::Vector3f& beam_W) { seen.push_back({i, beam_W}); });
  return seen;
}

}  // namespace nbs
