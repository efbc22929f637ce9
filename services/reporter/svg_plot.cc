#include "services/reporter/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace nbs {
namespace {

constexpr double kWidth = 560, kHeight = 320;
constexpr double kLeft = 64, kRight = 16, kTop = 16, kBottom = 48;

double MapX(const PlotAxes& axes, double x) {
  const double share = (std::clamp(x, axes.x_min, axes.x_max) - axes.x_min) / (axes.x_max - axes.x_min);
  return kLeft + share * (kWidth - kLeft - kRight);
}

double MapY(const PlotAxes& axes, double y) {
  const double share = (std::clamp(y, axes.y_min, axes.y_max) - axes.y_min) / (axes.y_max - axes.y_min);
  return kHeight - kBottom - share * (kHeight - kTop - kBottom);
}

/// 1, 2 or 5 times a power of ten, such that a range holds about five steps.
double CalcTickStep(double range) {
  const double power = std::pow(10.0, std::floor(std::log10(range / 5.0)));
  for (double factor : {1.0, 2.0, 5.0}) {
    if (range / (factor * power) <= 6.0) return factor * power;
  }
  return 10.0 * power;
}

std::string MakeTicks(const PlotAxes& axes) {
  std::string svg;
  const double step_x = CalcTickStep(axes.x_max - axes.x_min);
  for (double x = std::ceil(axes.x_min / step_x) * step_x; x <= axes.x_max + 1e-9 * step_x; x += step_x) {
    svg += fmt::format(
        "<line class='grid' x1='{0:.1f}' x2='{0:.1f}' y1='{1}' y2='{2}'/><text x='{0:.1f}' y='{3}' "
        "text-anchor='middle'>{4:g}</text>\n",
        MapX(axes, x), kTop, kHeight - kBottom, kHeight - kBottom + 16, x);
  }
  const double step_y = CalcTickStep(axes.y_max - axes.y_min);
  for (double y = std::ceil(axes.y_min / step_y) * step_y; y <= axes.y_max + 1e-9 * step_y; y += step_y) {
    svg += fmt::format(
        "<line class='grid' y1='{0:.1f}' y2='{0:.1f}' x1='{1}' x2='{2}'/><text x='{3}' y='{4:.1f}' "
        "text-anchor='end'>{5:g}</text>\n",
        MapY(axes, y), kLeft, kWidth - kRight, kLeft - 6, MapY(axes, y) + 4, y);
  }
  return svg;
}

std::string MakeCurve(const PlotAxes& axes, const PlotCurve& curve, size_t number) {
  std::string points, markers;
  for (const auto& [x, y] : curve.points) {
    points += fmt::format("{:.1f},{:.1f} ", MapX(axes, x), MapY(axes, y));
    markers +=
        fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='2.5' fill='{}'/>", MapX(axes, x), MapY(axes, y), curve.colour);
  }
  const double y_legend = kHeight - kBottom - 14.0 * static_cast<double>(number) - 12.0;
  return fmt::format("<polyline fill='none' stroke='{0}' stroke-width='1.5' points='{1}'/>{2}\n", curve.colour, points,
                     markers) +
         fmt::format("<text x='{}' y='{:.1f}' text-anchor='end' fill='{}'>{}</text>\n", kWidth - kRight - 8, y_legend,
                     curve.colour, EscapeHtml(curve.label));
}

}  // namespace

std::string MakeSvgPlot(const PlotAxes& axes, const std::vector<PlotCurve>& curves) {
  const bool finite = std::isfinite(axes.x_min + axes.x_max + axes.y_min + axes.y_max);
  if (!finite || axes.x_max <= axes.x_min || axes.y_max <= axes.y_min)
    throw std::invalid_argument("MakeSvgPlot: an axis without extent");
  std::string svg = fmt::format("<svg class='plot' viewBox='0 0 {} {}' role='img'>\n", kWidth, kHeight);
  svg += MakeTicks(axes);
  svg += fmt::format("<rect x='{}' y='{}' width='{}' height='{}' fill='none' stroke='#888'/>\n", kLeft, kTop,
                     kWidth - kLeft - kRight, kHeight - kTop - kBottom);
  svg += fmt::format("<text x='{}' y='{}' text-anchor='middle'>{}</text>\n", (kLeft + kWidth - kRight) / 2,
                     kHeight - 12, EscapeHtml(axes.x_label));
  svg += fmt::format("<text transform='translate(16 {}) rotate(-90)' text-anchor='middle'>{}</text>\n",
                     (kTop + kHeight - kBottom) / 2, EscapeHtml(axes.y_label));
  for (size_t i = 0; i < curves.size(); ++i) svg += MakeCurve(axes, curves[i], i);
  return svg + "</svg>\n";
}

std::string EscapeHtml(const std::string& text) {
  std::string escaped;
  for (char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

}  // namespace nbs
