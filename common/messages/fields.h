#pragma once

#include <type_traits>

#include "common/messages/translate.h"
#include "common/messages/wire.h"

namespace nbs {

// The fields of every message in the order of its .lcm file, once for both directions: `Wire` is a WireWriter or a
// WireReader. The header, and with it the message's utime, is not part of the list.

/// A message to be written (const) or read.
template <typename Wire, typename T>
using Field = std::conditional_t<Wire::kReads, T&, const T&>;

template <typename Wire>
void Fields(Wire& wire, Field<Wire, MessageHeader> header) {
  wire.template Integer<int64_t>(header.run);
  wire.template Integer<int64_t>(header.seq);
  wire.template Integer<int64_t>(header.utime_us);
  wire.String(header.source);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, Pose> X_AB) {
  for (int row = 0; row < 3; ++row) wire.Double(X_AB.matrix()(row, 3));
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) wire.Double(X_AB.matrix()(row, column));
  }
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, std::vector<double>> values) {
  wire.Elements(values, wire.Count(values.size()), [&](auto& value) { wire.Double(value); });
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, std::vector<float>> values) {
  wire.Elements(values, wire.Count(values.size()), [&](auto& value) { wire.Float(value); });
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, Eigen::Vector3f> vector) {
  for (int axis = 0; axis < 3; ++axis) wire.Float(vector[axis]);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, TrajectoryPoint> point) {
  wire.template Integer<int64_t>(point.time_us);
  Fields<Wire>(wire, point.X_WF);
  Fields<Wire>(wire, point.joints_rad);
  wire.Bool(point.scanning);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, std::vector<TrajectoryPoint>> points) {
  wire.Elements(points, wire.Count(points.size()), [&](auto& point) { Fields<Wire>(wire, point); });
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, RatedCandidate> rated) {
  auto& candidate = rated.candidate;
  wire.template Integer<int32_t>(candidate.id);
  wire.Enum(candidate.source, 4);
  wire.template Integer<int32_t>(candidate.born_scan);
  wire.template Integer<int32_t>(candidate.rank);
  Fields<Wire>(wire, candidate.path.X_WS_start);
  Fields<Wire>(wire, candidate.path.X_WS_end);
  wire.Double(rated.gain_nat);
  wire.Enum(rated.verdict, kVerdicts);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, MeshVertex> vertex) {
  wire.template Integer<int32_t>(vertex.id);
  Fields<Wire>(wire, vertex.p_W);
  Fields<Wire>(wire, vertex.normal_W);
  wire.Float(vertex.sigma_m);
  wire.Float(vertex.best_incidence_rad);
  wire.template Integer<int32_t>(vertex.measurements);
  wire.template Integer<int32_t>(vertex.first_scan);
  wire.template Integer<int32_t>(vertex.last_scan);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, MeshTriangle> triangle) {
  wire.template Integer<int32_t>(triangle.id);
  for (auto& vertex : triangle.vertices) wire.template Integer<int32_t>(vertex);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, PlanRequest> request) {
  wire.template Integer<int32_t>(request.scan);
  wire.Enum(request.mode, kPlanModes);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, Trajectory> trajectory) {
  wire.template Integer<int32_t>(trajectory.scan);
  Fields<Wire>(wire, trajectory.points);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, RunState> state) {
  wire.template Integer<int32_t>(state.scan);
  wire.Enum(state.phase, 3);
  wire.Enum(state.mode, kPlanModes);
  wire.Bool(state.failed);
  wire.String(state.end_reason);
  wire.String(state.detail);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, RobotState> state) {
  wire.template Integer<int32_t>(state.scan);
  wire.Bool(state.scanning);
  wire.Bool(state.end_of_scan);
  Fields<Wire>(wire, state.X_WF);
  Fields<Wire>(wire, state.joints_rad);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, Execution> execution) {
  wire.template Integer<int32_t>(execution.scan);
  wire.Bool(execution.done);
  wire.String(execution.refusal);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, Profile> profile) {
  wire.Bool(profile.end_of_scan);
  Fields<Wire>(wire, profile.ranges_m);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, Stripe> stripe) {
  wire.template Integer<int32_t>(stripe.scan);
  wire.template Integer<int32_t>(stripe.index);
  wire.Bool(stripe.end_of_scan);
  Fields<Wire>(wire, stripe.X_WS);
  Fields<Wire>(wire, stripe.ranges_m);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, MeshDelta> delta) {
  wire.template Integer<int32_t>(delta.scan);
  wire.Bool(delta.end_of_scan);
  wire.Elements(delta.vertices, wire.Count(delta.vertices.size()), [&](auto& vertex) { Fields<Wire>(wire, vertex); });
  wire.Elements(delta.triangles, wire.Count(delta.triangles.size()),
                [&](auto& triangle) { Fields<Wire>(wire, triangle); });
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, MeshScan> scan) {
  wire.template Integer<int32_t>(scan.scan);
  wire.template Integer<int32_t>(scan.stripes);
  for (auto* count : {&scan.points, &scan.refused, &scan.vertices, &scan.triangles, &scan.edges, &scan.border_edges}) {
    wire.template Integer<int64_t>(*count);
  }
  wire.Double(scan.rim_length_m);
  wire.Double(scan.completeness);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, VoxelDelta> delta) {
  wire.template Integer<int32_t>(delta.scan);
  wire.Bool(delta.end_of_scan);
  const size_t runs = wire.Count(delta.run_start.size());
  wire.Elements(delta.run_start, runs, [&](auto& start) { wire.template Integer<int32_t>(start); });
  wire.Elements(delta.run_length, runs, [&](auto& length) { wire.template Integer<int32_t>(length); });
  wire.Elements(delta.values, wire.Count(delta.values.size()),
                [&](auto& value) { wire.template Integer<int16_t>(value); });
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, Plan> plan) {
  wire.template Integer<int32_t>(plan.scan);
  wire.Enum(plan.mode, kPlanModes);
  wire.Bool(plan.found);
  wire.Bool(plan.stack_is_empty);
  wire.String(plan.reason);
  wire.template Integer<int64_t>(plan.unknown_cells);
  Fields<Wire>(wire, plan.chosen);
  wire.template Integer<int64_t>(plan.trajectory.utime_us);
  wire.template Integer<int32_t>(plan.trajectory.scan);
  Fields<Wire>(wire, plan.trajectory.points);
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, CandidateSet> set) {
  wire.template Integer<int32_t>(set.scan);
  wire.Bool(set.end);
  wire.Elements(set.candidates, wire.Count(set.candidates.size()), [&](auto& rated) { Fields<Wire>(wire, rated); });
}

template <typename Wire>
void Fields(Wire& wire, Field<Wire, PlanTiming> timing) {
  wire.template Integer<int32_t>(timing.scan);
  for (auto* duration : {&timing.update_s, &timing.candidates_s, &timing.gain_s, &timing.motion_s, &timing.total_s})
    wire.Double(*duration);
  Fields<Wire>(wire, timing.plans_s);
}

}  // namespace nbs
