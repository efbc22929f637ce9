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

/// An arm that carries the sensor. Frame O: origin in the middle of the bottom of the object's bounding box, axes of W.
struct ArmConfig {
  std::filesystem::path urdf;  ///< Absolute; a cell states it relative to its own folder, run.yaml to the run folder.
  std::string base_link = "base_link";
  std::string flange_link = "tool0";
  std::string inverse_kinematics = "analytic";  ///< Or "numeric", for arms without a spherical wrist.
  std::string motion_search = "rrt_connect";    ///< Or "prm": how ways to the start of a scan path are searched.
  std::string registration = "none";            ///< Or "joint": after the run all scans are registered with each other.
  Pose X_OB = Pose::Identity();                 ///< Base in O. The floor lies at the height of its origin.
  std::vector<double> start_rad;                ///< Joint values at the start.
  std::vector<double> max_rad_per_s2;           ///< Acceleration of each joint.
  // What the arm is off, in simulation: the true flange stands beside the reported one by a bias that changes slowly
  // over the work space and by noise at every instant.
  double pose_bias_m = 0.0;   ///< Mean length of the bias; it lies within a third of it.
  double pose_noise_m = 0.0;  ///< Standard deviation on each axis.
};

/// The profiler's housing where a cell does not give one: a box of 0.12 x 0.20 x 0.10 m (x, y, z of S) behind the
/// emitter, whose front face is the emitter's plane z = 0. No sphere reaches in front of that plane; every point of the
/// box is within 20 mm of a sphere.
std::vector<Sphere> MakeDefaultSensorBody();

/// Everything that a cell file states (sim/cells/NAME.yaml), with its defaults.
struct CellConfig {
  std::string name = "free";
  std::string robot = "free";    ///< "free": a free-flying sensor; "arm": `arm` carries it.
  std::optional<ArmConfig> arm;  ///< Present exactly if the robot is an arm.
  Profiler profiler;
  Pose X_FS = Pose::Identity();                                 ///< Hand-eye transform: sensor in flange.
  std::vector<Sphere> sensor_body_S = MakeDefaultSensorBody();  ///< Collision body of the profiler; never empty.
  double body_margin_m = 0.02;  ///< Kept between the body and anything occupied or unknown.
  double move_speed_m_per_s = 0.25;
  double turn_speed_rad_per_s = 0.8;
  double resolution_m = 0.005;      ///< Edge of a voxel.
  double unknown_margin_m = 0.05;   ///< The box that is unknown at the start: the object's bounding box grown by this.
  std::optional<double> table_z_m;  ///< Height of the table's top; none: the object hangs free.
  // For a table that goes with the object: its top is so far above the lowest point of the object (0: the object stands
  // on it), which sets table_z_m.
  std::optional<double> table_above_object_m;
  Eigen::Vector2d table_half_m = {5.0, 5.0};  ///< Half of its sizes along x and y, around the object's middle.
  // The first scan path: the sensor looks along `first_view_W` at the middle of the box, `first_standoff_m` away from
  // the box's face, and moves along `first_along_W` over the box's whole extent in that direction. If an object is so
  // low that less than 70 % of that is high enough above the table, both are turned down in steps of 5 degrees until it
  // is.
  Eigen::Vector3d first_view_W = Eigen::Vector3d::UnitY();
  Eigen::Vector3d first_along_W = Eigen::Vector3d::UnitZ();
  double first_standoff_m = 0.20;
  double first_above_table_m = 0.0;  ///< The sensor's origin stays so high above the table, if there is one.
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
  GridShape grid;                                  ///< The voxel space: everything outside is taken as free.
  Eigen::Vector3d p_WO = Eigen::Vector3d::Zero();  ///< Origin of O: the middle of the bottom of the object's box.
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

/// Places O, the table, the grid (box grown by the margin, lowest corner on a multiple of the resolution; nothing below
/// a table that goes with the object) and the first path around an object's bounding box in W, metres.
void ResolvePlacement(const Eigen::AlignedBox3d& object_box_W, RunConfig& config);

/// The arm's base in W.
///
/// @pre The run has an arm.
Pose CalcBasePose(const RunConfig& config);

}  // namespace nbs
