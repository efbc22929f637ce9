// Which vertices are fitted, what becomes of them, and whose stars and places that changes.

#include <algorithm>
#include <cmath>

#include "services/mesher/streaming_mesher.h"

namespace nbs {
namespace {

constexpr float kNormalUnit = 32767.0f;
constexpr int kMost = 0xffff;

}  // namespace

void StreamingMesher::MarkForFit(uint32_t id) {
  Vertex& v = vertices_[id];
  v.fresh = static_cast<uint16_t>(std::min(v.fresh + 1, kMost));
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
  // A star that a vertex leaves without coming near another has to know; it stays in reach on a smaller move.
  constexpr float kFar_m = 0.0005f;
  const Eigen::Vector3f from_W = v.star_p_W;
  const bool has_star = !from_W.isZero();
  v.star_p_W = v.p_W;
  for (int i = 0; i < 3; ++i) v.star_normal_W[i] = static_cast<int16_t>(std::lround(kNormalUnit * v.normal_W[i]));
  MarkStarsNear(v.p_W);
  if (has_star && (v.p_W - from_W).squaredNorm() > kFar_m * kFar_m) MarkStarsNear(from_W);
}

void StreamingMesher::MarkStarsNear(const Eigen::Vector3f& p_W) {
  const float squared_reach = settings_.triangulation.max_edge_m * settings_.triangulation.max_edge_m;
  vertices_.ForEachNear(p_W, settings_.triangulation.max_edge_m, [&](uint32_t id) {
    const Vertex& v = vertices_[id];
    if (v.state == Vertex::State::kReal && (v.p_W - p_W).squaredNorm() <= squared_reach) MarkForStar(id);
  });
}

void StreamingMesher::MarkForPublishing(uint32_t id) {
  if (vertices_[id].publish_due) return;
  vertices_[id].publish_due = true;
  publish_due_.push_back(id);
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
  SetSurface(id, *fit);
  v.best_cosine = fit->normal_W.dot(view_W);
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

void StreamingMesher::SetSurface(uint32_t id, const SurfaceFit& fit) {
  Vertex& v = vertices_[id];
  v.support = static_cast<uint16_t>(std::min(fit.measurements, kMost));
  v.normal_W = fit.normal_W;
  v.curvature_per_m = static_cast<uint16_t>(std::min(fit.curvature_per_m, static_cast<float>(kMost)));
  vertices_.Move(id, fit.p_W);
  // At a ridge so sharp that each side is only seen without the other, both are smooth and end there.
  if (fit.curvature_per_m >= settings_.ridges.ridge_curvature_per_m || !triangulation_.IsSurrounded(id))
    ridge_due_.push_back(id);
}

void StreamingMesher::FitReal(uint32_t id) {
  if (vertices_[id].ridge != Vertex::Ridge::kNone) {
    ridge_due_.push_back(id);
  } else if (Refit(id)) {
    MarkIfMoved(id);
  }
}

bool StreamingMesher::Refit(uint32_t id) {
  const Vertex& v = vertices_[id];
  samples_.clear();
  measurements_.Gather(v.anchor_W, settings_.fit.radius_m, v.normal_W, settings_.sample_cosine, samples_);
  MarkForPublishing(id);
  const auto fit = FitSurface(samples_, v.anchor_W, v.p_W, v.normal_W, settings_.fit);
  if (!fit) return false;
  SetSurface(id, *fit);
  return true;
}

void StreamingMesher::MarkIfMoved(uint32_t id) {
  const Vertex& v = vertices_[id];
  const Eigen::Vector3f star_normal_W(v.star_normal_W[0], v.star_normal_W[1], v.star_normal_W[2]);
  const bool moved = (v.p_W - v.star_p_W).norm() > settings_.star_moved_m;
  const bool turned = v.normal_W.dot(star_normal_W) < kNormalUnit * std::cos(settings_.star_turned_rad);
  if (moved || turned) MarkStarsAround(id);
}

}  // namespace nbs
