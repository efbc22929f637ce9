#include "services/mesher/star_triangulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "services/mesher/border_loop.h"
#include "services/mesher/small_parts.h"
#include "services/mesher/sort_unique.h"

namespace nbs {
namespace {

/// True if v lies behind the sheet of w, and w rises over that of v. Sheets that meet lie both behind each other, at an
/// edge, or both before each other, at an inner corner; here that of v has passed through the other.
bool IsInFront(const Vertex& w, const Vertex& v, float reach_m) {
  constexpr float kLeastSine = 0.34f, kMostCosine = 0.5f;
  const Eigen::Vector3f d = w.p_W - v.p_W;
  const float height = d.dot(v.normal_W);
  if (height <= 0.0f) return false;
  const float least = kLeastSine * d.norm();
  return height > least && d.dot(w.normal_W) > least && d.squaredNorm() < reach_m * reach_m &&
         v.normal_W.dot(w.normal_W) < kMostCosine;
}

SurfaceCorner MakeCorner(const Vertex& v) { return {v.p_W, v.normal_W}; }

float CalcCircumradius(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const Eigen::Vector3f u = b - a, v = c - a;
  return 0.5f * u.norm() * v.norm() * (u - v).norm() / u.cross(v).norm();
}

}  // namespace

StarTriangulation::StarTriangulation(const MeasurementMap& measurements, const TriangulationSettings& settings)
    : measurements_(measurements), settings_(settings), least_normal_cosine_(std::cos(settings.max_normal_angle_rad)) {}

bool StarTriangulation::MayJoin(const Vertex& a, const Vertex& b) const {
  const Eigen::Vector3f d = b.p_W - a.p_W;
  const float squared_length = d.squaredNorm();
  if (squared_length > settings_.max_edge_m * settings_.max_edge_m || squared_length == 0.0f) return false;
  if (a.normal_W.dot(b.normal_W) < least_normal_cosine_) return false;
  // The chord over a ridge between two planes leans from the plane across the mean normal by at most half the angle
  // between the normals.
  const Eigen::Vector3f sum = a.normal_W + b.normal_W;
  const float half_angle_sine = std::sqrt(std::max(0.0f, 0.5f * (1.0f - a.normal_W.dot(b.normal_W))));
  const float max_slope = std::max(settings_.max_slope, half_angle_sine + settings_.slope_margin);
  const float length = std::sqrt(squared_length);
  constexpr float kSteepest = 0.985f;  // Towards either normal; beyond, no direction along the plane is left.
  return std::abs(d.dot(sum)) <= max_slope * length * sum.norm() && std::abs(d.dot(a.normal_W)) <= kSteepest * length &&
         std::abs(d.dot(b.normal_W)) <= kSteepest * length;
}

/// True if something was measured about halfway, as the ground of a crevice is.
bool StarTriangulation::IsMeasuredBetween(const Vertex& a, const Vertex& b) const {
  constexpr float kMiddle = 0.25f, kAnyView = -2.0f;
  const Eigen::Vector3f middle_W = 0.5f * (a.p_W + b.p_W), d = b.p_W - a.p_W;
  std::vector<Sample> samples;
  measurements_.Gather(middle_W, settings_.ground_reach_m, d.normalized(), kAnyView, samples);
  return std::any_of(samples.begin(), samples.end(),
                     [&](const Sample& s) { return std::abs(d.dot(s.p_W - middle_W)) < kMiddle * d.squaredNorm(); });
}

bool StarTriangulation::MayBridge(const Vertex& a, const Vertex& b) const {
  const Eigen::Vector3f d = b.p_W - a.p_W;
  const float length = d.norm();
  if (length > settings_.max_bridge_m || length == 0.0f) return false;
  // Opposite normals that part have matter between them, as at the rim of a plate; normals that meet have air, as in a
  // crevice.
  constexpr float kLeastParting = 0.3f;
  constexpr float kOpposite = -0.5f;
  return a.normal_W.dot(b.normal_W) > kOpposite || d.dot(b.normal_W - a.normal_W) > kLeastParting * length ||
         IsMeasuredBetween(a, b);
}

void StarTriangulation::Update(std::span<const uint32_t> due, const VertexStore& vertices) {
  for (uint32_t id : due) {
    RemoveFillingsAt(id);
    MakeStar(id, vertices);
  }
  checked_.Clear();
  for (uint32_t id : due) RemoveDisagreed(id, vertices);
  for (uint32_t id : due) InsertAgreed(id, vertices);
  touched_.insert(touched_.end(), due.begin(), due.end());
  ReturnHeldBack(vertices);
  touched_in_update_ = touched_;
  FillLoops(vertices);
  HoldBackLesserFans();
  FillLoops(vertices);  // What was held back may have left a loop that other triangles close without a second fan.
  HoldBackLesserFans();
  HoldBackIslands();
}

void StarTriangulation::ReturnHeldBack(const VertexStore& vertices) {
  std::vector<MeshTopology::Triangle> waiting;
  for (size_t first_new = 0;
       first_new < touched_.size();) {  // What returns touches its vertices, and so brings back the rest of its part.
    std::vector<uint32_t> fresh(touched_.begin() + static_cast<std::ptrdiff_t>(first_new), touched_.end());
    first_new = touched_.size();
    std::sort(fresh.begin(), fresh.end());
    waiting.clear();
    waiting.swap(held_back_);
    for (const MeshTopology::Triangle& t : waiting) {
      const bool near = std::any_of(t.begin(), t.end(),
                                    [&](uint32_t v) { return std::binary_search(fresh.begin(), fresh.end(), v); });
      if (!near) {
        held_back_.push_back(t);
      } else if (topology_.Find(t[0], t[1]) == MeshTopology::kNone && IsAgreed(t, vertices)) {
        InsertTriangle(t);
      }
    }
  }
}

void StarTriangulation::HoldBackLesserFans() {
  touched_ = touched_in_update_;
  std::vector<uint32_t> round;
  while (!touched_.empty()) {
    round.clear();
    round.swap(touched_);
    SortUnique(round);
    for (uint32_t id : round) HoldBack(FindLesserFans(topology_, id));
    touched_in_update_.insert(touched_in_update_.end(), touched_.begin(), touched_.end());
  }
  SortUnique(touched_in_update_);
  touched_ = touched_in_update_;
}

void StarTriangulation::HoldBackIslands() {
  large_parts_.Clear();
  for (uint32_t id : touched_in_update_) {
    if (!topology_.IsOnBorder(id) || large_parts_.Contains(id)) continue;
    const std::vector<uint32_t> part = FindPart(topology_, *topology_.TrianglesAt(id).begin(), settings_.least_part);
    if (part.size() < settings_.least_part) {
      HoldBack(part);
    } else {
      for (uint32_t slot : part) large_parts_.Insert(topology_.triangles()[slot]);
    }
  }
  touched_.clear();
  touched_in_update_.clear();
}

void StarTriangulation::HoldBack(const std::vector<uint32_t>& slots) {
  for (uint32_t slot : slots) {
    const int32_t group = topology_.group(slot);
    if (group == kAgreed) {
      held_back_.push_back(topology_.triangles()[slot]);
    } else {
      std::erase(fillings_[group], slot);
      if (fillings_[group].empty()) free_fillings_.push_back(group);
    }
    RemoveTriangle(slot);
  }
}

void StarTriangulation::FillLoops(const VertexStore& vertices) {
  open_border_.Clear();
  std::vector<uint32_t> round;
  while (!touched_.empty()) {  // A filling can untangle the loop beside it: its vertices are looked at once more.
    round.clear();
    round.swap(touched_);
    SortUnique(round);
    for (uint32_t id : round) {
      if (vertices[id].state == Vertex::State::kReal) FillLoopsAt(id, vertices);
    }
  }
}

void StarTriangulation::MakeStar(uint32_t id, const VertexStore& vertices) {
  const Vertex& v = vertices[id];
  candidates_.clear();
  int in_front = 0;
  vertices.ForEachNear(v.p_W, settings_.max_edge_m, [&](uint32_t other) {
    const Vertex& w = vertices[other];
    if (other == id || w.state != Vertex::State::kReal) return;
    if (MayJoin(v, w)) candidates_.push_back({other, w.p_W});
    in_front += IsInFront(w, v, settings_.max_edge_m) ? 1 : 0;
  });
  if (in_front >= settings_.least_in_front) candidates_.clear();
  stars_.Set(id, CalcLocalStar(v.p_W, v.normal_W, candidates_, scratch_));
}

bool StarTriangulation::HasGoodShape(const MeshTopology::Triangle& t, const VertexStore& vertices) const {
  const Vertex &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
  return CalcCircumradius(a.p_W, b.p_W, c.p_W) <= settings_.max_circumradius_m &&
         FacesItsNormals(MakeCorner(a), MakeCorner(b), MakeCorner(c));
}

bool StarTriangulation::IsAgreed(const MeshTopology::Triangle& t, const VertexStore& vertices) const {
  for (int i = 0; i < 3; ++i) {
    if (vertices[t[i]].state != Vertex::State::kReal || stars_.FindNext(t[i], t[(i + 1) % 3]) != t[(i + 2) % 3])
      return false;
  }
  return HasGoodShape(t, vertices);
}

void StarTriangulation::RemoveDisagreed(uint32_t id, const VertexStore& vertices) {
  slots_.clear();
  for (uint32_t slot : topology_.TrianglesAt(id)) {
    if (!checked_.Contains(slot)) slots_.push_back(slot);
  }
  checked_.Insert(slots_);
  for (uint32_t slot : slots_) {
    if (topology_.group(slot) == kAgreed && !IsAgreed(topology_.triangles()[slot], vertices)) RemoveTriangle(slot);
  }
}

void StarTriangulation::InsertAgreed(uint32_t id, const VertexStore& vertices) {
  const LocalStar star = stars_.Get(id);
  const int pairs = star.closed ? star.degree : star.degree - 1;
  for (int i = 0; i < pairs; ++i) {
    uint32_t a = star.neighbours[i], b = star.neighbours[(i + 1) % star.degree];
    MeshTopology::Triangle t{id, a, b};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    const uint32_t present = topology_.Find(id, a);
    if (present != MeshTopology::kNone && topology_.group(present) == kAgreed) continue;
    if (!IsAgreed(t, vertices)) continue;
    InsertTriangle(t);
  }
}

void StarTriangulation::InsertTriangle(const MeshTopology::Triangle& t) {
  for (int k = 0; k < 3; ++k) {
    const uint32_t taken = topology_.Find(t[k], t[(k + 1) % 3]);
    if (taken != MeshTopology::kNone) RemoveFilling(topology_.group(taken));
  }
  topology_.Insert(t, kAgreed);
  touched_.insert(touched_.end(), t.begin(), t.end());
}

void StarTriangulation::RemoveTriangle(uint32_t slot) {
  const MeshTopology::Triangle t = topology_.triangles()[slot];
  touched_.insert(touched_.end(), t.begin(), t.end());
  topology_.Remove(slot);
}

void StarTriangulation::RemoveFillingsAt(uint32_t id) {
  for (bool found = true; found;) {
    found = false;
    for (uint32_t slot : topology_.TrianglesAt(id)) {
      if (topology_.group(slot) == kAgreed) continue;
      RemoveFilling(topology_.group(slot));
      found = true;
      break;
    }
  }
}

void StarTriangulation::RemoveFilling(int32_t group) {
  for (uint32_t slot : fillings_[group]) RemoveTriangle(slot);
  fillings_[group].clear();
  free_fillings_.push_back(group);
}

void StarTriangulation::FillLoopsAt(uint32_t id, const VertexStore& vertices) {
  if (!topology_.IsOnBorder(id) || open_border_.Contains(id)) return;
  std::vector<uint32_t> successors, loop;
  topology_.FindBorderSuccessors(id, successors);
  std::sort(successors.begin(), successors.end());
  for (uint32_t second : successors) {
    if (topology_.Find(second, id) == MeshTopology::kNone || topology_.Find(id, second) != MeshTopology::kNone)
      continue;
    const BorderWalk walk =
        FindBorderLoop(topology_, vertices, id, second, settings_.max_loop_edges, open_border_, loop);
    const bool is_filled = walk == BorderWalk::kClosed && FillLoop(loop, vertices);
    if (walk == BorderWalk::kLong || (walk == BorderWalk::kClosed && !is_filled && IsSimple(loop)))
      open_border_.Insert(loop);
  }
}

bool StarTriangulation::IsSimple(std::span<const uint32_t> loop) const {
  return std::all_of(loop.begin(), loop.end(), [&](uint32_t v) { return topology_.CountBordersFrom(v) == 1; });
}

bool StarTriangulation::FillLoop(std::span<const uint32_t> loop, const VertexStore& vertices) {
  // Corner 0 is the smallest number, so that the filling does not depend on where the walk began.
  std::vector<uint32_t> ring(loop.begin(), loop.end());
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  std::vector<SurfaceCorner> corners;
  for (uint32_t id : ring) corners.push_back(MakeCorner(vertices[id]));
  const auto may_join = [&](uint32_t i, uint32_t j) {
    return MayBridge(vertices[ring[i]], vertices[ring[j]]) && topology_.Find(ring[i], ring[j]) == MeshTopology::kNone &&
           topology_.Find(ring[j], ring[i]) == MeshTopology::kNone;
  };
  const auto triangles = TriangulateLoop(corners, may_join);
  if (triangles.empty()) return false;
  int32_t group = static_cast<int32_t>(fillings_.size());
  if (free_fillings_.empty()) {
    fillings_.emplace_back();
  } else {
    group = free_fillings_.back();
    free_fillings_.pop_back();
  }
  for (const auto& t : triangles)
    fillings_[group].push_back(topology_.Insert({ring[t[0]], ring[t[1]], ring[t[2]]}, group));
  return true;
}

}  // namespace nbs
