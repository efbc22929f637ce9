#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/geometry/pose.h"

namespace nbs {

/// A linear scan path: the sensor's origin runs straight from start to end while its orientation turns evenly.
struct ScanPath {
  Pose X_WS_start = Pose::Identity();
  Pose X_WS_end = Pose::Identity();

  double length_m() const { return (X_WS_end.translation() - X_WS_start.translation()).norm(); }
};

/// The same line with the sensor turned by half a turn about its viewing axis: the same light planes, their points in
/// reverse order. A camera then stands on the other side of them.
ScanPath RollPath(const ScanPath& path);

/// A run has at most so many scans, numbered from 0; a mesh vertex keeps such a number in 16 bits.
inline constexpr int kMaxScans = 10'000;

/// Where a candidate comes from.
enum class CandidateSource : uint8_t { kFirst = 0, kBoundary = 1, kHole = 2, kSphere = 3 };

/// What became of a candidate (section III-E of the paper).
enum class Verdict : uint8_t {
  kChosen = 0,               ///< The next best scan.
  kReachable = 1,            ///< Could be scanned; another was better. Stays on the stack.
  kPartly = 2,               ///< Only part of its path can be reached; that part is the candidate.
  kBlockedByObstacle = 3,    ///< Touches something occupied: discarded.
  kBlockedByUnknown = 4,     ///< Touches unknown space: kept for a later round.
  kNoMotion = 5,             ///< The path itself is free, but no collision-free motion to it was found: kept.
  kNoInverseKinematics = 6,  ///< Out of the arm's reach, whatever its joints' limits: discarded.
  kNoGain = 7,               ///< Information gain below the threshold: discarded.
  kNotTried = 8,             ///< Ranked below the chosen one, reachability not looked at. Stays on the stack.
  kDropped = 9,              ///< Boundary candidate dropped at the switch to holes.
  kJointLimit = 10,          ///< The arm would get there only beyond the limits of its joints: discarded.
  kSpeed = 11,               ///< A joint would have to jump, or to turn or gather speed faster than it can: discarded.
  kSelfCollision = 12,       ///< The arm would touch itself, the table or the floor: discarded.
};
inline constexpr int kVerdicts = 13;

/// Names as in report.json and on the bus: first, boundary, hole, sphere; chosen, reachable, partly,
/// blocked_by_obstacle, …
std::string_view ToString(CandidateSource source);
std::string_view ToString(Verdict verdict);

/// A proposed scan path. Candidates stay on the planner's stack over rounds until chosen or discarded.
struct Candidate {
  int32_t id = 0;  ///< Unique in the run, rising in order of creation.
  CandidateSource source = CandidateSource::kFirst;
  int32_t born_scan = 0;  ///< The scan after which it was proposed.
  int32_t rank = 0;       ///< Order within its batch: class and position (the B method's rule).
  ScanPath path;
};

/// A candidate with what the planner found out about it in one round.
struct RatedCandidate {
  Candidate candidate;
  double gain_nat = 0.0;  ///< Information gain, eq. 2.
  Verdict verdict = Verdict::kNotTried;
};

/// One point of a trajectory. Between two points the flange moves straight and turns evenly, or, with joints, the
/// joints move linearly.
struct TrajectoryPoint {
  int64_t time_us = 0;  ///< Since the start of the trajectory; strictly rising.
  Pose X_WF = Pose::Identity();
  std::vector<double> joints_rad;  ///< Empty for a free-flying sensor.
  bool scanning = false;           ///< The profiler runs on the segment that begins here.
};

/// The motion of one scan: approach, then the scan path.
struct Trajectory {
  int64_t utime_us = 0;  ///< When it starts.
  int32_t scan = 0;
  std::vector<TrajectoryPoint> points;
};

/// The most points of a trajectory, each with so many joint values, that a plan with its chosen candidate has room for
/// in one message (60,000 B): 379 of an arm with six joints, 546 without joints.
constexpr size_t CalcMostPoints(size_t joints) { return 59'600 / (109 + 8 * joints); }

/// The robot's state at one instant.
struct RobotState {
  int64_t utime_us = 0;
  int32_t scan = 0;
  bool scanning = false;     ///< The profiler takes a profile at this instant.
  bool end_of_scan = false;  ///< The last state of a scan (never scanning).
  Pose X_WF = Pose::Identity();
  std::vector<double> joints_rad;
};

/// What became of a trajectory.
struct Execution {
  int64_t utime_us = 0;  ///< When it ended.
  int32_t scan = 0;
  bool done = false;
  std::string refusal;  ///< Why it was not executed; empty when done.
};

/// What the coordinator asks of the planner.
enum class PlanMode : uint8_t {
  kFirst = 0,     ///< The cell's first scan path.
  kBoundary = 1,  ///< Add boundary candidates from the newest scan to the stack (section III-A).
  kHole = 2,      ///< Drop boundary candidates, detect holes if not yet done, scan only holes (section III-B).
  kSphere = 3,    ///< Viewpoints on a sphere around the object (the S methods of section IV-B).
};
inline constexpr int kPlanModes = 4;

struct PlanRequest {
  int64_t utime_us = 0;
  int32_t scan = 0;  ///< Number of the scan to be planned; mesh and voxels of all scans before it are folded in first.
  PlanMode mode = PlanMode::kFirst;
};

/// The planner's answer. All candidates, with verdicts, come before it on their own stream.
struct Plan {
  int64_t utime_us = 0;
  int32_t scan = 0;
  PlanMode mode = PlanMode::kFirst;
  bool found = false;
  bool stack_is_empty = false;  ///< Nothing was found because no candidate is left at all.
  std::string reason;           ///< Why nothing was found, in words; empty when found.
  int64_t unknown_cells = 0;    ///< Voxels that were never observed when the plan was made.
  RatedCandidate chosen;        ///< Valid when found.
  Trajectory trajectory;        ///< Valid when found.
};

/// Every candidate of one round, in parts that fit a datagram.
struct CandidateSet {
  int64_t utime_us = 0;
  int32_t scan = 0;
  bool end = false;  ///< True on the last part of a round.
  std::vector<RatedCandidate> candidates;
};

/// Wall-clock durations of one round; by nature not the same on a replay.
struct PlanTiming {
  int64_t utime_us = 0;
  int32_t scan = 0;
  double update_s = 0.0;      ///< Replicas and distance field.
  double candidates_s = 0.0;  ///< Boundary search or hole detection.
  double gain_s = 0.0;
  double motion_s = 0.0;        ///< Reachability and motion planning.
  double total_s = 0.0;         ///< From the request to the answer.
  std::vector<double> plans_s;  ///< Each motion that was planned, found or not; part of motion_s.
};

enum class RunPhase : uint8_t { kPlanning = 0, kScanning = 1, kFinished = 2 };

/// Where the coordinator's state machine stands (Fig. 2).
struct RunState {
  int64_t utime_us = 0;
  int32_t scan = 0;  ///< Planned or scanned now; the number of scans when finished.
  RunPhase phase = RunPhase::kPlanning;
  PlanMode mode = PlanMode::kFirst;
  bool failed = false;     ///< Finished because something broke; the exit code is then 2.
  std::string end_reason;  ///< Set when finished: completeness_reached, scan_limit, unknown_settled, nothing_reachable,
                           ///< no_candidates, refused.
  std::string detail;      ///< One sentence.
};

}  // namespace nbs
