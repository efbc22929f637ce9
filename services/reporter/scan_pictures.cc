#include "services/reporter/scan_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/reporter/svg_overlay.h"
#include "sim/robot_body.h"
#include "sim/shape_mesh.h"

namespace nbs {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const Vector3f kArm(0.96f, 0.42f, 0.08f);
const Vector3f kArmEnd(0.30f, 0.31f, 0.33f);
const Vector3f kBase(0.22f, 0.23f, 0.25f);
const Vector3f kSensor(0.10f, 0.22f, 0.42f);
const Vector3f kTable(0.62f, 0.52f, 0.40f);
const Vector3f kFloor(0.80f, 0.81f, 0.82f);
const Vector3f kStone(0.86f, 0.83f, 0.78f);
const Vector3f kNew(0.35f, 0.78f, 0.55f);
constexpr const char* kLaser = "#e00020";

/// The bodies of an arm from its base to its end, then the sensor.
Vector3f ChooseColor(const PlacedPart& part, int last_link) {
  if (part.name == "sensor") return kSensor;
  if (part.link == 0) return kBase;
  return part.link >= last_link ? kArmEnd : kArm;
}

/// Places where a mesh has vertices, in cells of a few millimetres.
class Places {
 public:
  explicit Places(const TriangleMesh& mesh_W) {
    for (const Vector3f& p : mesh_W.vertices_W) cells_.push_back(FindKey(FindCell(p)));
    std::ranges::sort(cells_);
  }

  /// Whether there is one in the same cell or in one that shares a face with it.
  bool Hold(const Vector3f& p_W) const {
    const Eigen::Vector3i cell = FindCell(p_W);
    if (HasCell(cell)) return true;
    for (int axis = 0; axis < 3; ++axis) {
      if (HasCell(cell + Eigen::Vector3i::Unit(axis)) || HasCell(cell - Eigen::Vector3i::Unit(axis))) return true;
    }
    return false;
  }

 private:
  static Eigen::Vector3i FindCell(const Vector3f& p_W) {
    constexpr float kEdge_m = 0.006f;
    return (p_W / kEdge_m).array().floor().cast<int>();
  }
  static int64_t FindKey(const Eigen::Vector3i& cell) {
    constexpr int64_t kSide = 1 << 20;
    return (cell.z() * kSide + cell.y()) * kSide + cell.x();
  }
  bool HasCell(const Eigen::Vector3i& cell) const { return std::ranges::binary_search(cells_, FindKey(cell)); }

  std::vector<int64_t> cells_;
};

/// A mesh, in another colour where the mesh before it had nothing.
void AddSeen(const TriangleMesh& mesh_W, const TriangleMesh& before_W, Drawing& drawing) {
  const Places places(before_W);
  std::vector<uint8_t> is_old;
  for (const Vector3f& p : mesh_W.vertices_W) is_old.push_back(places.Hold(p) ? 1 : 0);
  TriangleMesh old_W = mesh_W, new_W = mesh_W;
  const auto was_there = [&](const std::array<uint32_t, 3>& t) {
    return is_old[t[0]] + is_old[t[1]] + is_old[t[2]] > 0;
  };
  std::erase_if(old_W.triangles, [&](const auto& t) { return !was_there(t); });
  std::erase_if(new_W.triangles, was_there);
  drawing.Add(old_W, kStone);
  drawing.Add(new_W, kNew);
}

void AddRobot(const RobotBody& robot, const Posture& posture, Drawing& drawing) {
  const int last_link = robot.arm() ? robot.arm()->n() - 1 : 0;
  for (const PlacedPart& part : robot.Place(posture, Vector3d::Zero())) {
    const Vector3f color = ChooseColor(part, last_link);
    for (const Capsule& capsule : part.capsules_W) drawing.Add(capsule, color);
    for (const Block& block : part.blocks_W) drawing.Add(block, color);
  }
}

Block MakeBox(const Vector3d& low, const Vector3d& high) {
  Block block;
  block.X_LC.translation() = 0.5 * (low + high);
  block.half = 0.5 * (high - low);
  return block;
}

void AddRoom(const RunConfig& config, const RobotBody& robot, Drawing& drawing) {
  const Vector3d middle(config.p_WO.x(), config.p_WO.y(), 0.0);
  const double floor_z = robot.X_WB().translation().z();
  constexpr double kThin_m = 0.02;
  if (config.cell.table_z_m) {
    const Vector3d half(config.cell.table_half_m.x(), config.cell.table_half_m.y(), 0.0);
    const Vector3d top = *config.cell.table_z_m * Vector3d::UnitZ();
    const Vector3d bottom =
        robot.arm() ? Vector3d(floor_z * Vector3d::UnitZ()) : Vector3d(top - kThin_m * Vector3d::UnitZ());
    drawing.Add(MakeBox(middle - half + bottom, middle + half + top), kTable);
  }
  if (!robot.arm()) return;
  const Vector3d wide(2.5, 2.5, 0.0);
  const Vector3d base(robot.X_WB().translation());
  drawing.Add(MakeBox(base - wide - kThin_m * Vector3d::UnitZ(), base + wide), kFloor);
}

Eigen::AlignedBox3d MakeFrame(const RunConfig& config, const RobotBody& robot) {
  const Vector3d sizes = config.grid.resolution_m * config.grid.size.cast<double>();
  Eigen::AlignedBox3d frame(config.grid.origin_W, config.grid.origin_W + sizes);
  constexpr double kAround_m = 0.2;
  frame.min().array() -= kAround_m;
  frame.max().array() += kAround_m;
  if (robot.arm()) {
    const Vector3d base = robot.X_WB().translation();
    frame.extend(Vector3d(base - Vector3d(0.3, 0.2, 0.0)));
    frame.extend(Vector3d(base + Vector3d(0.3, 0.2, 1.7)));
    frame.min().z() = std::max(frame.min().z(), base.z());
  }
  return frame;
}

/// The emitter, and where its beams end: on the mesh or as far as the profiler sees.
std::vector<Vector3d> FindFan(const Pose& X_WS, const Profiler& profiler, const TriangleScene& mesh_W) {
  constexpr int kBeams = 48;
  std::vector<Vector3d> fan = {X_WS.translation()};
  for (int k = 0; k <= kBeams; ++k) {
    const double angle = (static_cast<double>(k) / kBeams - 0.5) * profiler.fan_rad;
    const Ray ray{X_WS.translation(), X_WS.linear() * Vector3d(std::sin(angle), 0.0, std::cos(angle))};
    const double reach_m = profiler.max_depth_m / std::cos(angle);
    const RayHit hit = mesh_W.CastRay(ray, reach_m);
    fan.push_back(ray.p_W + (hit.hit() ? hit.distance_m - 0.003 : 0.8 * reach_m) * ray.direction_W);
  }
  return fan;
}

PixelLine ProjectAll(const Projection& projection, const std::vector<Vector3d>& points_W) {
  PixelLine line;
  for (const Vector3d& p : points_W) line.push_back(projection.Project(p));
  return line;
}

/// Of a polygon, square pixels.
double CalcArea(const PixelLine& outline) {
  double twice = 0.0;
  for (size_t k = 0; k < outline.size(); ++k) {
    const Eigen::Vector2d& p = outline[k];
    const Eigen::Vector2d& q = outline[(k + 1) % outline.size()];
    twice += p.x() * q.y() - q.x() * p.y();
  }
  return 0.5 * std::abs(twice);
}

/// Draws one scan after the other in the same room.
class ScanPainter {
 public:
  explicit ScanPainter(const RunConfig& config) : config_(config), robot_(config) {
    view_.width = robot_.arm() ? 440 : 360;
    view_.height = robot_.arm() ? 360 : 400;
    view_.elevation_rad = 0.28;
    view_.tight = true;
    view_.frame_W = MakeFrame(config, robot_);
  }

  ReportPicture Draw(const ScanRecord& scan, const RobotState& state, const TriangleMesh& mesh_W,
                     const TriangleMesh& before_W) const {
    Posture posture{state.utime_us, state.X_WF, {}, true};
    if (robot_.arm()) posture.q = MakeJoints(state.joints_rad);
    Drawing drawing;
    AddSeen(mesh_W, before_W, drawing);
    AddRobot(robot_, posture, drawing);
    AddRoom(config_, robot_, drawing);
    const MeshRenderer renderer(drawing.mesh_W(), drawing.surface());
    const std::vector<Vector3d> fan =
        FindFan(state.X_WF * config_.cell.X_FS, config_.cell.profiler, TriangleScene(mesh_W));
    const View view = ChooseView(renderer, fan);
    const Picture picture = renderer.Render(view);
    const Projection projection(view, *view.frame_W);
    const std::vector<Vector3d> path = {scan.path.X_WS_start.translation(), scan.path.X_WS_end.translation()};
    return {fmt::format("{}: {}, {:.2f} m", scan.scan + 1, ToString(scan.source), scan.path.length_m()),
            EncodePng(picture), picture.width, picture.height,
            DrawArea(ProjectAll(projection, fan), kLaser) + DrawLine(ProjectAll(projection, path), "#1a56db", 2.5)};
  }

 private:
  /// Where the fan shows the largest visible area: from either side of an arm, from eight around a free-flying sensor.
  View ChooseView(const MeshRenderer& renderer, const std::vector<Vector3d>& fan) const {
    std::vector<double> azimuths = {-0.3, std::numbers::pi + 0.3};
    if (!robot_.arm()) {
      azimuths.clear();
      for (int k = 0; k < 8; ++k) azimuths.push_back(0.25 * k * std::numbers::pi);
    }
    View best = view_;
    double most = -1.0;
    for (const double azimuth_rad : azimuths) {
      View view = view_;
      view.azimuth_rad = azimuth_rad;
      const auto hidden = renderer.FindHidden(fan, view);
      const double shown = CalcArea(ProjectAll(Projection(view, *view.frame_W), fan)) *
                           static_cast<double>(std::ranges::count(hidden, 0));
      if (shown <= most) continue;
      most = shown;
      best = view;
    }
    return best;
  }

  const RunConfig& config_;
  RobotBody robot_;
  View view_;
};

/// The state in the middle of those that scan; null if none does.
const RobotState* FindMiddle(const ExecutedMotion& motion) {
  std::vector<const RobotState*> scanning;
  for (const RobotState& state : motion.states) {
    if (state.scanning) scanning.push_back(&state);
  }
  return scanning.empty() ? nullptr : scanning[scanning.size() / 2];
}

}  // namespace

std::vector<ReportPicture> DrawScans(const RunConfig& config, const RunRecord& record, const RunTraces& traces) {
  const ScanPainter painter(config);
  std::vector<ReportPicture> pictures;
  for (size_t k = 0; k < std::min(record.scans.size(), traces.meshes_W.size()); ++k) {
    const ScanRecord& scan = record.scans[k];
    const auto motion =
        std::ranges::find_if(traces.motions, [&](const ExecutedMotion& m) { return m.trajectory.scan == scan.scan; });
    const RobotState* middle = motion == traces.motions.end() ? nullptr : FindMiddle(*motion);
    if (middle == nullptr) continue;
    pictures.push_back(
        painter.Draw(scan, *middle, traces.meshes_W[k], k > 0 ? traces.meshes_W[k - 1] : TriangleMesh{}));
  }
  return pictures;
}

}  // namespace nbs
