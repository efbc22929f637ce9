#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "common/config/run_config.h"

namespace nbs {

/// Memory of this machine, bytes.
int64_t FindMemory();

/// What the command line of a run says, as text and numbers; nothing checked yet.
struct RunRequest {
  std::string object = "statue";  ///< Name or mesh file.
  /// A real object instead, of which nothing is known but that it fits in a box of these sizes along x, y and z,
  /// metres; the middle of the box's bottom is W's origin.
  std::optional<std::array<double, 3>> box_m;
  std::string method = "BH/IG";
  std::string gain;                 ///< Gain rule; empty: the method's own.
  std::string cell = "free";        ///< Name of a cell in cells_dir, or a cell file.
  std::filesystem::path cells_dir;  ///< Where the named cells lie.
  double completeness = 0.9875;
  int max_scans = 30;
  uint64_t seed = 1;
  std::string rate = "max";   ///< max or realtime.
  std::filesystem::path out;  ///< The run folder to be made.
  std::string version;
  int64_t memory_bytes = FindMemory();  ///< What the voxel space of all services must fit in.
};

/// The methods there are, a line each: name, and what ends a run of it: `completeness` of the mesh, `nothing_left` to
/// scan, or the unknown space has `settled`.
std::string ListMethods();

/// Makes a run folder that services can start on: checks the request, loads cell and object, places voxel space and
/// first path, and writes OUT/{run.yaml, streams/, logs/} and, for an arm, OUT/robot.urdf.
///
/// An existing folder is taken only if it is empty: an earlier run, finished or not, and any other folder are never
/// touched. Nothing is written before everything is checked.
///
/// @returns The configuration as written.
/// @throws ConfigError, one sentence, if anything in the request is wrong.
RunConfig PrepareRun(const RunRequest& request);

}  // namespace nbs
