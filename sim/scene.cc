#include "sim/scene.h"

#include <embree3/rtcore.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "sim/closest_on_triangle.h"

namespace nbs {
namespace {

constexpr size_t kPacket = 8;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void CheckMesh(const TriangleMesh& mesh_W) {
  for (const Eigen::Vector3f& p : mesh_W.vertices_W) {
    if (!p.allFinite()) throw std::invalid_argument("TriangleScene: a coordinate is not finite");
  }
  for (const auto& triangle : mesh_W.triangles) {
    for (uint32_t v : triangle) {
      if (v >= mesh_W.vertices_W.size()) throw std::invalid_argument("TriangleScene: no vertex " + std::to_string(v));
    }
  }
}

RTCIntersectContext MakeContext(RTCIntersectContextFlags flags) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = flags;
  return context;
}

void SetRay(RTCRay8& rays, size_t lane, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, float near,
            float far) {
  rays.org_x[lane] = static_cast<float>(origin.x());
  rays.org_y[lane] = static_cast<float>(origin.y());
  rays.org_z[lane] = static_cast<float>(origin.z());
  rays.dir_x[lane] = static_cast<float>(direction.x());
  rays.dir_y[lane] = static_cast<float>(direction.y());
  rays.dir_z[lane] = static_cast<float>(direction.z());
  rays.tnear[lane] = near;
  rays.tfar[lane] = far;
  rays.time[lane] = 0.0f;
  rays.mask[lane] = 0xffffffffu;
  rays.id[lane] = static_cast<unsigned>(lane);
  rays.flags[lane] = 0;
}

RTCRay MakeRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, float near, float far) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x());
  ray.org_y = static_cast<float>(origin.y());
  ray.org_z = static_cast<float>(origin.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = near;
  ray.tfar = far;
  ray.mask = 0xffffffffu;
  return ray;
}

}  // namespace

struct TriangleScene::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<Eigen::Vector3f> vertices;  ///< One more than the mesh has: Embree reads 16 bytes from each.
  std::vector<std::array<uint32_t, 3>> triangles;

  explicit Embree(const TriangleMesh& mesh) : vertices(mesh.vertices_W), triangles(mesh.triangles) {
    vertices.push_back(Eigen::Vector3f::Zero());
    device = rtcNewDevice("threads=1,isa=sse4.2,max_isa=sse4.2,hugepages=0");
    if (device == nullptr) throw std::runtime_error("TriangleScene: Embree does not start on this machine");
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    if (!triangles.empty()) Attach();
    rtcCommitScene(scene);
  }

  ~Embree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  Eigen::Vector3d Corner(uint32_t triangle, int i) const { return vertices[triangles[triangle][i]].cast<double>(); }

  Eigen::Vector3d CalcNormal(uint32_t triangle) const {
    const Eigen::Vector3d a = Corner(triangle, 0);
    return (Corner(triangle, 1) - a).cross(Corner(triangle, 2) - a).normalized();
  }

 private:
  void Attach() {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.data(), 0, 12,
                               vertices.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0, 12,
                               triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
};

TriangleScene::TriangleScene(const TriangleMesh& mesh_W) {
  CheckMesh(mesh_W);
  embree_ = std::make_unique<Embree>(mesh_W);
  for (const auto& triangle : mesh_W.triangles) {
    for (const uint32_t v : triangle) box_W_.extend(mesh_W.vertices_W[v].cast<double>());
  }
}

TriangleScene::~TriangleScene() = default;
TriangleScene::TriangleScene(TriangleScene&&) noexcept = default;
TriangleScene& TriangleScene::operator=(TriangleScene&&) noexcept = default;

std::vector<RayHit> TriangleScene::CastRays(std::span<const Ray> rays, double reach_m) const {
  std::vector<RayHit> hits(rays.size());
  RTCIntersectContext context = MakeContext(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  for (size_t begin = 0; begin < rays.size(); begin += kPacket) {
    const size_t count = std::min(kPacket, rays.size() - begin);
    alignas(32) int valid[kPacket] = {};
    alignas(32) RTCRayHit8 packet{};
    for (size_t lane = 0; lane < count; ++lane) {
      valid[lane] = -1;
      const Ray& ray = rays[begin + lane];
      SetRay(packet.ray, lane, ray.p_W, ray.direction_W, 0.0f, static_cast<float>(reach_m));
      packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, embree_->scene, &context, &packet);
    for (size_t lane = 0; lane < count; ++lane) {
      if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
      RayHit& hit = hits[begin + lane];
      hit.triangle = packet.hit.primID[lane];
      hit.distance_m = packet.ray.tfar[lane];
      hit.normal_W = embree_->CalcNormal(hit.triangle);
    }
  }
  return hits;
}

RayHit TriangleScene::CastRay(const Ray& ray, double reach_m) const { return CastRays({&ray, 1}, reach_m)[0]; }

std::vector<uint8_t> TriangleScene::FindBlocked(std::span<const Segment> segments, double skip_m) const {
  std::vector<uint8_t> blocked(segments.size(), 0);
  RTCIntersectContext context = MakeContext(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  for (size_t i = 0; i < segments.size(); ++i) {
    const Eigen::Vector3d p_AB = segments[i].p_WB - segments[i].p_WA;
    const double length = p_AB.norm();
    if (!(length > skip_m)) continue;
    RTCRay ray = MakeRay(segments[i].p_WA, p_AB / length, static_cast<float>(skip_m), static_cast<float>(length));
    rtcOccluded1(embree_->scene, &context, &ray);
    blocked[i] = ray.tfar == -kInfinity;
  }
  return blocked;
}

namespace {

/// What a closest-point query carries along.
struct Search {
  const Eigen::Vector3f* vertices = nullptr;
  const std::array<uint32_t, 3>* triangles = nullptr;
  Eigen::Vector3d p_W;
  Eigen::Vector3d normal_W;
  double min_cosine = -2.0;  ///< Below -1: any normal will do.
  double best_squared = 0.0;
  bool found = false;
  ClosestPoint best;
};

bool VisitTriangle(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  const uint32_t id = arguments->primID;
  const auto& corners = search.triangles[id];
  const Eigen::Vector3d a = search.vertices[corners[0]].cast<double>();
  const Eigen::Vector3d b = search.vertices[corners[1]].cast<double>();
  const Eigen::Vector3d c = search.vertices[corners[2]].cast<double>();
  const Eigen::Vector3d p = CalcClosestOnTriangle(search.p_W, a, b, c);
  const double squared = (p - search.p_W).squaredNorm();
  if (squared > search.best_squared) return false;
  if (search.found && squared == search.best_squared && id > search.best.triangle) return false;
  const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
  if (search.min_cosine > -1.0 && normal.dot(search.normal_W) < search.min_cosine) return false;
  search.found = true;
  search.best_squared = squared;
  search.best = {id, std::sqrt(squared), p, normal};
  // A little more than the distance, so that rounding to float hides no triangle at the same distance.
  const float radius = static_cast<float>(search.best.distance_m * 1.00001 + 1e-7);
  if (radius >= arguments->query->radius) return false;
  arguments->query->radius = radius;
  return true;
}

}  // namespace

std::optional<ClosestPoint> TriangleScene::FindClosest(const Eigen::Vector3d& p_W, double radius_m) const {
  return FindClosestFacing(p_W, radius_m, Eigen::Vector3d::Zero(), -2.0);
}

std::optional<ClosestPoint> TriangleScene::FindClosestFacing(const Eigen::Vector3d& p_W, double radius_m,
                                                             const Eigen::Vector3d& normal_W, double min_cosine) const {
  Search search;
  search.vertices = embree_->vertices.data();
  search.triangles = embree_->triangles.data();
  search.p_W = p_W;
  search.normal_W = normal_W;
  search.min_cosine = min_cosine;
  search.best_squared = radius_m * radius_m;
  RTCPointQuery query;
  query.x = static_cast<float>(p_W.x());
  query.y = static_cast<float>(p_W.y());
  query.z = static_cast<float>(p_W.z());
  query.time = 0.0f;
  query.radius = static_cast<float>(radius_m * 1.00001 + 1e-7);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(embree_->scene, &query, &context, &VisitTriangle, &search);
  if (!search.found) return std::nullopt;
  return search.best;
}

namespace {

/// What a query for a solid's distance carries along.
struct SolidSearch {
  const Eigen::Vector3f* vertices = nullptr;
  const std::array<uint32_t, 3>* triangles = nullptr;
  const TriangleScene::SolidDistance* distance = nullptr;
  double reach_m = 0.0;
  double best_m = 0.0;
  bool found = false;
};

/// A little more, so that rounding to float hides no triangle.
float CalcQueryRadius(double radius_m) { return static_cast<float>(std::max(0.0, radius_m) * 1.00001 + 1e-7); }

bool VisitForSolid(RTCPointQueryFunctionArguments* arguments) {
  SolidSearch& search = *static_cast<SolidSearch*>(arguments->userPtr);
  const auto& corners = search.triangles[arguments->primID];
  const double distance_m =
      (*search.distance)(search.vertices[corners[0]].cast<double>(), search.vertices[corners[1]].cast<double>(),
                         search.vertices[corners[2]].cast<double>());
  if (distance_m >= search.best_m) return false;
  search.found = true;
  search.best_m = distance_m;
  arguments->query->radius = CalcQueryRadius(search.reach_m + distance_m);
  return true;
}

}  // namespace

std::optional<double> TriangleScene::FindDistance(const Eigen::Vector3d& p_W, double reach_m, double enough_m,
                                                  const SolidDistance& distance) const {
  if (embree_->triangles.empty() || box_W_.exteriorDistance(p_W) > reach_m + enough_m) return std::nullopt;
  SolidSearch search{embree_->vertices.data(), embree_->triangles.data(), &distance, reach_m, enough_m, false};
  RTCPointQuery query{};
  query.x = static_cast<float>(p_W.x());
  query.y = static_cast<float>(p_W.y());
  query.z = static_cast<float>(p_W.z());
  query.radius = CalcQueryRadius(reach_m + enough_m);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(embree_->scene, &query, &context, &VisitForSolid, &search);
  if (!search.found) return std::nullopt;
  return search.best_m;
}

bool TriangleScene::IsInside(const Eigen::Vector3d& p_W) const {
  if (embree_->triangles.empty() || !box_W_.contains(p_W)) return false;
  const double reach_m = 2.0 * box_W_.diagonal().norm();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Ray ray{p_W, sign * Eigen::Vector3d::Unit(axis)};
      const RayHit hit = CastRay(ray, reach_m);
      if (!hit.hit() || hit.normal_W.dot(ray.direction_W) <= 0.0) return false;
    }
  }
  return true;
}

}  // namespace nbs
