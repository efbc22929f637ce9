#include "common/config/run_config.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

#include "common/config/cell_config.h"
#include "common/config/suggestion.h"
#include "common/planning/method.h"
#include "common/runtime/error.h"

namespace nbs {
namespace {

constexpr int kMaxCellsPerAxis = 1 << 20;

GridShape ReadGrid(const StrictReader& run, double resolution_m) {
  const YamlTree* tree = run.Find("grid");
  if (!tree) run.Fail("grid", "`grid` must not be empty");
  const StrictReader reader = run.Inner(*tree, {"origin_m", "resolution_m", "size"}, StrictReader::Missing::kIsAnError);
  GridShape grid;
  reader.Read("origin_m", grid.origin_W);
  reader.Read("resolution_m", grid.resolution_m, {.min = 0.0, .above_min = true});
  reader.Read("size", grid.size, 1, kMaxCellsPerAxis);
  if (grid.resolution_m != resolution_m) {
    reader.Fail("resolution_m", "`resolution_m` of the grid (" + FormatNumber(grid.resolution_m) +
                                    ") must be that of the cell (" + FormatNumber(resolution_m) + ")");
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = grid.origin_W[axis] / grid.resolution_m;
    if (std::abs(cells - std::round(cells)) > 1e-6)
      reader.Fail("origin_m", "`origin_m` must be a multiple of `resolution_m` on each axis");
  }
  if (static_cast<int64_t>(grid.size.x()) * grid.size.y() > kMaxGridCells || grid.cells() > kMaxGridCells) {
    reader.Fail("size", "`size` must not come to more than " + std::to_string(kMaxGridCells) + " voxels");
  }
  return grid;
}

ScanPath ReadPath(const StrictReader& run) {
  const YamlTree* tree = run.Find("first_path");
  if (!tree) run.Fail("first_path", "`first_path` must not be empty");
  const StrictReader reader = run.Inner(*tree, {"start_X_WS", "end_X_WS"}, StrictReader::Missing::kIsAnError);
  ScanPath path;
  reader.Read("start_X_WS", path.X_WS_start);
  reader.Read("end_X_WS", path.X_WS_end);
  return path;
}

std::string FormatSize(const Eigen::Vector3i& size) {
  std::string text;
  for (int i = 0; i < 3; ++i) text.append(i == 0 ? "[" : ", ").append(std::to_string(size[i]));
  return text.append("]");
}

std::string FormatRun(const RunConfig& config) {
  std::string text = "# One run with everything resolved. Written at its start; every service reads it.\n";
  const auto add = [&](const std::string& key, const std::string& value) {
    text.append(key).append(": ").append(value).append("\n");
  };
  add("name", QuoteYaml(config.name));
  add("run_id", std::to_string(config.run_id));
  add("version", QuoteYaml(config.version));
  add("method", QuoteYaml(config.method));
  add("gain", QuoteYaml(config.gain));
  add("object", QuoteYaml(config.object));
  add("object_file", QuoteYaml(config.object_file.string()));
  add("seed", std::to_string(config.seed));
  add("completeness", FormatNumber(config.completeness));
  add("max_scans", std::to_string(config.max_scans));
  add("rate", config.realtime ? "realtime" : "max");
  CellConfig cell = config.cell;
  // A run folder that holds the arm's URDF may be moved.
  if (cell.arm) cell.arm->urdf = cell.arm->urdf.lexically_proximate(std::filesystem::absolute(config.folder));
  text += "cell:\n" + FormatCell(cell, "  ");
  text += "grid:\n";
  add("  origin_m", FormatVector(config.grid.origin_W));
  add("  resolution_m", FormatNumber(config.grid.resolution_m));
  add("  size", FormatSize(config.grid.size));
  add("object_origin_m", FormatVector(config.p_WO));
  text += "first_path:\n";
  add("  start_X_WS", FormatPose(config.first_path.X_WS_start));
  add("  end_X_WS", FormatPose(config.first_path.X_WS_end));
  return text;
}

}  // namespace

RunConfig ReadRunConfig(const std::filesystem::path& folder) {
  static constexpr std::array<std::string_view, 2> kRates = {"max", "realtime"};
  const std::filesystem::path file = folder / "run.yaml";
  const YamlTree tree = ReadYamlTree(file);
  const StrictReader reader(file, tree,
                            {"name", "run_id", "version", "method", "gain", "object", "object_file", "seed",
                             "completeness", "max_scans", "rate", "cell", "grid", "object_origin_m", "first_path"},
                            StrictReader::Missing::kIsAnError);
  RunConfig config;
  config.folder = folder;
  reader.Read("name", config.name);
  reader.Read("run_id", config.run_id);
  reader.Read("version", config.version);
  reader.ReadChoice("method", "method", MethodNames(), config.method);
  reader.ReadChoice("gain", "gain rule", GainRuleNames(), config.gain);
  reader.Read("object", config.object);
  std::string object_file;
  reader.Read("object_file", object_file);
  config.object_file = object_file;
  reader.Read("seed", config.seed);
  reader.Read("completeness", config.completeness, {.min = 0.0, .max = 1.0, .above_min = true});
  reader.Read("max_scans", config.max_scans, 1, kMaxScans);
  std::string rate = "max";
  reader.ReadChoice("rate", "rate", kRates, rate);
  config.realtime = rate == "realtime";
  const YamlTree* cell = reader.Find("cell");
  if (!cell) reader.Fail("cell", "`cell` must not be empty");
  config.cell = ReadCell(file, *cell, StrictReader::Missing::kIsAnError);
  config.grid = ReadGrid(reader, config.cell.resolution_m);
  reader.Read("object_origin_m", config.p_WO);
  config.first_path = ReadPath(reader);
  return config;
}

void WriteRunConfig(const RunConfig& config) {
  const std::filesystem::path file = config.folder / "run.yaml";
  const std::filesystem::path temporary = config.folder / "run.yaml.tmp";
  std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
  stream << FormatRun(config);
  stream.close();
  if (!stream) throw ConfigError(file.string() + ": cannot be written: " + std::strerror(errno));
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (error) throw ConfigError(file.string() + ": cannot be written: " + error.message());
}

}  // namespace nbs
