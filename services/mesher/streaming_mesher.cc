#include "services/mesher/streaming_mesher.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/planning/scan_path.h"
#include "services/mesher/stripe_check.h"

namespace nbs {
namespace {

static_assert(kMaxScans - 1 <= std::numeric_limits<decltype(MeshVertex::last_scan)>::max());
// A number further ahead is of no scan that anybody has begun, and would shut out all that follow.
constexpr int32_t kMostScansSkipped = 16;

}  // namespace

StreamingMesher::StreamingMesher(const Profiler& profiler, const StreamingMesherSettings& settings)
    : profiler_(profiler),
      settings_(settings),
      measurements_(settings.cell_m),
      vertices_(2.0f * settings.spacing_m),
      triangulation_(measurements_, settings.triangulation) {
  for (const Eigen::Vector3d& d : CalcBeamDirections_S(profiler)) directions_S_.push_back(d.cast<float>());
}

bool StreamingMesher::IsAcceptable(const Stripe& stripe) const {
  if (!IsMeasurable(profiler_, stripe)) return false;
  if (stripe.scan < 0 || stripe.scan >= kMaxScans || stripe.index < 0) return false;
  if (!scan_begun_) return true;
  if (stripe.scan != scan_.scan) return stripe.scan > scan_.scan && stripe.scan - scan_.scan <= kMostScansSkipped;
  return !scan_ended_ && stripe.index > last_index_;
}

bool StreamingMesher::AddStripe(const Stripe& stripe) {
  if (!IsAcceptable(stripe)) {
    ++counts_.refused_stripes;
    return false;
  }
  if (!scan_begun_ || stripe.scan != scan_.scan) BeginScan(stripe.scan);
  last_index_ = stripe.index;
  scan_.utime_us = stripe.utime_us;
  if (stripe.end_of_scan) {
    EndScan();
  } else {
    ++scan_.stripes;
    now_.path_m += (stripe.X_WS.translation() - last_p_WS_).norm();
    ++now_.stripes;
    last_p_WS_ = stripe.X_WS.translation();
    AddRanges(stripe);
    Advance();
  }
  return true;
}

void StreamingMesher::AddRanges(const Stripe& stripe) {
  const Eigen::Matrix3f R_WS = stripe.X_WS.linear().cast<float>();
  const Eigen::Vector3f p_WS = stripe.X_WS.translation().cast<float>();
  for (size_t i = 0; i < stripe.ranges_m.size(); ++i) {
    const float range = stripe.ranges_m[i];
    if (range == 0.0f) continue;
    const float depth = range * directions_S_[i].z();
    if (!std::isfinite(range) || range < 0.0f || depth > 2.0 * profiler_.max_depth_m) {
      ++counts_.refused_measurements;
      continue;
    }
    const Eigen::Vector3f beam_W = R_WS * directions_S_[i];
    ++scan_.points;
    AddMeasurement({p_WS + range * beam_W, -beam_W, static_cast<float>(CalcRangeSigma(profiler_, depth))});
  }
}

void StreamingMesher::BeginScan(int32_t scan) {
  if (!scan_ended_) EndScan();
  scan_.scan = scan;
  scan_.stripes = 0;
  scan_.points = 0;
  scan_begun_ = true;
  scan_ended_ = false;
}

void StreamingMesher::EndScan() {
  Update();
  SharpenRidges();
  std::sort(pending_.begin(), pending_.end());
  for (uint32_t id : pending_) {
    if (vertices_[id].state != Vertex::State::kPending) continue;
    unsupported_.push_back({vertices_[id].p_W, now_.stripes});
    vertices_.Remove(id);
  }
  pending_.clear();
  ForgetUnsupported();
  scan_ended_ = true;
}

void StreamingMesher::ForgetUnsupported() {
  while (!unsupported_.empty() && now_.stripes - unsupported_.front().stripes >= settings_.forget_stripes) {
    const Eigen::Vector3f p_W = unsupported_.front().p_W;
    unsupported_.pop_front();
    const float squared_reach = settings_.fit.radius_m * settings_.fit.radius_m;
    bool supported = false;
    vertices_.ForEachNear(p_W, settings_.fit.radius_m, [&](uint32_t id) {
      const Vertex& v = vertices_[id];
      supported = supported || (v.state == Vertex::State::kReal && (v.p_W - p_W).squaredNorm() <= squared_reach);
    });
    if (!supported) measurements_.Forget(p_W, settings_.spacing_m);
  }
}

void StreamingMesher::AddMeasurement(const Measurement& m) {
  uint32_t nearest = MeshTopology::kNone;
  float nearest_squared = settings_.spacing_m * settings_.spacing_m;
  vertices_.ForEachNear(m.p_W, settings_.spacing_m, [&](uint32_t id) {
    Vertex& v = vertices_[id];
    if (v.normal_W.dot(m.view_W) <= settings_.least_view_cosine * v.normal_W.norm()) return;
    MarkForFit(id);
    const float squared = (v.p_W - m.p_W).squaredNorm();
    if (squared > nearest_squared || (squared == nearest_squared && id > nearest)) return;
    nearest = id;
    nearest_squared = squared;
  });
  if (nearest == MeshTopology::kNone) {
    nearest = vertices_.Insert(m, scan_.scan);
    pending_.push_back(nearest);
    MarkForFit(nearest);
  }
  // Where the surface is known all around, it says which side this belongs to.
  measurements_.Insert(m, triangulation_.IsSurrounded(nearest) ? vertices_[nearest].normal_W : m.view_W);
  Refine(nearest, m);
}

void StreamingMesher::Refine(uint32_t id, const Measurement& m) {
  Vertex& v = vertices_[id];
  v.information += 1.0f / (m.sigma_m * m.sigma_m);
  v.measurements = static_cast<uint16_t>(std::min(v.measurements + 1, 0xffff));
  v.last_scan = static_cast<uint16_t>(scan_.scan);
  if (v.state != Vertex::State::kReal) {
    v.normal_W += m.view_W;
    return;
  }
  v.best_cosine = std::max(v.best_cosine, v.normal_W.dot(m.view_W));
  MarkForPublishing(id);
}

void StreamingMesher::Advance() {
  fit_queue_.TakeDue(now_, settings_.fit_lag_m, settings_.lag_stripes, due_);
  FitDueVertices();
  star_queue_.TakeDue(now_, settings_.star_lag_m, settings_.lag_stripes, due_);
  TriangulateDueVertices();
}

void StreamingMesher::Update() {
  fit_queue_.TakeAll(due_);
  FitDueVertices();
  star_queue_.TakeAll(due_);
  TriangulateDueVertices();
}

void StreamingMesher::TriangulateDueVertices() {
  for (uint32_t id : due_) vertices_[id].star_due = false;
  if (!due_.empty()) triangulation_.Update(due_, vertices_);
}

}  // namespace nbs
