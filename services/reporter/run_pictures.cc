#include "services/reporter/run_pictures.h"

#include <fmt/format.h>

#include <numbers>

#include "services/reporter/scan_pictures.h"
#include "services/reporter/svg_overlay.h"
#include "sim/shape_mesh.h"

namespace nbs {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr const char* kSides[] = {"front", "left", "back", "right"};
const Vector3f kOccupied(0.90f, 0.55f, 0.20f);
const Vector3f kUnknown(0.42f, 0.36f, 0.62f);

ReportPicture Encode(std::string caption, const Picture& picture) {
  return {std::move(caption), EncodePng(picture), picture.width, picture.height, {}};
}

/// Where the middle beam of a scan meets the mesh, in pieces without gaps or leaps.
std::vector<std::vector<Vector3d>> FindFootprint(const ScanPath& path, const TriangleScene& mesh_W, double reach_m) {
  constexpr int kPoints = 120;
  constexpr double kLift_m = 0.003;
  constexpr double kLeap_m = 0.025;
  std::vector<std::vector<Vector3d>> pieces(1);
  for (int k = 0; k <= kPoints; ++k) {
    const Pose X_WS = Interpolate(path.X_WS_start, path.X_WS_end, static_cast<double>(k) / kPoints);
    const Ray ray{X_WS.translation(), X_WS.linear().col(2)};
    const RayHit hit = mesh_W.CastRay(ray, reach_m);
    const Vector3d p_W = ray.p_W + (hit.distance_m - kLift_m) * ray.direction_W;
    const bool leaps = !pieces.back().empty() && (p_W - pieces.back().back()).norm() > kLeap_m;
    if (!pieces.back().empty() && (leaps || !hit.hit())) pieces.emplace_back();
    if (hit.hit()) pieces.back().push_back(p_W);
  }
  return pieces;
}

/// The scans of a run as lines on one side of the mesh.
std::string DrawPaths(const RunConfig& config, const RunRecord& record, const MeshRenderer& renderer,
                      const TriangleScene& mesh_W, const View& view, const Projection& projection) {
  std::string svg;
  NumberDiscs numbers;
  const auto count = static_cast<int>(record.scans.size());
  for (int k = 0; k < count; ++k) {
    const std::string color = MakeScanColor(k, count);
    PixelLine longest;
    for (const auto& piece : FindFootprint(record.scans[k].path, mesh_W, config.cell.profiler.max_depth_m)) {
      const std::vector<uint8_t> hidden = renderer.FindHidden(piece, view);
      PixelLine line;
      for (size_t i = 0; i <= piece.size(); ++i) {
        if (i < piece.size() && hidden[i] == 0) {
          line.push_back(projection.Project(piece[i]));
          continue;
        }
        svg += DrawLine(line, color, 4.0);
        if (line.size() > longest.size()) longest = line;
        line.clear();
      }
    }
    constexpr size_t kFewest = 4;
    if (longest.size() >= kFewest) numbers.Add(k + 1, longest, color);
  }
  return svg + numbers.Draw();
}

void DrawSides(const RunConfig& config, const RunRecord& record, const TriangleMesh& mesh_W, RunPictures& pictures) {
  const MeshRenderer renderer(mesh_W);
  const TriangleScene scene_W(mesh_W);
  View view;
  view.mark_borders = true;
  view.frame_W = scene_W.box_W();
  for (int side = 0; side < 4; ++side) {
    view.azimuth_rad = side * 0.5 * std::numbers::pi;
    pictures.sides.push_back(Encode(kSides[side], renderer.Render(view)));
    ReportPicture paths = pictures.sides.back();
    paths.overlay = DrawPaths(config, record, renderer, scene_W, view, Projection(view, scene_W.box_W()));
    pictures.paths.push_back(std::move(paths));
  }
}

Picture DrawVoxels(const VoxelGrid& voxels, bool cut) {
  const GridShape& grid = voxels.shape();
  const int first_y = cut ? grid.size.y() / 2 : 0;
  const auto is_before_cut = [&](int64_t cell) { return cell / grid.size.x() % grid.size.y() < first_y; };
  Drawing drawing;
  drawing.Add(MakeVoxelMesh(grid,
                            [&](int64_t cell) {
                              return !is_before_cut(cell) && IsOccupied(voxels.cells()[static_cast<size_t>(cell)]);
                            }),
              kOccupied);
  if (cut) {
    drawing.Add(MakeVoxelMesh(grid,
                              [&](int64_t cell) {
                                return !is_before_cut(cell) && voxels.cells()[static_cast<size_t>(cell)] == kUnobserved;
                              }),
                kUnknown);
  }
  View view;
  view.width = 600;
  view.height = 640;
  view.tight = true;
  view.azimuth_rad = -0.35;
  view.elevation_rad = 0.3;
  view.frame_W = Eigen::AlignedBox3d(grid.origin_W, grid.origin_W + grid.resolution_m * grid.size.cast<double>());
  return MeshRenderer(drawing.mesh_W(), drawing.surface()).Render(view);
}

}  // namespace

RunPictures DrawRun(const RunConfig& config, const RunRecord& record, const TriangleMesh& model_W,
                    const VoxelGrid& voxels, const RunTraces& traces) {
  RunPictures pictures;
  pictures.voxels.push_back(Encode("occupied", DrawVoxels(voxels, false)));
  pictures.voxels.push_back(
      Encode("cut open: occupied (orange), unknown (violet); the rest is free", DrawVoxels(voxels, true)));
  if (model_W.triangles.empty()) return pictures;
  DrawSides(config, record, model_W, pictures);
  pictures.scans = DrawScans(config, record, traces);
  return pictures;
}

}  // namespace nbs
