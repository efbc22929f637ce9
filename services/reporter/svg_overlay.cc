#include "services/reporter/svg_overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace nbs {
namespace {

std::string ListPoints(const PixelLine& line) {
  std::string points;
  for (const Eigen::Vector2d& p : line) points += fmt::format("{:.1f},{:.1f} ", p.x(), p.y());
  return points;
}

}  // namespace

std::string MakeScanColor(int number, int count) {
  const double share = count > 1 ? static_cast<double>(number) / (count - 1) : 0.0;
  return fmt::format("hsl({:.0f}, 85%, 38%)", 175.0 + 150.0 * share);
}

std::string DrawLine(const PixelLine& line, const std::string& color, double width) {
  if (line.size() < 2) return {};
  const std::string points = ListPoints(line);
  return fmt::format(
      "<g fill='none' stroke-linejoin='round' stroke-linecap='round'><polyline points='{0}' stroke='#fff' "
      "stroke-opacity='.75' stroke-width='{1:.1f}'/><polyline points='{0}' stroke='{2}' "
      "stroke-width='{3:.1f}'/></g>\n",
      points, width + 3.0, color, width);
}

std::string DrawArea(const PixelLine& outline, const std::string& color) {
  return fmt::format("<polygon points='{}' fill='{}' fill-opacity='.45'/>\n", ListPoints(outline), color);
}

void NumberDiscs::Add(int number, const PixelLine& line, const std::string& color) {
  Eigen::Vector2d best = Eigen::Vector2d::Zero();
  double farthest = -1.0;
  for (const Eigen::Vector2d& p : line) {
    double nearest = std::numeric_limits<double>::max();
    for (const Disc& disc : discs_) nearest = std::min(nearest, (disc.at - p).norm());
    if (nearest <= farthest) continue;
    farthest = nearest;
    best = p;
  }
  if (!line.empty()) discs_.push_back({number, best, color});
}

std::string NumberDiscs::Draw() const {
  std::string svg;
  for (const Disc& disc : discs_) {
    svg += fmt::format(
        "<circle cx='{0:.1f}' cy='{1:.1f}' r='16' fill='{2}' stroke='#fff' stroke-width='2.5'/><text x='{0:.1f}' "
        "y='{3:.1f}' text-anchor='middle' fill='#fff' font-family='sans-serif' font-weight='bold' "
        "font-size='18'>{4}</text>\n",
        disc.at.x(), disc.at.y(), disc.color, disc.at.y() + 6.5, disc.number);
  }
  return svg;
}

}  // namespace nbs
