#pragma once

namespace nbs {

/// The two searches for a way that the paper names (section III-E).
enum class SearchAlgorithm {
  kRrtConnect,  ///< Kuffner & LaValle, ICRA 2000, DOI 10.1109/ROBOT.2000.844730.
  kPrm,         ///< Kavraki et al., IEEE T-RA 12(4), 1996, DOI 10.1109/70.508439.
};

/// How motions are planned; the cell's own figures (speeds, margin, body) are in CellConfig.
struct MotionSettings {
  double min_part_m = 0.03;           ///< A part of a scan path shorter than this is not worth driving to.
  double search_margin_m = 0.6;       ///< The search may use positions this far outside the voxel space.
  int search_iterations = 2000;       ///< Extensions of the two trees before a search gives up.
  int searches = 2;                   ///< Ends and rolls of a scan path for which a way is searched.
  double search_range_m = 0.3;        ///< Longest edge of the trees.
  int joint_search_iterations = 300;  ///< The same for an arm; or the milestones of its roadmap.
  int search_goals = 8;               ///< Starts of a scan path that an arm's search may come to.
  int shortcuts = 40;                 ///< Attempts to shorten a way that was found.
};

}  // namespace nbs
