#include "services/planner/surface_prediction.h"

#include <algorithm>
#include <barrier>
#include <cmath>
#include <map>
#include <stdexcept>

#include "common/geometry/borders.h"
#include "common/mapping/ray_walk.h"
#include "common/runtime/parallel.h"
#include "services/planner/information_gain.h"
#include "services/planner/surface_view.h"

namespace nbs {
namespace {

constexpr uint8_t kMaxCount = 200;

/// The blocks of a voxel space, with a layer of blocks around it that is known to be free.
GridShape MakeBlocks(const GridShape& cells, int cells_per_block) {
  GridShape blocks;
  blocks.resolution_m = cells.resolution_m * cells_per_block;
  blocks.origin_W = cells.origin_W - Eigen::Vector3d::Constant(blocks.resolution_m);
  for (int axis = 0; axis < 3; ++axis)
    blocks.size[axis] = (cells.size[axis] + cells_per_block - 1) / cells_per_block + 2;
  return blocks;
}

/// Calls `visit(index)` for every block that is not in the outermost layer.
template <typename Visit>
void VisitInner(const GridShape& shape, Visit&& visit) {
  for (int z = 1; z + 1 < shape.size.z(); ++z) {
    for (int y = 1; y + 1 < shape.size.y(); ++y) {
      const int64_t first = shape.Index(1, y, z);
      for (int64_t block = first; block < first + shape.size.x() - 2; ++block) visit(block);
    }
  }
}

/// The same from the last to the first.
template <typename Visit>
void VisitInnerBackward(const GridShape& shape, Visit&& visit) {
  for (int z = shape.size.z() - 2; z > 0; --z) {
    for (int y = shape.size.y() - 2; y > 0; --y) {
      const int64_t first = shape.Index(1, y, z);
      for (int64_t block = first + shape.size.x() - 3; block >= first; --block) visit(block);
    }
  }
}

/// Calls `visit(from, to)` for a ninth of a scan's beams, between the nearest and the largest depth.
template <typename Visit>
void VisitBeams(const Profiler& profiler, const ScanPath& path, Visit&& visit) {
  constexpr int kStep = 3;
  const std::vector<Eigen::Vector3d> directions_S = CalcBeamDirections_S(profiler);
  const double spacing_m = profiler.scan_speed_m_per_s / profiler.rate_hz;
  const int stripes = InformationGain(profiler).CountStripes(path);
  for (int stripe = kStep / 2; stripe < stripes; stripe += kStep) {
    const Pose X_WS = CalcStripePose(path, spacing_m, stripe);
    for (size_t beam = kStep / 2; beam < directions_S.size(); beam += kStep) {
      const Eigen::Vector3d per_depth_W = X_WS.linear() * directions_S[beam] / directions_S[beam].z();
      visit(X_WS.translation() + per_depth_W * profiler.min_depth_m,
            X_WS.translation() + per_depth_W * profiler.max_depth_m);
    }
  }
}

void CheckSettings(const SurfacePredictionSettings& s) {
  const bool sound = s.block_m > 0.0 && s.depth_m > 0.0 && s.free_max_probability > 0.0 &&
                     s.free_max_probability < 0.95 && s.iterations >= 1 && s.relaxation > 0.0 && s.relaxation < 2.0 &&
                     s.look_weight >= 0.0 && s.max_looks >= 0 && s.rim_width_m > 0.0 && s.max_rim_share > 0.0 &&
                     s.missed_factor >= 0.0 && s.missed_factor <= 1.0 && s.missed_elsewhere >= 0.0 &&
                     s.missed_elsewhere <= 1.0;
  if (!sound) throw std::invalid_argument("SurfacePrediction: a setting is out of range");
}

}  // namespace

SurfacePrediction::SurfacePrediction(const GridShape& shape, const SurfacePredictionSettings& settings)
    : settings_(settings),
      cells_per_block_(std::max(1, static_cast<int>(std::lround(settings.block_m / shape.resolution_m)))),
      shape_(MakeBlocks(shape, cells_per_block_)) {
  CheckSettings(settings);
  stride_ = {1, shape_.size.x(), int64_t{shape_.size.x()} * shape_.size.y()};
  potential_.assign(shape_.cells(), -1.0f);
  fixed_.assign(shape_.cells(), 1);
  occupied_.assign(shape_.cells(), 0);
  room_.assign(shape_.cells(), kMaxRoom);
  looks_.assign(shape_.cells(), 0);
  missed_along_W_.resize(shape_.cells());
}

int64_t SurfacePrediction::FindBlock(int64_t cell, const GridShape& cells) const {
  const int64_t row = cell / cells.size.x();
  const int n = cells_per_block_;
  return shape_.Index(static_cast<int>(cell % cells.size.x()) / n + 1, static_cast<int>(row % cells.size.y()) / n + 1,
                      static_cast<int>(row / cells.size.y()) / n + 1);
}

void SurfacePrediction::AddScan(const VoxelGrid& grid, const Profiler& profiler, const ScanPath& path) {
  std::map<uint32_t, Eigen::Vector3f> due;  // By block: in which direction the scan should have seen its elements.
  for (const Sighting& sighting : SurfaceView(profiler).FindSeen(*this, path))
    due.try_emplace(elements_[sighting.element].block, Eigen::Vector3f::Zero()).first->second +=
        sighting.beam_W.normalized();
  for (const auto& [block, along_W] : due) missed_along_W_[block].push_back(along_W.normalized());

  std::vector<uint8_t> looked(shape_.cells(), 0);
  VisitBeams(profiler, path, [&](const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W) {
    WalkRay(MakeRayWalk(grid.shape(), from_W, to_W), [&](int64_t cell) {
      const int16_t log_odds = grid.cells()[cell];
      if (log_odds == kUnobserved) looked[FindBlock(cell, grid.shape())] = 1;
      return !IsOccupied(log_odds);
    });
  });
  for (int64_t block = 0; block < shape_.cells(); ++block)
    looks_[block] = std::min<uint8_t>(kMaxCount, looks_[block] + looked[block]);
}

void SurfacePrediction::Update(const VoxelGrid& grid, const MeshReplica& mesh, int threads) {
  FixKnown(grid, mesh);
  Relax(threads);
  MeasureRoom();
  elements_.clear();
  FindElements();
  AddRim(mesh);
}

void SurfacePrediction::FixKnown(const VoxelGrid& grid, const MeshReplica& mesh) {
  const int16_t free_log_odds = CalcLogOdds(settings_.free_max_probability);
  std::vector<uint8_t> free(shape_.cells(), 0);
  std::ranges::fill(occupied_, 0);
  for (int64_t cell = 0; cell < grid.shape().cells(); ++cell) {
    const int16_t log_odds = grid.cells()[cell];
    if (log_odds == kUnobserved) continue;
    const int64_t block = FindBlock(cell, grid.shape());
    if (IsOccupied(log_odds)) occupied_[block] = 1;
    if (log_odds <= free_log_odds) free[block] = 1;
  }
  // Blocks that are still unknown keep the potential of the last round.
  VisitInner(shape_, [&](int64_t block) {
    fixed_[block] = occupied_[block] != 0 || free[block] != 0;
    if (fixed_[block] != 0) potential_[block] = occupied_[block] != 0 ? 0.0f : -1.0f;
  });
  for (const MeshVertex& vertex : mesh.vertices()) {
    if (vertex.measurements == 0) continue;
    const Eigen::Vector3f inside_W = vertex.p_W - vertex.normal_W * static_cast<float>(settings_.depth_m);
    const int64_t block = FindCell(shape_, inside_W.cast<double>());
    if (block < 0 || fixed_[block] != 0) continue;
    fixed_[block] = 1;
    potential_[block] = 1.0f;
  }
}

void SurfacePrediction::Relax(int threads) {
  struct Unknown {
    uint32_t block;
    float pull;   // Of the looks in vain.
    float share;  // Of each neighbour in the new value.
  };
  const auto omega = static_cast<float>(settings_.relaxation);
  std::vector<std::vector<Unknown>> layers(shape_.size.z());
  VisitInner(shape_, [&](int64_t block) {
    if (fixed_[block] != 0) return;
    const float pull = static_cast<float>(settings_.look_weight) *
                       static_cast<float>(std::min<int>(looks_[block], settings_.max_looks));
    layers[block / stride_[2]].push_back({static_cast<uint32_t>(block), pull, omega / (6.0f + pull)});
  });
  const auto relax_layer = [&, u = potential_.data(), x = stride_[0], y = stride_[1], z = stride_[2]](int layer) {
    for (const Unknown& here : layers[layer]) {
      const int64_t b = here.block;
      // The neighbour that has just changed comes last: the processor need not wait for it.
      const float others = u[b + x] + u[b - y] + u[b + y] + u[b - z] + u[b + z] - here.pull;
      u[b] = (u[b] - omega * u[b] + here.share * others) + here.share * u[b - x];
    }
  };
  // Layers of one parity do not touch each other: whichever thread takes them, the result is the same.
  std::barrier sweep_done(threads);
  const auto work = [&](int thread) {
    for (int half = 0; half < 2 * settings_.iterations; ++half) {
      for (int layer = half % 2 + 2 * thread; layer < shape_.size.z(); layer += 2 * threads) relax_layer(layer);
      sweep_done.arrive_and_wait();
    }
  };
  RunOnThreads(threads, work);
}

void SurfacePrediction::MeasureRoom() {
  std::vector<int64_t> before;  // The 13 neighbours that come earlier in index order.
  for (int64_t dz = -1; dz <= 0; ++dz) {
    for (int64_t dy = -1; dy <= 1; ++dy) {
      for (int64_t dx = -1; dx <= 1; ++dx) {
        const int64_t offset = dx + dy * stride_[1] + dz * stride_[2];
        if (offset < 0) before.push_back(offset);
      }
    }
  }
  // One sweep forward and one backward are exact for this metric. The outermost layer is free and far enough.
  const auto relax = [&](int64_t block, int64_t sign) {
    uint8_t& room = room_[block];
    for (const int64_t offset : before) room = std::min<uint8_t>(room, room_[block + sign * offset] + 1);
  };
  VisitInner(shape_, [&](int64_t block) {
    room_[block] = occupied_[block] != 0 || potential_[block] > 0.0f ? 0 : kMaxRoom;
    relax(block, 1);
  });
  VisitInnerBackward(shape_, [&](int64_t block) { relax(block, -1); });
}

bool SurfacePrediction::IsNearSurface(int64_t block) const {
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (occupied_[block + dx * stride_[0] + dy * stride_[1] + dz * stride_[2]] != 0) return true;
      }
    }
  }
  return false;
}

float SurfacePrediction::CalcTrust(const SurfaceElement& element, const Eigen::Vector3f& beam_W) const {
  const std::vector<Eigen::Vector3f>& missed_along_W = missed_along_W_[element.block];
  if (missed_along_W.empty()) return 1.0f;
  const auto again = static_cast<float>(settings_.missed_factor);
  const auto elsewhere = static_cast<float>(settings_.missed_elsewhere);
  const Eigen::Vector3f along_W = beam_W.normalized();
  float trust = 1.0f;
  for (const Eigen::Vector3f& missed_W : missed_along_W) {
    const float cosine = std::max(0.0f, missed_W.dot(along_W));
    const float likeness = cosine * cosine * cosine * cosine;  // A half at 33 degrees.
    trust *= again * likeness + elsewhere * (1.0f - likeness);
  }
  return trust;
}

void SurfacePrediction::FindElements() {
  const float face_m2 = static_cast<float>(shape_.resolution_m * shape_.resolution_m);
  VisitInner(shape_, [&](int64_t block) {
    if (potential_[block] <= 0.0f || occupied_[block] != 0) return;
    bool open = false;
    Eigen::Vector3f gradient;
    for (int axis = 0; axis < 3; ++axis) {
      const float below = potential_[block - stride_[axis]], above = potential_[block + stride_[axis]];
      open = open || std::min(below, above) <= 0.0f;
      gradient[axis] = above - below;
    }
    if (!open || gradient.norm() < 1e-6f || IsNearSurface(block)) return;
    const Eigen::Vector3f normal_W = -gradient.normalized();
    const int64_t row = block / shape_.size.x(), layer = row / shape_.size.y();
    const Eigen::Vector3d middle(static_cast<double>(block % shape_.size.x()) + 0.5,
                                 static_cast<double>(row % shape_.size.y()) + 0.5, static_cast<double>(layer) + 0.5);
    elements_.push_back({(shape_.origin_W + shape_.resolution_m * middle).cast<float>(), normal_W,
                         face_m2 / normal_W.cwiseAbs().maxCoeff(), static_cast<uint32_t>(block)});
  });
}

void SurfacePrediction::AddRim(const MeshReplica& mesh) {
  const auto width_m = static_cast<float>(settings_.rim_width_m);
  const size_t first = elements_.size();
  std::vector<float> strip_m2(shape_.cells(), 0.0f);
  for (const BorderEdge& edge : FindBorderEdges(mesh.triangles())) {
    const auto& corners = mesh.triangles()[edge.triangle];
    const auto corner_W = [&](int i) -> const Eigen::Vector3f& { return mesh.vertices()[corners.at(i)].p_W; };
    const Eigen::Vector3f along_W = mesh.vertices()[edge.to].p_W - mesh.vertices()[edge.from].p_W;
    const Eigen::Vector3f normal_W = (corner_W(1) - corner_W(0)).cross(corner_W(2) - corner_W(0)).normalized();
    const Eigen::Vector3f outward_W = along_W.cross(normal_W).normalized();
    const Eigen::Vector3f p_W = mesh.vertices()[edge.from].p_W + 0.5f * along_W + 0.5f * width_m * outward_W;
    const int64_t block = FindCell(shape_, p_W.cast<double>());
    if (block < 0) continue;
    elements_.push_back({p_W, normal_W, along_W.norm() * width_m, static_cast<uint32_t>(block)});
    strip_m2[block] += elements_.back().area_m2;
  }
  // A jagged border is no more surface than a straight one.
  const auto most_m2 = static_cast<float>(settings_.max_rim_share * shape_.resolution_m * shape_.resolution_m);
  for (size_t i = first; i < elements_.size(); ++i) {
    SurfaceElement& element = elements_[i];
    element.area_m2 *= std::min(1.0f, most_m2 / strip_m2[element.block]);
  }
}

}  // namespace nbs
