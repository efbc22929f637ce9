#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "services/mesher/ridge_evidence.h"
#include "services/mesher/roof.h"
#include "services/mesher/star_triangulation.h"
#include "services/mesher/vertex_store.h"

namespace nbs {

struct RidgeSettings {
  float ridge_curvature_per_m = 200.0f;  ///< Where the fitted surface bends more than this there may be a ridge,
  float flat_curvature_per_m = 60.0f;    ///< between parts that bend less than this.
  /// The fitted surface, which is rounded over R_n, lies below the roof by no more than this at a sharp ridge,
  float most_rounding_m = 0.0007f;
  float most_corner_rounding_m = 0.0012f;  ///< and this near a corner;
  float most_height_m = 0.0003f;           ///< nor does it lie further above the roof than this.
  float reach_m = 0.003f;                  ///< A ridge further from a vertex than this does not concern it.
  float snap_m = 0.0012f;                  ///< A vertex this near to a ridge moves onto it,
  float corner_snap_m = 0.0018f;           ///< or onto a corner.
  float spacing_m = 0.0011f;               ///< Between the vertices on a ridge.
  float least_spacing_m =
      0.0006f;             ///< The same for a vertex that is nearer to the ridge than this: it has no place beside it.
  float room_m = 0.0008f;  ///< Between a vertex that is founded on a ridge and any off it.
  /// None is founded with another so deep below it and no further aside: given up again, both would lie at one place.
  float depth_m = 0.002f;
  float aside_m = 0.0003f;
  float step_m = 0.0008f;  ///< Along a ridge, between the places where one may be founded.
  RoofSettings roof;
  RidgeEvidenceSettings evidence;
};

/// Puts vertices onto sharp ridges and corners that stand out; the fit rounds them off and triangles cut them off.
///
/// Where smooth parts of the surface, extended as planes, meet, and fitted surface and measurements lie where the
/// sharp ridge would be, the nearest vertices move onto it, others are founded on it at intervals, and the rest beside
/// it move onto the planes. A ridge is the set of points with the least distance from the tangent planes around (after
/// Kobbelt, Botsch, Schwanecke, Seidel, "Feature Sensitive Surface Extraction from Volume Data", SIGGRAPH 2001, DOI
/// 10.1145/383259.383265).
class RidgeSharpener {
 public:
  /// A vertex and where it was on a ridge.
  struct Place {
    uint32_t id = 0;
    Tangent tangent;
  };

  /// Ascending numbers of the vertices that were moved, and of those that were founded.
  struct Changes {
    std::vector<uint32_t> moved, founded;
  };

  /// For one call of Sharpen; all must outlive it.
  RidgeSharpener(const MeasurementMap& measurements, const StarTriangulation& triangulation,
                 const RidgeSettings& settings, VertexStore& vertices)
      : triangulation_(triangulation),
        settings_(settings),
        vertices_(vertices),
        evidence_(measurements, settings.evidence) {}

  /// @param due     Ascending numbers of real vertices, each on the fitted surface.
  /// @param before  Those of them that were on a ridge (Ridge::kLoose) go back to their places if no new place is found
  /// for them and nothing speaks against the ridge.
  Changes Sharpen(std::span<const uint32_t> due, std::span<const Place> before);

 private:
  /// A vertex near a ridge.
  struct Candidate {
    uint32_t id;
    Roof roof;
    bool placed;
  };
  /// Where a candidate may move or found a vertex.
  struct Proposal {
    float distance_m;
    size_t candidate;
    Roof::Feature feature;
  };

  void FindCandidates(std::span<const uint32_t> ids);
  void CollectTangents(const Eigen::Vector3f& p_W);
  bool IsRidge(const Roof& roof, const Vertex& v);
  std::vector<uint32_t> FindNeighbours(std::span<const uint32_t> due) const;
  std::vector<Proposal> ProposeCorners() const;
  std::vector<Proposal> ProposeFeet() const;
  static std::vector<Proposal> SortByDistance(std::vector<Proposal> proposals);
  void FillCorners(const std::vector<Proposal>& proposals);
  void FillRidges(const std::vector<Proposal>& proposals);
  void PutBack(std::span<const Place> before);
  void Flatten();
  uint32_t FindNearest(const Tangent& t, float radius_m) const;
  bool HasRoom(const Proposal& proposal, bool moves) const;
  void MoveTo(uint32_t id, const Tangent& t, Vertex::Ridge ridge);
  uint32_t Found(uint32_t beside, const Tangent& t);

  const StarTriangulation& triangulation_;
  const RidgeSettings& settings_;
  VertexStore& vertices_;
  RidgeEvidence evidence_;
  std::vector<Candidate> candidates_;
  std::vector<Tangent> tangents_;
  std::vector<uint32_t> refuted_;
  Changes changes_;
};

}  // namespace nbs
