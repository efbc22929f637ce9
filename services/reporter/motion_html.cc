#include "services/reporter/motion_html.h"

#include <fmt/format.h>

#include <algorithm>

#include "services/reporter/svg_plot.h"

namespace nbs {
namespace {

const char* Explain(MotionFault fault) {
  switch (fault) {
    case MotionFault::kContactObject:
      return "a body of arm or sensor meets the true object";
    case MotionFault::kContactTable:
      return "one meets the table";
    case MotionFault::kContactFloor:
      return "one meets the floor";
    case MotionFault::kContactSelf:
      return "two parts of the arm meet, or one and the sensor";
    case MotionFault::kJointLimit:
      return "a joint is beyond its limits";
    case MotionFault::kSpeed:
      return "a joint, the flange or the scanning sensor is faster than it may be, by more than 1 %";
    case MotionFault::kJump:
      return "the robot is where it cannot have come in the time";
  }
  return "";
}

std::string Place(const MotionPlace& place) {
  return fmt::format("{}, scan {}, at {:.2f} s", EscapeHtml(place.body), place.scan + 1,
                     1e-6 * static_cast<double>(place.utime_us));
}

/// A row with a bar; `of_s` is the length of the longest.
std::string MakeRow(const char* what, const char* meaning, const std::optional<double>& time_s, double of_s,
                    const char* colour) {
  if (!time_s)
    return fmt::format("<tr><td class='text'>{}</td><td>-</td><td></td><td class='text'>{}</td></tr>\n", what, meaning);
  return fmt::format(
      "<tr><td class='text'>{}</td><td>{:.1f} s</td><td class='bar'><span "
      "style='width:{:.1f}%;background:{}'></span></td><td "
      "class='text'>{}</td></tr>\n",
      what, *time_s, 100.0 * *time_s / of_s, colour, meaning);
}

}  // namespace

std::string MakeTimeTable(const TimeSplit& time) {
  constexpr const char* kRobot = "#1565c0";
  constexpr const char* kComputer = "#ef6c00";
  const double longest = std::max({1e-9, time.motion_s, time.scan_s, time.map_s.value_or(0.0),
                                   time.mesh_s.value_or(0.0), time.selection_s, time.planning_s});
  const double robot_s = time.motion_s + time.scan_s;
  return fmt::format(
             "<h2>Where the time went</h2>\n<p>The robot took {:.0f} min {:04.1f} s of its own time; the computer's is "
             "that on the wall, of services that work side by side.</p>\n<table>\n",
             std::floor(robot_s / 60.0), robot_s - 60.0 * std::floor(robot_s / 60.0)) +
         MakeRow("motion", "robot: to the scan paths", time.motion_s, longest, kRobot) +
         MakeRow("scan", "robot: along them", time.scan_s, longest, kRobot) +
         MakeRow("map", "computer: stripes into the voxel space", time.map_s, longest, kComputer) +
         MakeRow("mesh", "computer: stripes into the mesh", time.mesh_s, longest, kComputer) +
         MakeRow("selection", "computer: candidates and their information gain", time.selection_s, longest, kComputer) +
         MakeRow("planning", "computer: what of them the robot can drive, and how", time.planning_s, longest,
                 kComputer) +
         "</table>\n";
}

std::string MakeMotionTable(const MotionAudit& audit) {
  std::string html =
      "<h2>What the motions did, by the truth</h2>\n<table><tr><th class='text'>fault</th><th>count</th><th "
      "class='text'>first</th><th class='text'>meaning</th></tr>\n";
  for (int k = 0; k < kMotionFaults; ++k) {
    const auto kind = static_cast<MotionFault>(k);
    const MotionFaultCount& fault = audit.of(kind);
    html +=
        fmt::format("<tr{}><td class='text'>{}</td><td>{}</td><td class='text'>{}</td><td class='text'>{}</td></tr>\n",
                    fault.count > 0 ? " class='bad'" : "", ToString(kind), fault.count,
                    fault.first ? Place(*fault.first) : "-", Explain(kind));
  }
  html += fmt::format("</table>\n<p{}>Contacts in {} of {} states", audit.contacts > 0 ? " class='bad'" : "",
                      audit.contacts, audit.states);
  if (audit.nearest)
    html += fmt::format("; nearest to the object: {:.1f} mm ({})", 1e3 * audit.nearest_m, Place(*audit.nearest));
  return html +
         ".</p>\n<p class='note'>Every executed motion, to the scan paths and along them, in steps of at most 10 mm of "
         "any "
         "point of the robot: each collision body of its URDF and of the sensor, as joints and states report it, moved "
         "by as "
         "much as the simulated arm truly stands beside its reported pose, against the true mesh, the table and the "
         "floor.</p>\n";
}

}  // namespace nbs
