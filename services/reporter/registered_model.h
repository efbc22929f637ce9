#pragma once

#include <optional>
#include <vector>

#include "services/reporter/reporter_node.h"

namespace nbs {

/// The mesh of a run whose scans have been registered with each other after it.
struct RegisteredModel {
  MeshReplica mesh;
  Registration registration;
};

/// What nbs-remesh has left of a run.
struct RegisteredStreams {
  std::vector<MeshDelta> deltas;
  std::vector<MeshScan> figures;
  std::vector<Stripe> stripes;
};

/// Puts together what registration has made of a run; nothing if it left no figures.
///
/// @param reported   The run's stripes as reported: the registered ones are as many of them, from the first.
/// @param evaluator  Rates the mesh; empty: none.
/// @throws RunFailure if the registered stripes are not those of the run.
std::optional<RegisteredModel> MakeRegisteredModel(const RegisteredStreams& registered,
                                                   const std::vector<Stripe>& reported,
                                                   const ReporterNode::Evaluator& evaluator);

/// One line for the terminal: how far scans were moved, and what that changed from what was streamed.
std::string DescribeRegistration(const Registration& registration, const RunRecord& record);

}  // namespace nbs
