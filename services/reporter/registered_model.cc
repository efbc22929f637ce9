#include "services/reporter/registered_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/runtime/run_failure.h"

namespace nbs {
namespace {

/// Mean and largest distance between stripes as reported and as registered.
void MeasureCorrections(const std::vector<Stripe>& registered, const std::vector<Stripe>& reported,
                        Registration& registration) {
  double sum_m = 0.0;
  int64_t count = 0;
  for (size_t i = 0; i < registered.size(); ++i) {
    if (i >= reported.size() || registered[i].scan != reported[i].scan || registered[i].index != reported[i].index)
      throw RunFailure("the registered stripes are not those of the run");
    if (registered[i].end_of_scan) continue;
    const double moved_m = (registered[i].X_WS.translation() - reported[i].X_WS.translation()).norm();
    registration.largest_correction_m = std::max(registration.largest_correction_m, moved_m);
    sum_m += moved_m;
    ++count;
  }
  registration.mean_correction_m = count > 0 ? sum_m / static_cast<double>(count) : 0.0;
}

}  // namespace

std::optional<RegisteredModel> MakeRegisteredModel(const RegisteredStreams& registered,
                                                   const std::vector<Stripe>& reported,
                                                   const ReporterNode::Evaluator& evaluator) {
  if (registered.figures.empty()) return std::nullopt;
  RegisteredModel model;
  for (const MeshDelta& delta : registered.deltas) model.mesh.Apply(delta);
  model.registration.figures = registered.figures.back();
  MeasureCorrections(registered.stripes, reported, model.registration);
  if (evaluator) model.registration.evaluation = evaluator(model.mesh.MakeCompactMesh());
  return model;
}

std::string DescribeRegistration(const Registration& registration, const RunRecord& record) {
  std::string text = fmt::format("scans registered with each other: moved by {:.2f} mm in the mean, {:.2f} mm at most",
                                 1e3 * registration.mean_correction_m, 1e3 * registration.largest_correction_m);
  if (registration.evaluation && !record.scans.empty() && record.scans.back().evaluation) {
    const Evaluation &after = *registration.evaluation, &before = *record.scans.back().evaluation;
    text += fmt::format(
        "; coverage {:.2f} % (as streamed, up to scan {}: {:.2f} %), of what can be seen {:.2f} % ({:.2f} %)",
        100.0 * after.coverage, record.scans.size(), 100.0 * before.coverage, 100.0 * after.observable_coverage,
        100.0 * before.observable_coverage);
  }
  return text;
}

}  // namespace nbs
