#include "services/mesher/local_star.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace nbs {
namespace {

using Point = StarScratch::Point;

/// Ascends with the angle of (x, y), from -2 to 2; opposite directions are 2 apart.
double CalcTurn(double x, double y) {
  const double along = x / (std::abs(x) + std::abs(y));
  return y < 0.0 ? along - 1.0 : 1.0 - along;
}

/// The candidates, laid down in the tangent plane and inverted.
void InvertCandidates(const Eigen::Vector3f& p_W, const Eigen::Vector3f& normal_W,
                      std::span<const StarCandidate> candidates, std::vector<Point>& points) {
  const Eigen::Vector3f x_W = normal_W.unitOrthogonal();
  const Eigen::Vector3f y_W = normal_W.cross(x_W);
  points.clear();
  for (const StarCandidate& c : candidates) {
    const Eigen::Vector3f d = c.p_W - p_W;
    const double x = d.dot(x_W), y = d.dot(y_W);
    const double scale = 1.0 / (std::sqrt(x * x + y * y) * d.norm());
    points.push_back({x * scale, y * scale, CalcTurn(x, y), c.id});
  }
}

double CalcSquaredNorm(const Point& p) { return p.x * p.x + p.y * p.y; }

bool IsNearer(const Point& a, const Point& b) {  // The inversion turns near into far.
  const double na = CalcSquaredNorm(a), nb = CalcSquaredNorm(b);
  return na != nb ? na > nb : a.id < b.id;
}

bool TurnsLeft(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) > 0.0;
}

/// Index of the point at which a gap of at least a straight angle ends; -1 if there is none.
int FindStartAfterGap(const std::vector<Point>& points) {
  const size_t n = points.size();
  for (size_t i = 0; i < n; ++i) {
    double gap = points[(i + 1) % n].turn - points[i].turn;
    if (i + 1 == n) gap += 4.0;
    if (gap >= 2.0) return static_cast<int>((i + 1) % n);
  }
  return -1;
}

}  // namespace

uint32_t LocalStar::FindNext(uint32_t id) const {
  for (int i = 0; i < degree; ++i) {
    if (neighbours[i] != id) continue;
    if (i + 1 < degree) return neighbours[i + 1];
    return closed ? neighbours[0] : kNone;
  }
  return kNone;
}

bool LocalStar::operator==(const LocalStar& other) const {
  return degree == other.degree && closed == other.closed &&
         std::equal(neighbours.begin(), neighbours.begin() + degree, other.neighbours.begin());
}

LocalStar CalcLocalStar(const Eigen::Vector3f& p_W, const Eigen::Vector3f& normal_W,
                        std::span<const StarCandidate> candidates, StarScratch& scratch) {
  LocalStar star;
  if (candidates.empty()) return star;
  std::vector<Point>& points = scratch.points;
  InvertCandidates(p_W, normal_W, candidates, points);
  if (points.size() > LocalStar::kMaxDegree) {
    std::nth_element(points.begin(), points.begin() + LocalStar::kMaxDegree, points.end(), IsNearer);
    points.resize(LocalStar::kMaxDegree);
  }
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.turn != b.turn ? a.turn < b.turn : IsNearer(a, b); });
  int start = FindStartAfterGap(points);
  star.closed = start < 0;
  if (star.closed) start = static_cast<int>(std::min_element(points.begin(), points.end(), IsNearer) - points.begin());

  std::vector<Point>& hull = scratch.hull;
  hull.clear();
  const size_t n = points.size();
  for (size_t i = 0; i <= n; ++i) {
    if (i == n && !star.closed) break;
    const Point& p = points[(start + i) % n];
    while (hull.size() >= 2 && !TurnsLeft(hull[hull.size() - 2], hull.back(), p)) hull.pop_back();
    hull.push_back(p);
  }
  if (star.closed) hull.pop_back();
  star.degree = static_cast<uint8_t>(hull.size());
  for (size_t i = 0; i < hull.size(); ++i) star.neighbours[i] = hull[i].id;
  return star;
}

}  // namespace nbs
