#pragma once

#include <filesystem>

#include "common/config/run_config.h"
#include "services/reporter/registered_model.h"
#include "services/reporter/run_traces.h"

namespace nbs {

/// Writes a run's results into its folder: model.ply, voxels.ot, report.json and report.html. Each file appears whole
/// or not at all; what was there before is replaced. With a registered model that one is model.ply, and the one that
/// was streamed model_as_streamed.ply.
///
/// @throws ConfigError, std::runtime_error in one sentence if a file cannot be written.
void WriteOutputs(const RunConfig& config, const ReporterNode& reporter,
                  const std::optional<RegisteredModel>& registered, const Findings& findings, const RunTraces& traces);

/// The mesh as model.ply holds it, with the properties of its vertices.
void WriteModel(const MeshReplica& mesh, const std::filesystem::path& file);

}  // namespace nbs
