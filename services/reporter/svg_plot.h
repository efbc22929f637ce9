#pragma once

#include <string>
#include <utility>
#include <vector>

namespace nbs {

/// One curve of a plot.
struct PlotCurve {
  std::string label;
  std::string colour;                             ///< CSS colour.
  std::vector<std::pair<double, double>> points;  ///< (x, y), in the axes' units.
};

/// Axes of a plot; the ranges must not be empty.
struct PlotAxes {
  std::string x_label;
  std::string y_label;
  double x_min = 0.0;
  double x_max = 1.0;
  double y_min = 0.0;
  double y_max = 1.0;
};

/// An SVG element with axes, ticks at round values, a grid, and the curves with markers and a legend. Values outside
/// the axes are clamped to them.
///
/// @throws std::invalid_argument if a range is empty or not finite.
std::string MakeSvgPlot(const PlotAxes& axes, const std::vector<PlotCurve>& curves);

/// Replaces the characters that mean something in HTML.
std::string EscapeHtml(const std::string& text);

}  // namespace nbs
