#include "sim/prepare/prepare.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <system_error>

#include "common/config/cell_arm.h"
#include "common/config/suggestion.h"
#include "common/planning/method.h"
#include "common/runtime/counter_random.h"
#include "common/runtime/error.h"
#include "sim/load_object.h"
#include "sim/mesh_measures.h"

namespace nbs {
namespace {

constexpr double kSmallest_m = 0.02;
constexpr double kLargest_m = 5.0;

/// The word, if it is one of the choices.
void CheckChoice(std::string_view what, const std::string& word, std::span<const std::string_view> choices) {
  if (std::ranges::find(choices, word) == choices.end()) throw ConfigError(ExplainUnknown(what, word, choices));
}

/// The gain rule asked for, or the method's own.
std::string ResolveGain(const RunRequest& request) {
  CheckChoice("method", request.method, MethodNames());
  const Method& method = FindMethod(request.method);
  if (request.gain.empty()) return std::string(ToString(method.gain));
  CheckChoice("gain rule", request.gain, GainRuleNames());
  if (!method.by_gain) {
    throw ConfigError("The method " + request.method + " does not rate by gain: leave --gain out, or choose B/IG.");
  }
  return request.gain;
}

void CheckNumbers(const RunRequest& request) {
  if (request.rate != "max" && request.rate != "realtime") {
    throw ConfigError("Unknown rate `" + request.rate + "`: use max or realtime.");
  }
  if (!(request.completeness > 0.0 && request.completeness <= 1.0)) {
    throw ConfigError("The completeness must lie above 0 and not above 1 (0.9875 is 98.75 %), not " +
                      std::to_string(request.completeness) + ".");
  }
  if (request.max_scans < 1 || request.max_scans > kMaxScans) {
    throw ConfigError(
        fmt::format("The number of scans must lie between 1 and {}, not {}.", kMaxScans, request.max_scans));
  }
}

void CheckFolder(const std::filesystem::path& out) {
  if (out.empty()) throw ConfigError("The run folder is missing: give --out DIR.");
  std::error_code error;
  if (!std::filesystem::exists(out, error)) return;
  if (!std::filesystem::is_directory(out, error)) throw ConfigError("The run folder " + out.string() + " is a file.");
  if (std::filesystem::exists(out / "run.yaml", error)) {
    throw ConfigError("The folder " + out.string() +
                      " holds an earlier run: choose another --out, or delete it first.");
  }
  if (!std::filesystem::is_empty(out, error) || error) {
    throw ConfigError("The folder " + out.string() + " is not empty: choose another --out.");
  }
}

std::filesystem::path FindCellFile(const RunRequest& request) {
  const std::filesystem::path as_file(request.cell);
  if (as_file.has_parent_path() || as_file.extension() == ".yaml") return as_file;
  const std::filesystem::path named = request.cells_dir / (request.cell + ".yaml");
  if (std::filesystem::exists(named)) return named;
  std::string known;
  std::error_code error;
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(request.cells_dir, error)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  throw ConfigError("There is no cell `" + request.cell + "` in " + request.cells_dir.string() +
                    (known.empty() ? "." : " (there are: " + known + ")."));
}

void CheckSize(const Eigen::AlignedBox3d& box_W, const std::string& object) {
  const double diagonal_m = box_W.diagonal().norm();
  if (diagonal_m > kLargest_m) {
    throw ConfigError("The object " + object + " is " + std::to_string(diagonal_m) +
                      " m across, which looks like millimetres: scale it by 0.001, meshes are read as metres.");
  }
  if (diagonal_m < kSmallest_m) {
    throw ConfigError("The object " + object + " is only " + std::to_string(1000.0 * diagonal_m) +
                      " mm across, too small for this sensor: scale it up if its unit is not metres.");
  }
}

/// Where the object is, and with it the voxel space: around its mesh, or the box that a real one is said to fit in.
Eigen::AlignedBox3d FindObjectBox(const RunRequest& request, const RunConfig& config) {
  if (!request.box_m) {
    const Eigen::AlignedBox3d box_W = CalcBoundingBox(LoadObject(config));
    CheckSize(box_W, request.object);
    return box_W;
  }
  const Eigen::Vector3d sizes_m(request.box_m->data());
  if (!(sizes_m.minCoeff() > 0.0)) {
    throw ConfigError(fmt::format("The sizes of the box must all be above 0, not {}, {} and {} m.", sizes_m.x(),
                                  sizes_m.y(), sizes_m.z()));
  }
  const Eigen::Vector3d half_m(sizes_m.x() / 2.0, sizes_m.y() / 2.0, 0.0);
  const Eigen::AlignedBox3d box_W(-half_m, half_m + sizes_m.z() * Eigen::Vector3d::UnitZ());
  CheckSize(box_W, "in its box");
  return box_W;
}

/// What all services together hold for a voxel (measured: services/voxelmap/README.md).
constexpr int64_t kBytesPerVoxel = 60;

void CheckMemory(const GridShape& grid, int64_t memory_bytes) {
  const int64_t needed_bytes = kBytesPerVoxel * grid.cells();
  if (needed_bytes <= memory_bytes) return;
  throw ConfigError(
      fmt::format("{} voxels of {} m around the object would take {:.1f} GB, and this machine has {:.1f} "
                  "GB: choose a larger `resolution_m` in the cell.",
                  grid.cells(), grid.resolution_m, 1e-9 * static_cast<double>(needed_bytes),
                  1e-9 * static_cast<double>(memory_bytes)));
}

/// Different for every run; separates runs on one bus and reaches no result.
int64_t MakeRunId(const std::string& name) {
  std::random_device device;
  uint64_t id = (static_cast<uint64_t>(device()) << 32) ^ device();
  for (const char c : name) id = CalcRandomBits({id, static_cast<uint64_t>(c)});
  return static_cast<int64_t>(id >> 1);
}

void MakeFolders(const std::filesystem::path& folder) {
  std::error_code error;
  for (const char* part : {"streams", "logs"}) {
    std::filesystem::create_directories(folder / part, error);
    if (error) throw ConfigError("Cannot make the run folder " + folder.string() + ": " + error.message() + ".");
  }
}

std::string_view FindEnd(const Method& method) {
  switch (method.end) {
    case EndRule::kNothingLeft:
      return "nothing_left";
    case EndRule::kUnknownSettled:
      return "settled";
    default:
      return "completeness";
  }
}

/// A run folder stands by itself: it holds the arm's URDF.
void KeepUrdf(RunConfig& config) {
  const std::filesystem::path kept = config.folder / "robot.urdf";
  std::error_code error;
  std::filesystem::copy_file(config.cell.arm->urdf, kept, error);
  if (error) throw ConfigError("Cannot write " + kept.string() + ": " + error.message() + ".");
  config.cell.arm->urdf = kept;
}

}  // namespace

int64_t FindMemory() { return int64_t{sysconf(_SC_PHYS_PAGES)} * sysconf(_SC_PAGESIZE); }

std::string ListMethods() {
  std::string list;
  for (std::string_view name : MethodNames()) {
    list += std::string(name) + " " + std::string(FindEnd(FindMethod(name))) + "\n";
  }
  return list;
}

RunConfig PrepareRun(const RunRequest& request) {
  RunConfig config;
  config.gain = ResolveGain(request);
  CheckNumbers(request);
  CheckFolder(request.out);
  config.folder = std::filesystem::absolute(request.out).lexically_normal();
  if (!config.folder.has_filename()) config.folder = config.folder.parent_path();
  config.name = config.folder.filename().string();
  config.version = request.version;
  config.method = request.method;
  config.object = request.box_m ? "" : request.object;
  if (!request.box_m && request.object != kStatueName)
    config.object_file = std::filesystem::absolute(request.object).lexically_normal();
  config.seed = request.seed;
  config.completeness = request.completeness;
  config.max_scans = request.max_scans;
  config.realtime = request.rate == "realtime";
  config.cell = ReadCellConfig(FindCellFile(request));
  ResolvePlacement(FindObjectBox(request, config), config);
  CheckMemory(config.grid, request.memory_bytes);
  if (config.cell.arm) (void)ReadCellArm(config.cell);
  config.run_id = MakeRunId(config.name);
  MakeFolders(config.folder);
  if (config.cell.arm) KeepUrdf(config);
  WriteRunConfig(config);
  return config;
}

}  // namespace nbs
