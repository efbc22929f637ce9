#include "services/reporter/outputs.h"

#include <chrono>
#include <fstream>
#include <stdexcept>

#include "common/geometry/mesh_io.h"
#include "common/mapping/octomap_exchange.h"
#include "common/runtime/error.h"
#include "services/reporter/report_html.h"
#include "services/reporter/report_json.h"
#include "services/reporter/run_pictures.h"

namespace nbs {
namespace {

namespace fs = std::filesystem;

void WriteText(const fs::path& file, const std::string& text) {
  fs::path temporary = file;
  temporary += ".tmp";
  std::ofstream out(temporary, std::ios::binary);
  out << text;
  out.close();
  if (!out) {
    fs::remove(temporary);
    throw ConfigError(file.string() + ": cannot be written: is the disk full, or the folder read-only?");
  }
  fs::rename(temporary, file);
}

/// From the resolved configuration, the first file of a run, to the last message on a stream.
double CalcWallTime(const fs::path& run_folder) {
  fs::file_time_type last = fs::last_write_time(run_folder / "run.yaml");
  const fs::file_time_type start = last;
  for (const fs::directory_entry& entry : fs::directory_iterator(run_folder / "streams")) {
    if (entry.is_regular_file()) last = std::max(last, entry.last_write_time());
  }
  return std::chrono::duration<double>(last - start).count();
}

}  // namespace

void WriteModel(const MeshReplica& mesh, const fs::path& file) {
  std::vector<VertexProperty> extra = {
      {"sigma_m", {}}, {"best_incidence_rad", {}}, {"measurements", {}}, {"first_scan", {}}, {"last_scan", {}}};
  for (uint32_t slot : mesh.FindUsedVertices()) {
    const MeshVertex& vertex = mesh.vertices()[slot];
    extra[0].values.push_back(vertex.sigma_m);
    extra[1].values.push_back(vertex.best_incidence_rad);
    extra[2].values.push_back(vertex.measurements);
    extra[3].values.push_back(vertex.first_scan);
    extra[4].values.push_back(vertex.last_scan);
  }
  WriteMeshPly(file, mesh.MakeCompactMesh(), extra);
}

void WriteOutputs(const RunConfig& config, const ReporterNode& reporter,
                  const std::optional<RegisteredModel>& registered, const Findings& findings, const RunTraces& traces) {
  const double wall_s = CalcWallTime(config.folder);
  const MeshReplica& model = registered ? registered->mesh : reporter.mesh();
  WriteModel(model, config.folder / "model.ply");
  if (registered) WriteModel(reporter.mesh(), config.folder / "model_as_streamed.ply");
  WriteOctomap(reporter.voxels(), config.folder / "voxels.ot");
  WriteText(config.folder / "report.json", MakeReportJson(config, reporter.record(), findings, wall_s));
  const RunPictures pictures = DrawRun(config, reporter.record(), model.MakeCompactMesh(), reporter.voxels(), traces);
  WriteText(config.folder / "report.html", MakeReportHtml(config, reporter.record(), findings, wall_s, pictures));
}

}  // namespace nbs
