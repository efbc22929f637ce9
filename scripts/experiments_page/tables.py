"""The tables of the page: ours beside the paper's."""

import statistics

from runs import WANTED_COMPLETENESS

# Kriegel et al., IROS 2012, Table II: scans, path length in m, seconds for each selection, coverage in %.
PAPER_TABLE_II = {"B": (16, 8.1, 0.8, 95.7), "S": (15, 9.8, 15.7, 90.0), "S/IG": (24, 17.6, 16.0, 97.0), "B/IG": (11, 5.7, 9.5, 98.1), "BH/IG": (11, 4.4, 7.1, 99.0)}
# Table III: coverage in % after so many scans.
COUNTS = (5, 10, 15, 20, 25, 30)
PAPER_TABLE_III = {"S/IG": (74.0, 92.9, 96.0, 96.6, 97.0, 97.2), "BH/IG": (80.1, 97.9, 99.2, 99.6, 99.8, 99.8)}
REACHED = (0.95, 0.98, 0.99)
# Rows of the oracle: name, what counts as covered, by what a path is chosen (sim/README.md).
ORACLE_ROWS = (("oracle", "partner", "scan"), ("oracle, by the metre", "partner", "metre"), ("oracle, point itself seen", "seen", "scan"),
               ("oracle, itself seen, by the metre", "seen", "metre"))
NONE = "–"


def mean_and_spread(values, digits):
    """Mean and standard deviation over the seeds; only the mean of a single value."""
    values = [value for value in values if value is not None]
    if not values:
        return NONE
    mean = f"{statistics.fmean(values):.{digits}f}"
    return f"{mean} ± {statistics.stdev(values):.{digits}f}" if len(values) > 1 else mean


def find_curve(oracle, covered, rule, start="free"):
    return next(curve for curve in oracle["curves"] if (curve["covered"], curve["rule"], curve["start"]) == (covered, rule, start))


def oracle_reach(curve, coverage):
    """(scans, metres) with which the oracle first has the coverage; None if never."""
    for i, value in enumerate(curve["coverage"]):
        if value >= coverage:
            return i + 1, curve["path_length_m"][i]
    return None


def oracle_after(curve, count):
    return curve["coverage"][min(count, len(curve["coverage"])) - 1]


def figures_at_end(run):
    """Scans, metres, seconds, coverage in % where the method ends by itself, and whether its end rule was fulfilled."""
    count, reached = run.find_end()
    return (count, run.path_after(count), run.selection_after(count), 100 * run.coverage_after(count)), reached


def make_table_ii(experiments, object_name):
    header = ["method", "seeds", "end rule fulfilled", "scans", "paper", "path m", "paper", "s per selection", "paper", "coverage %", "paper"]
    rows = []
    best = 0.0
    for method in experiments.methods:
        runs = experiments.of(object_name, method)
        if not runs:
            continue
        figures, reached = zip(*map(figures_at_end, runs))
        paper = PAPER_TABLE_II.get(method, (NONE,) * 4)
        row = [method, len(runs), f"{sum(reached)} of {len(runs)}"]
        for k, digits in enumerate((1, 2, 3, 2)):
            row += [mean_and_spread([figure[k] for figure in figures], digits), paper[k]]
        rows.append(row)
        best = max(best, statistics.fmean(figure[3] for figure in figures) / 100)
    return header, rows + make_oracle_rows_ii(experiments.oracles.get(object_name), best)


def make_oracle_rows_ii(oracle, coverage):
    """With how little the oracle has the coverage of the best method."""
    rows = []
    for name, covered, rule in ORACLE_ROWS if oracle and coverage > 0 else ():
        reach = oracle_reach(find_curve(oracle, covered, rule), coverage)
        figures = (str(reach[0]), f"{reach[1]:.2f}") if reach else (NONE, NONE)
        rows.append([name, NONE, NONE, figures[0], NONE, figures[1], NONE, NONE, NONE, f"≥ {100 * coverage:.2f}" if reach else NONE, NONE])
    return rows


def make_table_iii(experiments, object_name):
    header = ["method", "seeds"] + [f"{count} scans" for count in COUNTS]
    rows = []
    for method in experiments.methods:
        runs = experiments.of(object_name, method)
        if runs:
            rows.append([method, len(runs)] + [mean_and_spread([100 * run.coverage_after(count) for run in runs], 2) for count in COUNTS])
        if method in PAPER_TABLE_III:
            rows.append([f"{method}, the paper's putto", NONE] + [f"{value:.1f}" for value in PAPER_TABLE_III[method]])
    oracle = experiments.oracles.get(object_name)
    for name, covered, rule in ORACLE_ROWS if oracle else ():
        curve = find_curve(oracle, covered, rule)
        rows.append([name, NONE] + [f"{100 * oracle_after(curve, count):.2f}" for count in COUNTS])
    return header, rows


def make_reach_table(experiments, object_name):
    """Scans and metres to a coverage, and how many times the oracle's that is (by the scan; the point itself seen, in brackets)."""
    header = ["method", "seeds"]
    for share in REACHED:
        header += [f"scans to {100 * share:g} %", "× oracle", f"m to {100 * share:g} %", "× oracle"]
    oracle = experiments.oracles.get(object_name)
    rows = []
    for method in experiments.methods:
        runs = experiments.of(object_name, method)
        row = [method, len(runs)]
        for share in REACHED:
            row += compare_reach(runs, oracle, share)
        if runs:
            rows.append(row)
    for name, covered, rule in ORACLE_ROWS if oracle else ():
        reaches = [oracle_reach(find_curve(oracle, covered, rule), share) for share in REACHED]
        cells = [(str(reach[0]), NONE, f"{reach[1]:.2f}", NONE) if reach else (NONE,) * 4 for reach in reaches]
        rows.append([name, NONE] + [cell for group in cells for cell in group])
    return header, rows


def compare_reach(runs, oracle, share):
    counts = [run.scans_to(share) for run in runs]
    fulfilled = [count for count in counts if count is not None]
    if not fulfilled:
        return [NONE] * 4
    note = "" if len(fulfilled) == len(counts) else f" ({len(fulfilled)} of {len(counts)})"
    metres = [run.path_after(count) for run, count in zip(runs, counts) if count is not None]
    cells = []
    for k, (values, digits) in enumerate(((fulfilled, 1), (metres, 2))):
        reaches = [oracle_reach(find_curve(oracle, covered, "scan"), share) for covered in ("partner", "seen")] if oracle else [None, None]
        ratios = [f"{statistics.fmean(values) / reach[k]:.2f}" if reach else NONE for reach in reaches]
        cells += [mean_and_spread(values, digits) + note, f"{ratios[0]} ({ratios[1]})"]
    return cells


def make_means(experiments):
    """Over the objects, each with the mean of its seeds; only methods that were run on all of them."""
    objects = sorted({run.object for run in experiments.runs})
    header = ["method", "objects", "scans", "path m", "s per selection", "coverage %"] + [f"% after {count}" for count in COUNTS]
    rows = []
    for method in experiments.methods:
        groups = [experiments.of(name, method) for name in objects]
        if not all(groups):
            continue
        figures = [[figures_at_end(run)[0] for run in runs] for runs in groups]
        row = [method, len(objects)]
        for k, digits in enumerate((1, 2, 3, 2)):
            means = [statistics.fmean(figure[k] for figure in group) for group in figures if all(figure[k] is not None for figure in group)]
            row.append(f"{statistics.fmean(means):.{digits}f}" if means else NONE)
        for count in COUNTS:
            row.append(f"{statistics.fmean(statistics.fmean(100 * run.coverage_after(count) for run in runs) for runs in groups):.2f}")
        rows.append(row)
    for name, covered, rule in ORACLE_ROWS if objects and all(name in experiments.oracles for name in objects) else ():
        curves = [find_curve(experiments.oracles[name_], covered, rule) for name_ in objects]
        rows.append([name, len(objects), NONE, NONE, NONE, NONE] + [f"{statistics.fmean(100 * oracle_after(c, count) for c in curves):.2f}" for count in COUNTS])
    return header, rows


def make_quality_table(experiments, object_name):
    """After the last scan of each run."""
    header = ["method", "seeds", "scans done", "ended because", "completeness %", "RMS error mm", "of what can be seen %", "slowest selection s", "refused measurements",
              "s of wall time"]
    rows = []
    for method in experiments.methods:
        runs = experiments.of(object_name, method)
        if not runs:
            continue
        reports = [run.report for run in runs]
        ends = sorted({report["end_reason"] for report in reports})
        slowest = [max((scan["selection_s"] or 0.0 for scan in report["scans"]), default=None) for report in reports]
        rows.append([method, len(runs), mean_and_spread([report["n_scans"] for report in reports], 1), ", ".join(ends),
                     mean_and_spread([100 * report["completeness"] for report in reports], 2), mean_and_spread([report["rmse_mm"] for report in reports], 3),
                     mean_and_spread([100 * report["observable_coverage"] for report in reports], 2), f"{max(slowest):.2f}",
                     mean_and_spread([report["refused_measurements"] for report in reports], 0),
                     mean_and_spread([report["wall_s"] for report in reports], 0)])
    return header, rows


def make_motion_table(experiments, object_name):
    """The audit of every executed motion against the true scene: counts are sums over the seeds. Without rows if no run was audited."""
    audited = {method: [run.report for run in experiments.of(object_name, method) if run.report.get("motion_faults")] for method in experiments.methods}
    kinds = list(dict.fromkeys(kind for reports in audited.values() for report in reports for kind in report["motion_faults"]))
    header = ["method", "seeds", "states"] + [kind.replace("_", " ") for kind in kinds] + ["nearest mm", "robot min", "plan ms, median", "plan ms, 95 % below"]
    rows = []
    for method, reports in audited.items():
        if not reports:
            continue
        rows.append([method, len(reports), sum(report["states"] for report in reports)]
                    + [sum(report["motion_faults"][kind]["count"] for report in reports) for kind in kinds]
                    + [f"{min(report['nearest_mm'] for report in reports):.1f}", mean_and_spread([report["robot_time_s"] / 60 for report in reports], 1)]
                    + [mean_and_spread([report["motion_plans"][key] for report in reports], 1) for key in ("median_ms", "p95_ms")])
    return header, rows


def make_arm_error_table(experiments, object_name):
    """What the arm's error costs: the model as it was streamed, with the scans registered with each other, and as a shape. Without rows if there was no arm."""
    header = ["method", "seeds"] + [f"{model}: {figure}" for model in ("as streamed", "registered", "as a shape") for figure in ("of what can be seen %", "RMS error mm")]
    header += ["scans moved mm", "shape moved mm"]
    rows = []
    for method in experiments.methods:
        reports = [run.report for run in experiments.of(object_name, method) if run.report.get("registration") and run.report.get("shape")]
        if not reports:
            continue
        models = [[report["registration"]["as_streamed"] for report in reports], reports, [report["shape"] for report in reports]]
        rows.append([method, len(reports)]
                    + [mean_and_spread([factor * model[key] for model in group], digits) for group in models for key, factor, digits in (("observable_coverage", 100, 2), ("rmse_mm", 1, 3))]
                    + [mean_and_spread([report["registration"]["mean_correction_mm"] for report in reports], 2),
                       mean_and_spread([report["shape"]["moved_mm"] for report in reports], 2)])
    return header, rows


def make_verdict_table(experiments, object_name):
    """What became of the candidates after the last scan of the runs, in the mean: why they were not scanned."""
    methods = [method for method in experiments.methods if experiments.of(object_name, method)]
    reports = {method: [run.report["last_verdicts"] for run in experiments.of(object_name, method)] for method in methods}
    rated = {method: [sum_verdicts(run.report) for run in experiments.of(object_name, method)] for method in methods}
    names = sorted({name for group in rated.values() for verdicts in group for name, count in verdicts.items() if count})
    header = ["method"] + names
    rows = [[method] + [f"{statistics.fmean(v.get(name, 0) for v in rated[method]):.0f}"
                        + (f" ({statistics.fmean(v.get(name, 0) for v in reports[method]):.0f})" if any(v.get(name, 0) for v in reports[method]) else "")
                        for name in names] for method in methods]
    return header, rows


def sum_verdicts(report):
    total = dict(report["last_verdicts"])
    for scan in report["scans"]:
        for name, count in scan["verdicts"].items():
            total[name] = total.get(name, 0) + count
    return total


def make_rim_table(experiments, object_name):
    """Length in m of what is left of the mesh's border, by why the surface beyond it is missing."""
    return make_kinds_table(experiments, object_name, "rims_m", ("rim m", lambda report: report["rim_length_m"]), 1)


def make_missing_table(experiments, object_name):
    """Share of the true surface that is missing in %, by why."""
    return make_kinds_table(experiments, object_name, "missing", ("missing %", lambda report: 100 * (1 - report["coverage"])), 100)


def make_kinds_table(experiments, object_name, key, whole, factor):
    runs = [run for run in experiments.runs if run.object == object_name and run.report.get(key)]
    kinds = list(dict.fromkeys(kind for run in runs for kind in run.report[key]))
    rows = []
    for method in experiments.methods:
        reports = [run.report for run in runs if run.method == method]
        if reports:
            rows.append([method, mean_and_spread(list(map(whole[1], reports)), 2)]
                        + [mean_and_spread([factor * report[key].get(kind, 0.0) for report in reports], 2) for kind in kinds])
    return ["method", whole[0]] + [kind.replace("_", " ") for kind in kinds], rows


WANTED_TEXT = f"{100 * WANTED_COMPLETENESS:g} %"
