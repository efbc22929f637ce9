#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/mesh_delta.h"
#include "common/mapping/voxel_grid.h"
#include "common/planning/scan_path.h"
#include "common/sensing/profiler.h"

namespace nbs {

/// A piece of the surface that nobody has seen yet but that must be there, because the surface of a body is closed.
struct SurfaceElement {
  Eigen::Vector3f p_W = Eigen::Vector3f::Zero();        ///< Middle, metres.
  Eigen::Vector3f normal_W = Eigen::Vector3f::UnitZ();  ///< Unit, outward.
  float area_m2 = 0.0f;
  uint32_t block = 0;  ///< Block of the prediction in which it lies.
};

struct SurfacePredictionSettings {
  double block_m = 0.005;  ///< Edge of a block, rounded to whole voxels.
  double depth_m = 0.012;  ///< So far behind a measured point is inside of the object.
  double free_max_probability = kFreeProbability;
  int iterations = 40;          ///< Sweeps of the relaxation a round; the next round goes on where it ended.
  double relaxation = 1.85;     ///< Over-relaxation, in (0, 2).
  double look_weight = 1.0;     ///< Pull to free of a scan that looked through a block in vain; each neighbour has 1.
  int max_looks = 5;            ///< More scans than this pull no harder.
  double rim_width_m = 0.008;   ///< Of the strip of elements along the border of the mesh.
  double max_rim_share = 0.20;  ///< Elements of the strip in one block come to at most this share of a block's face.
  double missed_factor = 0.1;  ///< What is left of the trust in an element when a scan should have seen it and did not:
  double missed_elsewhere = 0.8;  ///< looked at from there again, and from a side at right angles to it.
};

/// The unseen surface, foretold from what is known: a potential that is 1 behind every measured point, -1 in known free
/// space and outside of the grid, 0 on measured surface, and harmonic in between. Its zero crossing in the unknown is
/// the predicted surface: it continues the measured one smoothly and closes it (volumetric diffusion, after Davis,
/// Marschner, Garr & Levoy, "Filling holes in complex surfaces using volumetric diffusion", 3DPVT 2002, DOI
/// 10.1109/TDPVT.2002.1024098). A strip along the border of the mesh, where the surface goes on for certain, stands for
/// what is finer than a block. The prediction serves to choose where to look, never as a surface, and frees nothing.
///
/// A scan whose beams pass a block and bring nothing back does not prove it free, but speaks for air: it pulls the
/// potential to -1, and elements that it should have seen are trusted less, most of all when looked at from there
/// again: what a fold hides from one side may be open to another.
class SurfacePrediction {
 public:
  /// @param shape  Of the voxel space.
  /// @throws std::invalid_argument if a setting is out of range.
  explicit SurfacePrediction(const GridShape& shape, const SurfacePredictionSettings& settings = {});

  /// Notes what a scan looked at in vain; to be called after its voxels are in the grid and before the next Update.
  void AddScan(const VoxelGrid& grid, const Profiler& profiler, const ScanPath& path);

  /// Foretells the surface anew from the voxel space and the mesh as they are now.
  ///
  /// @param threads  >= 1; they change nothing.
  void Update(const VoxelGrid& grid, const MeshReplica& mesh, int threads = 1);

  /// Predicted blocks in index order, then the border's edges in the order of FindBorderEdges.
  std::span<const SurfaceElement> elements() const { return elements_; }
  /// Share of an element's area that a look at it may hope for, after the looks in vain at its block, 0 to 1.
  ///
  /// @param beam_W  From the sensor to the element, of any length but 0.
  float CalcTrust(const SurfaceElement& element, const Eigen::Vector3f& beam_W) const;
  /// Room around a block: 0 for what ends a line of sight (measured surface, and the predicted inside), otherwise the
  /// number of steps between neighbours, corners included, to the nearest such block, at most kMaxRoom; by block index.
  std::span<const uint8_t> room() const { return room_; }
  static constexpr uint8_t kMaxRoom = 30;
  /// By block index, -1 (free) to 1 (inside).
  std::span<const float> potential() const { return potential_; }
  /// Of the blocks: the voxel space and one layer around it.
  const GridShape& shape() const { return shape_; }

 private:
  void FixKnown(const VoxelGrid& grid, const MeshReplica& mesh);
  void Relax(int threads);
  void MeasureRoom();
  void FindElements();
  void AddRim(const MeshReplica& mesh);
  bool IsNearSurface(int64_t block) const;
  int64_t FindBlock(int64_t cell, const GridShape& cells) const;

  SurfacePredictionSettings settings_;
  int cells_per_block_;
  GridShape shape_;
  std::array<int64_t, 3> stride_;  ///< Of a block's neighbours.
  std::vector<float> potential_;
  std::vector<uint8_t> fixed_;     ///< The potential is known.
  std::vector<uint8_t> occupied_;  ///< Holds an occupied voxel.
  std::vector<uint8_t> room_;
  std::vector<uint8_t> looks_;  ///< Scans that looked through a block in vain.
  /// By block: unit directions of the scans that should have seen an element in it.
  std::vector<std::vector<Eigen::Vector3f>> missed_along_W_;
  std::vector<SurfaceElement> elements_;
};

}  // namespace nbs
