#include "services/reporter/report_html.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/planning/method.h"
#include "services/reporter/motion_html.h"
#include "services/reporter/svg_plot.h"

namespace nbs {
namespace {

constexpr const char* kStyle = R"(
body { font: 15px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 1240px; padding: 0 1em; color: #222; }
h1 { font-size: 1.5em; } h2 { font-size: 1.15em; margin-top: 2em; }
table { border-collapse: collapse; } th, td { padding: 3px 10px; text-align: right; border-bottom: 1px solid #ddd; }
th { background: #f3f3f3; } td.text, th.text { text-align: left; }
.plots, .pictures { display: flex; flex-wrap: wrap; gap: 16px; } .plot { width: 580px; } .plot text { font: 11px sans-serif; }
.grid { stroke: #e4e4e4; } figure { margin: 0; width: 290px; } figure svg { width: 100%; display: block; border-radius: 4px; } .voxels figure { width: 480px; } .scans figure { width: 290px; } figcaption { text-align: center; color: #666; }
.bad { color: #b00020; } .bar { text-align: left; width: 300px; } .bar span { display: inline-block; height: 0.8em; border-radius: 2px; }
.note { color: #555; max-width: 60em; }
)";

/// What a verdict means and what becomes of the candidate.
const char* Explain(Verdict verdict) {
  switch (verdict) {
    case Verdict::kChosen:
      return "scanned";
    case Verdict::kReachable:
      return "can be scanned; another promised more; stays on the stack";
    case Verdict::kPartly:
      return "only part of its path can be reached, and that promised less than the chosen one; stays on the stack as "
             "a whole";
    case Verdict::kBlockedByObstacle:
      return "the sensor would touch something occupied; discarded";
    case Verdict::kBlockedByUnknown:
      return "the sensor would enter unknown space; kept for a later round";
    case Verdict::kNoMotion:
      return "the path is free, but no collision-free motion to it was found; kept";
    case Verdict::kNoInverseKinematics:
      return "out of the arm's reach; discarded";
    case Verdict::kJointLimit:
      return "only beyond the limits of the arm's joints; discarded";
    case Verdict::kSpeed:
      return "a joint would have to jump, or to turn or gather speed faster than it can; discarded";
    case Verdict::kSelfCollision:
      return "the arm would touch itself, the table or the floor; discarded";
    case Verdict::kNoGain:
      return "its information gain is below the threshold; discarded";
    case Verdict::kNotTried:
      return "ranked below the chosen one; reachability not looked at; stays on the stack";
    case Verdict::kDropped:
      return "boundary candidate dropped at the switch to holes";
  }
  return "";
}

std::string Base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t left = std::min<size_t>(3, bytes.size() - i);
    uint32_t group = 0;
    for (size_t k = 0; k < left; ++k) group |= static_cast<uint8_t>(bytes[i + k]) << (16 - 8 * k);
    for (size_t digit = 0; digit < 4; ++digit) text += digit <= left ? kDigits[(group >> (18 - 6 * digit)) & 63] : '=';
  }
  return text;
}

std::string Percent(double share) { return fmt::format("{:.2f} %", 100.0 * share); }

std::string FormatCoverage(const Evaluation& evaluation) {
  return fmt::format("{} of the surface, {} of what the profiler can see", Percent(evaluation.coverage),
                     Percent(evaluation.observable_coverage));
}

std::string FormatError(const Evaluation& evaluation) { return fmt::format("{:.3f} mm", 1e3 * evaluation.rmse_m); }

std::string FormatRegistration(const RunRecord& record, const Registration& registration) {
  std::string text = fmt::format("after the run; moved by {:.2f} mm in the mean, {:.2f} mm at most",
                                 1e3 * registration.mean_correction_m, 1e3 * registration.largest_correction_m);
  if (const auto streamed = FindStreamedMesh(record); streamed && streamed->evaluation) {
    text += fmt::format(". As streamed, like the table of scans: {}, RMS error {}",
                        FormatCoverage(*streamed->evaluation), FormatError(*streamed->evaluation));
  }
  return text;
}

std::string FormatShape(const Shape& shape) {
  return fmt::format("laid onto the true object, {:.2f} mm and {:.2f} mrad: {}, RMS error {}", 1e3 * shape.moved_m,
                     1e3 * shape.turned_rad, FormatCoverage(shape.evaluation), FormatError(shape.evaluation));
}

std::string DescribeObject(const RunConfig& config) { return config.object.empty() ? "a real object" : config.object; }

std::string MakeSummary(const RunConfig& config, const RunRecord& record, const Findings& findings, double wall_s) {
  std::string rows;
  const auto row = [&](const std::string& name, const std::string& value) {
    rows += fmt::format("<tr><td class='text'>{}</td><td class='text'>{}</td></tr>\n", name, EscapeHtml(value));
  };
  row("method", config.method);
  row("gain rule", FindMethod(config.method).by_gain ? config.gain : "none");
  row("object", DescribeObject(config));
  row("cell, seed, version", fmt::format("{}, {}, {}", config.cell.name, config.seed, config.version));
  row("ended because", record.detail.empty() ? record.end_reason : record.end_reason + ": " + record.detail);
  row("scans, path length", fmt::format("{}, {:.2f} m", record.scans.size(), CalcPathLength(record)));
  if (const auto mesh = FindFinalMesh(record, findings)) {
    row("mesh completeness (eq. 3)", fmt::format("{}; rim {:.2f} m; {} triangles", Percent(mesh->completeness),
                                                 mesh->rim_length_m, mesh->triangles));
    if (mesh->evaluation) {
      row("coverage", FormatCoverage(*mesh->evaluation));
      row("RMS error of the vertices", FormatError(*mesh->evaluation));
    }
  }
  if (findings.registration)
    row("scans registered with each other", FormatRegistration(record, *findings.registration));
  if (findings.shape) row("as a shape", FormatShape(*findings.shape));
  if (const auto mean_s = CalcMeanSelection(record)) row("mean selection", fmt::format("{:.3f} s", *mean_s));
  row("wall time", fmt::format("{:.1f} s", wall_s));
  row("refused measurements", fmt::format("{}", record.refused_measurements));
  if (findings.refused_states > 0)
    row("robot states without the arm's joints, not looked at", fmt::format("{}", findings.refused_states));
  return "<table>\n" + rows + "</table>\n";
}

std::string MakePlot(const RunRecord& record, const std::string& x_label, bool over_length) {
  PlotCurve coverage{"coverage", "#1565c0", {}};
  PlotCurve completeness{"mesh completeness", "#2e7d32", {}};
  double length_m = 0.0, lowest = 100.0, x = 0.0;
  for (const ScanRecord& scan : record.scans) {
    length_m += scan.path.length_m();
    x = over_length ? length_m : scan.scan + 1;
    completeness.points.emplace_back(x, 100.0 * scan.completeness);
    if (scan.evaluation) coverage.points.emplace_back(x, 100.0 * scan.evaluation->coverage);
    lowest =
        std::min({lowest, completeness.points.back().second, scan.evaluation ? coverage.points.back().second : 100.0});
  }
  const PlotAxes axes{x_label, "%", 0.0, std::max(x, 0.1), std::clamp(10.0 * std::floor(lowest / 10.0), 0.0, 90.0),
                      100.0};
  std::vector<PlotCurve> curves = {completeness};
  if (!coverage.points.empty()) curves.push_back(coverage);
  return MakeSvgPlot(axes, curves);
}

std::string MakeScanTable(const RunRecord& record) {
  std::string html =
      "<table><tr><th>scan</th><th class='text'>source</th><th>gain nat</th><th>path "
      "m</th><th>stripes</th><th>selection ms</th>"
      "<th>completeness</th><th>rim m</th><th>coverage</th><th>triangles</th><th>candidates</th><th "
      "class='text'>verdicts</th></tr>\n";
  for (const ScanRecord& scan : record.scans) {
    std::string verdicts;
    for (int v = 0; v < kVerdicts; ++v) {
      if (scan.verdicts[v] == 0) continue;
      verdicts +=
          fmt::format("{}{} {}", verdicts.empty() ? "" : ", ", scan.verdicts[v], ToString(static_cast<Verdict>(v)));
    }
    html += fmt::format(
        "<tr><td>{}</td><td "
        "class='text'>{}</td><td>{}</td><td>{:.3f}</td><td>{}</td><td>{:.0f}</td><td>{}</td><td>{:.2f}</td>",
        scan.scan + 1, ToString(scan.source), scan.by_gain() ? fmt::format("{:.0f}", scan.gain_nat) : "-",
        scan.path.length_m(), scan.stripes, 1e3 * scan.timing.total_s, Percent(scan.completeness), scan.rim_length_m);
    html += fmt::format("<td>{}</td><td>{}</td><td>{}</td><td class='text'>{}</td></tr>\n",
                        scan.evaluation ? Percent(scan.evaluation->coverage) : "-", scan.triangles, scan.candidates,
                        verdicts);
  }
  return html + "</table>\n";
}

std::string MakeVerdictTable(const RunRecord& record) {
  std::string html =
      "<table><tr><th class='text'>verdict</th><th>candidates</th><th>after the last scan</th><th "
      "class='text'>meaning</th></tr>\n";
  for (int v = 0; v < kVerdicts; ++v) {
    int sum = 0;
    for (const ScanRecord& scan : record.scans) sum += scan.verdicts[v];
    html +=
        fmt::format("<tr><td class='text'>{}</td><td>{}</td><td>{}</td><td class='text'>{}</td></tr>\n",
                    ToString(static_cast<Verdict>(v)), sum, record.last_verdicts[v], Explain(static_cast<Verdict>(v)));
  }
  return html + "</table>\n";
}

const char* Explain(Missing kind) {
  switch (kind) {
    case Missing::kOpen:
      return "nothing stands in the way: it could have been scanned";
    case Missing::kNoRoom:
      return "can be seen, but the sensor's body does not fit anywhere from where it could be measured";
    case Missing::kBase:
      return "only the table is in the way";
    case Missing::kDepthOfField:
      return "too narrow: lines of sight end before the nearest depth";
    case Missing::kOccluded:
      return "hidden by the object itself";
  }
  return "";
}

std::string MakeFindings(const Findings& findings) {
  std::string html;
  if (findings.remainder) {
    html +=
        "<h2>What is missing, by the truth</h2>\n<table><tr><th class='text'>why</th><th>share of the "
        "surface</th><th>rim m</th><th "
        "class='text'>meaning</th></tr>\n";
    for (int k = 0; k < kMissingKinds; ++k) {
      const auto kind = static_cast<Missing>(k);
      html += fmt::format("<tr><td class='text'>{}</td><td>{}</td><td>{:.2f}</td><td class='text'>{}</td></tr>\n",
                          ToString(kind), Percent(findings.remainder->missing[k]), findings.remainder->rim_m[k],
                          Explain(kind));
    }
    html += fmt::format(
        "<tr><td class='text'>seam</td><td>-</td><td>{:.2f}</td><td class='text'>beside it nothing is missing: a "
        "crack, or a gap of a few millimetres</td></tr>\n</table>\n",
        findings.remainder->seam_m);
  }
  return html;
}

/// Pictures side by side. A picture that is shown twice is in the file once: `refer_to` names the group that holds it.
std::string MakePictures(const std::string& group, const std::vector<ReportPicture>& pictures,
                         const std::string& refer_to = {}) {
  std::string html = fmt::format("<div class='pictures {}'>\n", group);
  for (size_t k = 0; k < pictures.size(); ++k) {
    const ReportPicture& picture = pictures[k];
    const std::string image =
        refer_to.empty() ? fmt::format("<image id='{}{}' width='{}' height='{}' href='data:image/png;base64,{}'/>",
                                       group, k, picture.width, picture.height, Base64(picture.png))
                         : fmt::format("<use href='#{}{}'/>", refer_to, k);
    html += fmt::format(
        "<figure><svg viewBox='0 0 {1} {2}' role='img' "
        "aria-label='{0}'>{3}\n{4}</svg><figcaption>{0}</figcaption></figure>\n",
        EscapeHtml(picture.caption), picture.width, picture.height, image, picture.overlay);
  }
  return html + "</div>\n";
}

}  // namespace

std::string MakeReportHtml(const RunConfig& config, const RunRecord& record, const Findings& findings, double wall_s,
                           const RunPictures& pictures) {
  std::string html = "<!doctype html>\n<html lang='en'><head><meta charset='utf-8'><title>" + EscapeHtml(config.name) +
                     "</title><style>" + kStyle + "</style></head><body>\n<h1>Scan of " +
                     EscapeHtml(DescribeObject(config)) + "</h1>\n";
  if (record.failed) html += "<p class='bad'>The run failed: " + EscapeHtml(record.detail) + "</p>\n";
  html += MakeSummary(config, record, findings, wall_s);
  if (!pictures.sides.empty()) {
    html += "<h2>The mesh from four sides; red: its border</h2>\n" + MakePictures("sides", pictures.sides);
    html += "<h2>The scans in their order, where the middle beam went over the surface</h2>\n" +
            MakePictures("paths", pictures.paths, "sides");
  }
  if (!record.scans.empty()) {
    html += "<h2>Progress</h2>\n<div class='plots'>\n" + MakePlot(record, "scans", false) +
            MakePlot(record, "path length, m", true) + "</div>\n";
  }
  html += MakeTimeTable(findings.time);
  if (findings.motion) html += MakeMotionTable(*findings.motion);
  html += MakeFindings(findings);
  html += "<h2>The voxel space</h2>\n" + MakePictures("voxels", pictures.voxels);
  if (!pictures.scans.empty()) {
    html +=
        "<h2>The robot half-way on each scan path</h2>\n<p class='note'>Its collision bodies, the sensor (blue) with "
        "its "
        "beams (red), the path (blue line); of the mesh what had been seen by then, green what this scan saw "
        "first.</p>\n" +
        MakePictures("scans", pictures.scans);
  }
  html += "<h2>Scans</h2>\n" + MakeScanTable(record);
  html += "<h2>What became of the candidates</h2>\n" + MakeVerdictTable(record);
  return html + "</body></html>\n";
}

}  // namespace nbs
