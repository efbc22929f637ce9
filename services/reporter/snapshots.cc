#include "services/reporter/snapshots.h"

#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "common/runtime/error.h"

namespace nbs {

Snapshots::Snapshots(std::filesystem::path folder, const Eigen::AlignedBox3d& frame_W, std::set<int> after)
    : folder_(std::move(folder)), after_(std::move(after)) {
  view_.width = 420;
  view_.height = 540;
  view_.frame_W = frame_W;
  view_.mark_borders = true;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw ConfigError("Cannot make the folder " + folder_.string() + ": " + error.message() + ".");
}

void Snapshots::Add(const TriangleMesh& mesh_W) {
  ++scans_;
  last_W_ = mesh_W;
  if (after_.contains(scans_)) Draw(mesh_W, scans_);
}

void Snapshots::Finish() {
  if (scans_ == 0) return;
  for (auto later = after_.upper_bound(scans_); later != after_.end(); ++later) Draw(last_W_, *later);
}

void Snapshots::Draw(const TriangleMesh& mesh_W, int scans) const {
  const MeshRenderer renderer(mesh_W);
  for (const auto& [name, azimuth_rad] : {std::pair{"front", 0.0}, std::pair{"back", std::numbers::pi}}) {
    View view = view_;
    view.azimuth_rad = azimuth_rad;
    WritePng(folder_ / fmt::format("after-{:02}-{}.png", scans, name), renderer.Render(view));
  }
}

}  // namespace nbs
