"""usage: python3 experiments_page DIR: writes index.html, results.md and plots/ from the runs in a folder of scripts/experiments."""

import pathlib
import sys

import document
import plots
import runs
import tables

RIM_TEXT = ("Length in m of the mesh's border after the last scan, by why the surface beyond it is missing (sim/remainder.h). open: nothing stands in the way, it could have been scanned; no room: "
            "the sensor's body does not fit anywhere from where it could be measured; base: only the table is in the way; depth of field: too narrow, lines of sight end before the nearest depth; "
            "occluded: hidden by the object itself; seam: beside it nothing is missing, a crack or a gap of a few millimetres. Why the planner left what is open stands in the table of verdicts.")
MISSING_TEXT = "Share of the true surface that is missing, in %, by the same reasons; the mean over the seeds."


def write(file, text):
    """Whole or not at all."""
    temporary = file.with_name(file.name + ".tmp")
    temporary.write_text(text, encoding="utf-8")
    temporary.rename(file)


def add_summary(page, experiments):
    settings = experiments.settings
    page.text("Runs of real service sets on simulated scans (Kriegel et al., Next-Best-Scan Planning for Autonomous 3D Modeling, IROS 2012, section IV-B). The paper's putto is not public: figures "
              "of other objects stand beside its figures for orientation. ± is the standard deviation over the seeds.")
    page.code(settings.get("command", "scripts/experiments"))
    versions = sorted({run.report["version"] for run in experiments.runs})
    page.table(["setting", "value"], [[key, value] for key, value in settings.items() if key != "command"] + [["versions", ", ".join(versions) or tables.NONE]])
    if len(versions) > 1:
        page.text("Runs of several versions of the software stand side by side here: figures that are to be compared want a folder of their own.")
    if experiments.failures:
        page.heading("Runs that failed")
        page.table(["object", "method", "seed", "reason"], [[f.object, f.method, f.seed, f.reason] for f in experiments.failures])
    if experiments.runs:
        page.heading("Mean over the objects")
        page.table(*tables.make_means(experiments))


def add_object(page, experiments, name):
    page.heading(name)
    page.heading(f"Table II: where each method ends (mesh completeness {tables.WANTED_TEXT} and a mesh that has stopped growing, or its own rule)", 3)
    page.text("Read off the same runs as Table III at the first scan that fulfils the end rule. The oracle's rows say with how little it has the coverage of the best method.")
    page.table(*tables.make_table_ii(experiments, name))
    page.heading("Table III: coverage in % after so many scans, without an end rule", 3)
    page.text("A run that has nothing left to scan keeps its coverage.")
    page.table(*tables.make_table_iii(experiments, name))
    page.heading("Scans and path length to a coverage", 3)
    page.text("× oracle: times what the oracle needs by scans; in brackets where only points seen themselves count for it.")
    page.table(*tables.make_reach_table(experiments, name))
    page.pictures([add_plots(experiments, name)])
    add_figure_3(page, experiments, name)
    page.heading("After the last scan", 3)
    page.table(*tables.make_quality_table(experiments, name))
    add_arm_error(page, experiments, name)
    add_motions(page, experiments, name)
    add_rims(page, experiments, name)


def add_arm_error(page, experiments, name):
    header, rows = tables.make_arm_error_table(experiments, name)
    if rows:
        page.heading("What the arm's error costs", 3)
        page.text("The model as it was streamed; with all scans registered with each other, about their mean, after the run (all other tables rate this one, but for coverage scan by scan); "
                  "and laid onto the true object by the best rigid motion, since what moves all of the model alike says nothing about its shape.")
        page.table(header, rows)


def add_motions(page, experiments, name):
    header, rows = tables.make_motion_table(experiments, name)
    if rows:
        page.heading("Motions", 3)
        page.text("Every executed motion against the true scene, in steps of at most 10 mm: counts of contacts and of violated limits, summed over the seeds; robot min: simulated time.")
        page.table(header, rows)


def add_rims(page, experiments, name):
    header, rows = tables.make_rim_table(experiments, name)
    if rows:
        page.heading("What is left open", 3)
        page.text(RIM_TEXT)
        page.table(header, rows)
        page.text(MISSING_TEXT)
        page.table(*tables.make_missing_table(experiments, name))
    page.heading("Verdicts on the candidates", 3)
    page.text("Mean over the seeds, counted in every round; in brackets those of the rounds after the last scan.")
    page.table(*tables.make_verdict_table(experiments, name))


def find_picture(experiments, name, method, count, side):
    """The picture of the lowest seed that has one."""
    for run in experiments.of(name, method):
        file = run.folder / "pictures" / f"after-{count:02}-{side}.png"
        if file.exists():
            ended = f" (it ended after {len(run.scans)})" if len(run.scans) < count else ""
            return str(file.relative_to(experiments.folder)), f"{method}, seed {run.seed}, after {count} scans{ended}: {100 * run.coverage_after(count):.1f} %"
    return None


def add_figure_3(page, experiments, name):
    for side in ("front", "back"):
        rows = [[find_picture(experiments, name, method, count, side) for count in (5, 15, 30)] for method in ("S/IG", "BH/IG")]
        rows = [[picture for picture in row if picture] for row in rows if any(row)]
        if rows:
            page.heading(f"Fig. 3: the mesh after 5, 15 and 30 scans, {side}; red: its border, around holes and at the rim", 3)
            page.pictures(rows)


def add_plots(experiments, name):
    """Draws coverage over scans and over path length; their places in the page."""
    pictures = []
    for over, label in (("scans", "scans"), ("path", "path length, m")):
        curves, x_max = [], 1.0
        for number, method in enumerate(experiments.methods):
            lines = [make_line(run, over) for run in experiments.of(name, method)]
            if lines:
                colour = plots.COLOURS[number % len(plots.COLOURS)]
                x_max = max([x_max] + [line[-1][0] for line in lines])
                curves += [plots.Curve("", colour, line, width=0.8, opacity=0.35) for line in lines if len(lines) > 1]
                curves.append(plots.Curve(method, colour, average_lines(lines)))
        curves += make_oracle_curves(experiments.oracles.get(name), over)
        lowest = min((point[1] for curve in curves if curve.label for point in curve.points if point[0] >= 0.15 * x_max), default=50.0)
        y_range = (max(0.0, min(90.0, 10.0 * (lowest // 10))), 100.0)
        file = experiments.folder / "plots" / f"{name}-{over}.svg"
        file.parent.mkdir(exist_ok=True)
        write(file, plots.make_plot(curves, label, "coverage, %", (0.0, x_max), y_range))
        pictures.append((f"plots/{file.name}", f"coverage over {'scans' if over == 'scans' else 'path length'}; thin: each seed"))
    return pictures


def make_line(run, over):
    counts = range(1, len(run.scans) + 1)
    return [(count if over == "scans" else run.path_after(count), 100 * run.coverage_after(count)) for count in counts]


def average_lines(lines):
    """As far as the longest; a line that has ended keeps its last value."""
    x_values = sorted({x for line in lines for x, _ in line})
    return plots.average(lines, [x for x in x_values if x >= max(line[0][0] for line in lines)])


def make_oracle_curves(oracle, over):
    if not oracle:
        return []
    rule = "scan" if over == "scans" else "metre"
    curves = []
    for label, covered, dashed in (("oracle", "partner", False), ("oracle, itself seen", "seen", True)):
        curve = tables.find_curve(oracle, covered, rule)
        x_values = range(1, len(curve["coverage"]) + 1) if over == "scans" else curve["path_length_m"]
        points = list(zip(x_values, (100 * value for value in curve["coverage"])))
        curves.append(plots.Curve(label + (", by the metre" if over == "path" else ""), plots.ORACLE_COLOUR, points, dashed=dashed))
    return curves


def main(arguments):
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 1
    folder = pathlib.Path(arguments[0])
    experiments = runs.read_experiments(folder)
    page = document.Document("Experiments")
    add_summary(page, experiments)
    for name in experiments.objects():
        add_object(page, experiments, name)
    write(folder / "index.html", page.as_html())
    write(folder / "results.md", page.as_markdown())
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except OSError as error:
        print(f"the page could not be written: {error.filename}: {error.strerror}", file=sys.stderr)
        sys.exit(2)
