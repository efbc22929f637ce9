#include "services/mesher/streaming_mesher.h"

#include <algorithm>
#include <cmath>

namespace nbs {
namespace {

constexpr float kNormalUnit = 32767.0f;
constexpr int32_t kLastScan = 0xffff;
// A number further ahead is of no scan that anybody has begun, and would shut out all that follow.
constexpr int32_t kMostScansSkipped = 16;

}  // namespace

StreamingMesher::StreamingMesher(const Profiler& profiler, const StreamingMesherSettings& settings)
    : profiler_(profiler),
      settings_(settings),
      measurements_(settings.cell_m),
      vertices_(2.0f * settings.spacing_m),
      triangulation_(settings.triangulation) {
  for (const Eigen::Vector3d& d : CalcBeamDirections_S(profiler)) directions_S_.push_back(d.cast<float>());
}

bool StreamingMesher::IsAcceptable(const Stripe& stripe) const {
  if (!stripe.end_of_scan) {
    if (static_cast<int>(stripe.ranges_m.size()) != profiler_.points || !IsRigid(stripe.X_WS)) return false;
    if (stripe.X_WS.translation().cwiseAbs().maxCoeff() > 0.5 * BrickGrid::kReach_m) return false;
  }
  if (stripe.scan < 0 || stripe.scan > kLastScan || stripe.index < 0) return false;
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

void StreamingMesher::MarkForFit(uint32_t id) {
  Vertex& v = vertices_[id];
  ++v.fresh;
  if (v.fit_due || static_cast<float>(v.fresh) < settings_.refit_share * static_cast<float>(v.support)) return;
  v.fit_due = true;
  fit_queue_.Push(id, now_);
}

void StreamingMesher::MarkForStar(uint32_t id) {
  if (vertices_[id].star_due) return;
  vertices_[id].star_due = true;
  star_queue_.Push(id, now_);
}

void StreamingMesher::MarkStarsAround(uint32_t id) {
  Vertex& v = vertices_[id];
  const Eigen::Vector3f p_W = v.star_p_W = v.p_W;
  for (int i = 0; i < 3; ++i) v.star_normal_W[i] = static_cast<int16_t>(std::lround(kNormalUnit * v.normal_W[i]));
  const float squared_reach = settings_.triangulation.max_edge_m * settings_.triangulation.max_edge_m;
  vertices_.ForEachNear(p_W, settings_.triangulation.max_edge_m, [&](uint32_t other) {
    const Vertex& w = vertices_[other];
    if (w.state == Vertex::State::kReal && (w.p_W - p_W).squaredNorm() <= squared_reach) MarkForStar(other);
  });
}

void StreamingMesher::MarkForPublishing(uint32_t id) {
  if (vertices_[id].publish_due) return;
  vertices_[id].publish_due = true;
  publish_due_.push_back(id);
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

void StreamingMesher::FitDueVertices() {
  for (uint32_t id : due_) {
    vertices_[id].fit_due = false;
    vertices_[id].fresh = 0;
    if (vertices_[id].state == Vertex::State::kReal) FitReal(id);
    if (vertices_[id].state == Vertex::State::kPending) FitPending(id);
  }
}

void StreamingMesher::FitPending(uint32_t id) {
  Vertex& v = vertices_[id];
  const Eigen::Vector3f view_W = v.normal_W.normalized();
  samples_.clear();
  measurements_.Gather(v.anchor_W, settings_.fit.radius_m, view_W, settings_.founding_cosine, samples_);
  const auto guess = EstimateNormal(samples_, v.anchor_W, view_W, settings_.fit);
  if (!guess) return;
  const auto fit = FitSurface(samples_, v.anchor_W, v.anchor_W, *guess, settings_.fit);
  if (!fit || fit->normal_W.dot(view_W) < std::cos(settings_.max_incidence_rad)) return;
  if (fit->near_share < settings_.least_near_share) return;
  if (!HasRoomFor(id, *fit)) {
    vertices_.Remove(id);
    return;
  }
  v.state = Vertex::State::kReal;
  ++real_vertices_;
  v.support = fit->measurements;
  v.normal_W = fit->normal_W;
  v.best_cosine = fit->normal_W.dot(view_W);
  vertices_.Move(id, fit->p_W);
  v.anchor_W = v.p_W;
  MarkStarsAround(id);
  MarkForPublishing(id);
}

bool StreamingMesher::HasRoomFor(uint32_t id, const SurfaceFit& fit) const {
  const float least = settings_.least_spacing_share * settings_.spacing_m;
  bool room = true;
  vertices_.ForEachNear(fit.p_W, settings_.fit.height_tolerance_m, [&](uint32_t other) {
    const Vertex& w = vertices_[other];
    if (other == id || w.state != Vertex::State::kReal) return;
    const Eigen::Vector3f d = w.p_W - fit.p_W;
    const float cosine = w.normal_W.dot(fit.normal_W);
    if (cosine > -0.5f && d.squaredNorm() < least * least) room = false;
    // A parallel sheet of the same side this close above or below is the same surface, measured with an offset.
    const float height = d.dot(fit.normal_W);
    if (cosine > 0.8f && std::abs(height) < settings_.fit.height_tolerance_m &&
        d.squaredNorm() - height * height < least * least)
      room = false;
  });
  return room;
}

void StreamingMesher::FitReal(uint32_t id) {
  Vertex& v = vertices_[id];
  samples_.clear();
  measurements_.Gather(v.anchor_W, settings_.fit.radius_m, v.normal_W, settings_.sample_cosine, samples_);
  MarkForPublishing(id);
  const auto fit = FitSurface(samples_, v.anchor_W, v.p_W, v.normal_W, settings_.fit);
  if (!fit) return;
  v.support = fit->measurements;
  v.normal_W = fit->normal_W;
  vertices_.Move(id, fit->p_W);
  const Eigen::Vector3f star_normal_W(v.star_normal_W[0], v.star_normal_W[1], v.star_normal_W[2]);
  const bool moved = (v.p_W - v.star_p_W).norm() > settings_.star_moved_m;
  const bool turned = v.normal_W.dot(star_normal_W) < kNormalUnit * std::cos(settings_.star_turned_rad);
  if (moved || turned) MarkStarsAround(id);
}

void StreamingMesher::TriangulateDueVertices() {
  for (uint32_t id : due_) vertices_[id].star_due = false;
  if (!due_.empty()) triangulation_.Update(due_, vertices_);
}

MeshDelta StreamingMesher::TakeDelta() {
  MeshDelta delta;
  delta.utime_us = scan_.utime_us;
  delta.scan = scan_.scan;
  delta.end_of_scan = scan_ended_;
  CollectVertices(delta);
  for (uint32_t slot : triangulation_.TakeChangedSlots())
    delta.triangles.push_back({slot, topology().triangles()[slot]});
  return delta;
}

void StreamingMesher::CollectVertices(MeshDelta& delta) {
  std::sort(publish_due_.begin(), publish_due_.end());
  std::vector<uint32_t> held_back;
  for (uint32_t id : publish_due_) {
    Vertex& v = vertices_[id];
    const bool noticeable = !v.published || (v.p_W - v.published_p_W).norm() > settings_.moved_noticeably_m;
    if (!noticeable && !scan_ended_) {
      held_back.push_back(id);
      continue;
    }
    v.publish_due = false;
    v.published = true;
    v.published_p_W = v.p_W;
    delta.vertices.push_back({id, v.p_W, v.normal_W, 1.0f / std::sqrt(v.information),
                              std::acos(std::clamp(v.best_cosine, -1.0f, 1.0f)), v.measurements, v.first_scan,
                              v.last_scan});
  }
  publish_due_ = std::move(held_back);
}

double StreamingMesher::CalcRimLength() {
  double length_m = 0.0;
  triangulation_.ForEachBorderEdge(
      [&](uint32_t a, uint32_t b) { length_m += static_cast<double>((vertices_[b].p_W - vertices_[a].p_W).norm()); });
  return length_m;
}

MeshScan StreamingMesher::CalcScanFigures() {
  MeshScan figures = scan_;
  figures.refused = counts_.refused_measurements + counts_.refused_stripes;
  figures.vertices = real_vertices_;
  figures.triangles = topology().triangle_count();
  figures.edges = topology().edge_count();
  figures.border_edges = topology().border_edge_count();
  figures.rim_length_m = CalcRimLength();
  if (figures.edges > 0)
    figures.completeness = 1.0 - static_cast<double>(figures.border_edges) / static_cast<double>(figures.edges);
  return figures;
}

}  // namespace nbs
