#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "common/geometry/mesh_delta.h"
#include "common/sensing/profiler.h"
#include "services/mesher/lag_queue.h"
#include "services/mesher/measurement_map.h"
#include "services/mesher/ridge_sharpener.h"
#include "services/mesher/star_triangulation.h"
#include "services/mesher/surface_fit.h"
#include "services/mesher/vertex_store.h"

namespace nbs {

struct StreamingMesherSettings {
  /// R_d: a measurement nearer to a vertex than this refines it, others found new ones. The mean edge comes to
  /// about 1.35 R_d.
  float spacing_m = 0.0023f;
  /// Vertices of one sheet are never founded nearer to each other than this share of R_d.
  float least_spacing_share = 0.65f;
  float cell_m = 0.002f;  ///< Of the measurement map.
  /// A measurement refines only vertices whose normal makes an angle with its beam that has at least this cosine.
  float least_view_cosine = 0.25f;
  /// A vertex is founded on samples seen within the angle of this cosine from its own view: less than twice the
  /// complement of the largest incidence, so that both sides of a thin plate never count together.
  float founding_cosine = 0.8f;
  /// A vertex is refined by samples whose views make an angle with its normal that has at least this cosine.
  float sample_cosine = 0.15f;
  /// A vertex is founded where at least this share of the weight of its surface lies within R_n / 2.
  float least_near_share = 0.25f;
  /// A surface seen only more obliquely than this is no surface, but points in the air at a depth edge.
  float max_incidence_rad = 1.40f;
  /// A vertex is fitted when the sensor has moved on by this since the first measurement near it, so that its
  /// surroundings are measured by then; its star is made when it has moved on by this again, so that those of its
  /// neighbours are fitted by then. A sensor that stands still is waited for no longer than lag_stripes.
  double fit_lag_m = 0.010;
  double star_lag_m = 0.008;
  int64_t lag_stripes = 25;
  /// Measurements that founded nothing by the end of their scan, and have no surface within R_n so many stripes later,
  /// are forgotten.
  int64_t forget_stripes = 2000;
  float refit_share = 0.1f;       ///< A surface is fitted again when this share of its support has come near since.
  float star_moved_m = 0.0001f;   ///< Stars are made anew when a vertex moved further than this,
  float star_turned_rad = 0.05f;  ///< or turned further than this.
  float moved_noticeably_m =
      0.00005f;  ///< Before the end of the scan vertices are published anew only when moved further.
  SurfaceFitSettings fit;
  RidgeSettings ridges;
  TriangulationSettings triangulation;
};

/// Counts over the life of the mesher.
struct MesherCounts {
  int64_t refused_stripes = 0;       ///< Pose not rigid, wrong number of ranges, twice, or of an unknown scan.
  int64_t refused_measurements = 0;  ///< Not finite, negative, or further than twice the depth of field.
};

/// Folds laser stripes into one growing triangle mesh (after Bodenmüller, "Streaming Surface Reconstruction from Real
/// Time 3D Measurements", TU München 2009): density limit, normals, vertex selection, localised triangulation. What is
/// not seen stays open.
///
/// Measurements are summed up in a MeasurementMap. A measurement that has no vertex within R_d founds a pending one;
/// vertices with enough support get a fitted surface, move onto it and become real; StarTriangulation joins them. Fits
/// and triangles follow the sensor at a distance (fit_lag_m, star_lag_m), so that each stripe brings about the same
/// work, and are brought up to date at the end of a scan, when vertices also move onto sharp ridges (RidgeSharpener).
/// The mesh is a function of the stripes, wherever deltas are taken between them.
class StreamingMesher {
 public:
  StreamingMesher(const Profiler& profiler, const StreamingMesherSettings& settings);

  /// Folds one stripe in. A closing stripe ends the scan (its pose does not matter): points that found no support are
  /// forgotten.
  ///
  /// Refuses, and counts, a stripe whose pose is not rigid or further than 500 m off, that has not one range a beam,
  /// that does not come after the stripe before it, or whose scan is more than 16 ahead of it; and single ranges that
  /// are not finite, negative or beyond twice the depth of field. A range of 0 is no return.
  ///
  /// @returns False if the stripe was refused as a whole.
  bool AddStripe(const Stripe& stripe);

  /// Brings fits and triangles up to date with all stripes so far, without waiting for the sensor to move on.
  void Update();

  /// What changed since the last delta. After a closing stripe the delta has end_of_scan set and holds everything;
  /// before, what the lags and refinements too small to notice hold back comes later.
  MeshDelta TakeDelta();

  /// Figures of the mesh after the last update and of the scan so far.
  MeshScan CalcScanFigures();

  const MesherCounts& counts() const { return counts_; }
  const VertexStore& vertices() const { return vertices_; }
  const MeshTopology& topology() const { return triangulation_.topology(); }

 private:
  bool IsAcceptable(const Stripe& stripe) const;
  void BeginScan(int32_t scan);
  void EndScan();
  void ForgetUnsupported();
  void AddRanges(const Stripe& stripe);
  void AddMeasurement(const Measurement& m);
  void Refine(uint32_t id, const Measurement& m);
  void MarkForFit(uint32_t id);
  void MarkForStar(uint32_t id);
  void MarkStarsAround(uint32_t id);
  void MarkStarsNear(const Eigen::Vector3f& p_W);
  void MarkForPublishing(uint32_t id);
  void Advance();
  void FitDueVertices();
  void FitPending(uint32_t id);
  void FitReal(uint32_t id);
  bool Refit(uint32_t id);
  void SetSurface(uint32_t id, const SurfaceFit& fit);
  void MarkIfMoved(uint32_t id);
  void SharpenRidges();
  std::vector<RidgeSharpener::Place> Loosen(std::span<const uint32_t> ids);
  bool HasRoomFor(uint32_t id, const SurfaceFit& fit) const;
  void TriangulateDueVertices();
  double CalcRimLength();
  void CollectVertices(MeshDelta& delta);

  Profiler profiler_;
  StreamingMesherSettings settings_;
  std::vector<Eigen::Vector3f> directions_S_;
  MeasurementMap measurements_;
  VertexStore vertices_;
  StarTriangulation triangulation_;
  MesherCounts counts_;
  MeshScan scan_;  // utime, scan, stripes and points are kept; the rest is filled in on demand.
  int32_t last_index_ = -1;
  bool scan_ended_ = true;
  bool scan_begun_ = false;
  LagQueue fit_queue_, star_queue_;
  std::vector<uint32_t> due_;  // Taken out of a queue.
  std::vector<uint32_t> pending_, publish_due_;
  std::vector<uint32_t> ridge_due_;  // Fitted since the last scan ended, and perhaps near a ridge.
  int64_t real_vertices_ = 0;
  /// Where measurements founded nothing, and when.
  struct Unsupported {
    Eigen::Vector3f p_W;
    int64_t stripes;
  };
  std::deque<Unsupported> unsupported_;
  Eigen::Vector3d last_p_WS_ = Eigen::Vector3d::Zero();
  LagQueue::Moment now_;
  std::vector<Sample> samples_;
};

}  // namespace nbs
