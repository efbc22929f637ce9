#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/mapping/voxel_delta.h"
#include "common/planning/scan_path.h"
#include "common/sensing/profiler.h"

namespace nbs {

/// A sphere of a collision body, in the frame of the body.
struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< Metres.
  double radius_m = 0.0;
};

/// Everything that a cell file states (sim/cells/NAME.yaml), with its defaults.
struct CellConfig {
  std::string name = "free";
  std::string robot = "free";  ///< "free": a free-flying sensor.
  Profiler profiler;
  Pose X_FS = Pose::Identity();       ///< Hand-eye transform: sensor in flange.
  std::vector<Sphere> sensor_body_S;  ///< Collision body of the profiler.
  double body_margin_m = 0.02;        ///< Kept between the body and anything occupied or unknown.
  double move_speed_m_per_s = 0.25;
  double turn_speed_rad_per_s = 0.8;
  double resolution_m = 0.005;      ///< Edge of a voxel.
  double unknown_margin_m = 0.05;   ///< The box that is unknown at the start: the object's bounding box grown by this.
  std::optional<double> table_z_m;  ///< Height of the table's top; none: the object hangs free.
  // The first scan path: the sensor looks along `first_view_W` at the middle of the box, `first_standoff_m` away from
  // the box's face, and moves along `first_along_W` over the box's whole extent in that direction.
  Eigen::Vector3d first_view_W = Eigen::Vector3d::UnitY();
  Eigen::Vector3d first_along_W = Eigen::Vector3d::UnitZ();
  double first_standoff_m = 0.20;
};

/// One run with everything resolved: what run.yaml holds and each service reads.
struct RunConfig {
  std::filesystem::path folder;  ///< The run folder; not stored in the file.
  std::string name;
  int64_t run_id = 0;   ///< Separates runs on a bus; does not influence any result.
  std::string version;  ///< Of the software that made the run.
  std::string method = "BH/IG";
  std::string gain = "surface";       ///< Name of the gain rule by which candidates are rated.
  std::string object = "statue";      ///< Name or file as the user gave it; empty: a real object, no truth known.
  std::filesystem::path object_file;  ///< Absolute path of the mesh; empty: the built-in statue, or no truth.
  uint64_t seed = 1;
  double completeness = 0.9875;  ///< Wanted mesh completeness, eq. 3.
  int max_scans = 30;
  bool realtime = false;
  CellConfig cell;
  GridShape grid;  ///< The voxel space: everything outside is taken as free.
  ScanPath first_path;
};

/// Reads a cell file.
///
/// @throws ConfigError (one sentence with file, line and remedy) if it is missing, malformed, has an unknown or a
/// duplicate key ("did you mean …"), or a
///         value is out of range.
CellConfig ReadCellConfig(const std::filesystem::path& file);

/// Reads FOLDER/run.yaml; strict like ReadCellConfig.
RunConfig ReadRunConfig(const std::filesystem::path& folder);

/// Writes FOLDER/run.yaml (atomically: a temporary file, then rename). Reading it back gives an equal configuration.
void WriteRunConfig(const RunConfig& config);

/// Places the grid (box grown by the margin, lowest corner on a multiple of the resolution) and the first path around
/// an object's bounding box in W, metres.
void ResolvePlacement(const Eigen::AlignedBox3d& object_box_W, RunConfig& config);

}  // namespace nbs
