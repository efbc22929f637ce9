#include "services/mesher/ridge_sharpener.h"

#include <algorithm>

#include "services/mesher/sort_unique.h"

namespace nbs {
namespace {

bool FacesAway(const Vertex& v, const Tangent& t) {
  constexpr float kOpposite = -0.5f;
  return v.normal_W.dot(t.normal_W) < kOpposite;
}

}  // namespace

RidgeSharpener::Changes RidgeSharpener::Sharpen(std::span<const uint32_t> due, std::span<const Place> before) {
  candidates_.clear();
  refuted_.clear();
  changes_ = {};
  FindCandidates(due);
  FindCandidates(FindNeighbours(due));
  FillCorners(ProposeCorners());
  FillRidges(ProposeFeet());
  Flatten();
  PutBack(before);
  SortUnique(changes_.moved);
  SortUnique(changes_.founded);
  return std::move(changes_);
}

void RidgeSharpener::FindCandidates(std::span<const uint32_t> ids) {
  for (uint32_t id : ids) {
    const Vertex& v = vertices_[id];
    if (v.state != Vertex::State::kReal) continue;
    CollectTangents(v.p_W);
    auto roof = Roof::Fit(tangents_, v.p_W, settings_.roof);
    if (!roof) continue;
    if (IsRidge(*roof, v)) {
      candidates_.push_back({id, std::move(*roof), false});
    } else {
      refuted_.push_back(id);
    }
  }
}

void RidgeSharpener::CollectTangents(const Eigen::Vector3f& p_W) {
  tangents_.clear();
  const float squared_reach = settings_.roof.reach_m * settings_.roof.reach_m;
  vertices_.ForEachNear(p_W, settings_.roof.reach_m, [&](uint32_t id) {
    const Vertex& v = vertices_[id];
    if (v.state == Vertex::State::kReal && v.ridge == Vertex::Ridge::kNone &&
        v.curvature_per_m < settings_.flat_curvature_per_m && (v.p_W - p_W).squaredNorm() < squared_reach &&
        triangulation_.IsSurrounded(id))
      tangents_.push_back({v.p_W, v.normal_W});
  });
}

bool RidgeSharpener::IsRidge(const Roof& roof, const Vertex& v) {
  const auto is_near = [&](const Roof::Feature& f) { return (f.tangent.p_W - v.p_W).norm() < settings_.reach_m; };
  const auto corner = roof.FindCorner();
  const bool at_corner = corner && is_near(*corner);
  const auto feet = roof.FindFeet(v.p_W);
  if (!at_corner && std::none_of(feet.begin(), feet.end(), is_near)) return false;
  const float height = roof.CalcHeight(v.p_W);
  return height >= -(at_corner ? settings_.most_corner_rounding_m : settings_.most_rounding_m) &&
         height <= settings_.most_height_m &&
         evidence_.Carries(roof, {v.p_W, v.normal_W}, at_corner || v.ridge == Vertex::Ridge::kLoose);
}

/// What lies beside a candidate may be near a ridge that is new, without having been measured again itself.
std::vector<uint32_t> RidgeSharpener::FindNeighbours(std::span<const uint32_t> due) const {
  std::vector<uint32_t> neighbours;
  for (const Candidate& c : candidates_) {
    const Eigen::Vector3f& p_W = vertices_[c.id].p_W;
    vertices_.ForEachNear(p_W, settings_.reach_m, [&](uint32_t other) {
      const Vertex& w = vertices_[other];
      if (w.ridge == Vertex::Ridge::kNone && (w.p_W - p_W).squaredNorm() < settings_.reach_m * settings_.reach_m)
        neighbours.push_back(other);
    });
  }
  SortUnique(neighbours);
  std::erase_if(neighbours, [&](uint32_t id) { return std::binary_search(due.begin(), due.end(), id); });
  return neighbours;
}

std::vector<RidgeSharpener::Proposal> RidgeSharpener::ProposeCorners() const {
  std::vector<Proposal> proposals;
  for (size_t i = 0; i < candidates_.size(); ++i) {
    const auto corner = candidates_[i].roof.FindCorner();
    if (!corner) continue;
    const float distance = (corner->tangent.p_W - vertices_[candidates_[i].id].p_W).norm();
    if (distance <= settings_.reach_m) proposals.push_back({distance, i, *corner});
  }
  return proposals;
}

std::vector<RidgeSharpener::Proposal> RidgeSharpener::ProposeFeet() const {
  std::vector<Proposal> proposals;
  for (size_t i = 0; i < candidates_.size(); ++i) {
    const Candidate& c = candidates_[i];
    const Eigen::Vector3f& p_W = vertices_[c.id].p_W;
    for (const Roof::Feature& foot : c.roof.FindFeet(p_W)) {
      for (const int step : {0, 1, -1, 2, -2, 3, -3}) {
        Roof::Feature feature = foot;
        feature.tangent.p_W += static_cast<float>(step) * settings_.step_m * foot.along_W;
        const float distance = (feature.tangent.p_W - p_W).norm();
        if (distance <= settings_.reach_m && c.roof.IsOn(feature.tangent.p_W))
          proposals.push_back({distance, i, feature});
      }
    }
  }
  return proposals;
}

void RidgeSharpener::FillCorners(const std::vector<Proposal>& proposals) {
  std::vector<uint32_t> filled;
  for (const Proposal& proposal : SortByDistance(proposals)) {
    const Tangent& t = proposal.feature.tangent;
    const Candidate& c = candidates_[proposal.candidate];
    const bool taken = std::any_of(filled.begin(), filled.end(), [&](uint32_t id) {
      return (vertices_[id].p_W - t.p_W).norm() < settings_.reach_m && !FacesAway(vertices_[id], t);
    });
    if (taken || !evidence_.IsMeasured(c.roof, proposal.feature)) continue;
    uint32_t id = FindNearest(t, settings_.corner_snap_m);
    if (id == LocalStar::kNone) {
      id = Found(c.id, t);
    } else {
      MoveTo(id, t, Vertex::Ridge::kOn);
    }
    filled.push_back(id);
    for (Candidate& other : candidates_) other.placed = other.placed || other.id == id;
  }
}

void RidgeSharpener::FillRidges(const std::vector<Proposal>& proposals) {
  for (const Proposal& proposal : SortByDistance(proposals)) {
    Candidate& c = candidates_[proposal.candidate];
    const Tangent& t = proposal.feature.tangent;
    const bool moves = !c.placed && proposal.distance_m <= settings_.snap_m;
    if (!HasRoom(proposal, moves) || !evidence_.IsMeasured(c.roof, proposal.feature)) continue;
    if (moves) {
      MoveTo(c.id, t, Vertex::Ridge::kOn);
      c.placed = true;
    } else {
      Found(c.id, t);
    }
  }
}

std::vector<RidgeSharpener::Proposal> RidgeSharpener::SortByDistance(std::vector<Proposal> proposals) {
  std::stable_sort(proposals.begin(), proposals.end(),
                   [](const Proposal& a, const Proposal& b) { return a.distance_m < b.distance_m; });
  return proposals;
}

void RidgeSharpener::Flatten() {
  for (const Candidate& c : candidates_) {
    if (c.placed || vertices_[c.id].curvature_per_m < settings_.flat_curvature_per_m) continue;
    MoveTo(c.id, c.roof.Project(vertices_[c.id].p_W), Vertex::Ridge::kBeside);
  }
}

void RidgeSharpener::PutBack(std::span<const Place> before) {
  std::sort(refuted_.begin(), refuted_.end());
  for (const Place& place : before) {
    Vertex& v = vertices_[place.id];
    if (v.ridge != Vertex::Ridge::kLoose) continue;
    v.ridge = Vertex::Ridge::kNone;
    if (!std::binary_search(refuted_.begin(), refuted_.end(), place.id))
      MoveTo(place.id, place.tangent, Vertex::Ridge::kOn);
  }
}

uint32_t RidgeSharpener::FindNearest(const Tangent& t, float radius_m) const {
  uint32_t nearest = LocalStar::kNone;
  float least = radius_m * radius_m;
  vertices_.ForEachNear(t.p_W, radius_m, [&](uint32_t id) {
    const float squared = (vertices_[id].p_W - t.p_W).squaredNorm();
    if (vertices_[id].state != Vertex::State::kReal || FacesAway(vertices_[id], t)) return;
    if (squared > least || (squared == least && id > nearest)) return;
    nearest = id;
    least = squared;
  });
  return nearest;
}

bool RidgeSharpener::HasRoom(const Proposal& proposal, bool moves) const {
  const Tangent& t = proposal.feature.tangent;
  const uint32_t id = candidates_[proposal.candidate].id;
  const float on_ridge =
      moves && proposal.distance_m < settings_.least_spacing_m ? settings_.least_spacing_m : settings_.spacing_m;
  const float off_ridge = moves ? 0.0f : settings_.room_m;
  bool room = true;
  vertices_.ForEachNear(t.p_W, std::max(settings_.spacing_m, settings_.depth_m), [&](uint32_t other) {
    const Vertex& w = vertices_[other];
    if ((other == id && moves) || w.state != Vertex::State::kReal || FacesAway(w, t)) return;
    const bool is_on = w.ridge == Vertex::Ridge::kOn || w.ridge == Vertex::Ridge::kLoose;
    const Eigen::Vector3f d = w.p_W - t.p_W;
    const float height = d.dot(t.normal_W);
    if (d.norm() < (is_on ? on_ridge : off_ridge)) room = false;
    if (!moves && d.norm() < settings_.depth_m && (d - height * t.normal_W).norm() < settings_.aside_m) room = false;
  });
  return room;
}

void RidgeSharpener::MoveTo(uint32_t id, const Tangent& t, Vertex::Ridge ridge) {
  vertices_.Move(id, t.p_W);
  vertices_[id].normal_W = t.normal_W;
  vertices_[id].ridge = ridge;
  changes_.moved.push_back(id);
}

/// What is known of its measurements is what is known of the vertex beside it.
uint32_t RidgeSharpener::Found(uint32_t beside, const Tangent& t) {
  const Vertex model = vertices_[beside];
  const uint32_t id = vertices_.Insert({t.p_W, t.normal_W, 1.0f}, model.last_scan);
  Vertex& v = vertices_[id];
  v.state = Vertex::State::kReal;
  v.first_scan = model.first_scan;
  v.information = model.information;
  v.measurements = model.measurements;
  v.best_cosine = model.best_cosine;
  v.support = model.support;
  v.curvature_per_m = model.curvature_per_m;
  v.normal_W = t.normal_W;
  v.ridge = Vertex::Ridge::kOn;
  changes_.founded.push_back(id);
  return id;
}

}  // namespace nbs
