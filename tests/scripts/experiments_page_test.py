"""The page of scripts/experiments, on reports written by hand."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

SOURCE = pathlib.Path(os.environ.get("NBS_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
sys.path.insert(0, str(SOURCE / "scripts/experiments_page"))

import document  # noqa: E402
import plots  # noqa: E402
import runs  # noqa: E402
import tables  # noqa: E402


def make_scan(coverage, completeness=0.9, edges=1000, path_m=0.5, selection_s=0.2, **others):
    return dict(coverage=coverage, completeness=completeness, edges=edges, path_length_m=path_m, selection_s=selection_s, verdicts={"chosen": 1, "not_tried": 3}, **others)


def make_report(scans, end_reason="scan_limit", failed=False, **others):
    scans[0]["selection_s"] = None
    report = dict(end_reason=end_reason, failed=failed, version="1", n_scans=len(scans), coverage=scans[-1]["coverage"], completeness=scans[-1]["completeness"], rmse_mm=0.1,
                  observable_coverage=scans[-1]["coverage"], refused_measurements=0, rim_length_m=1.0, wall_s=10.0, last_verdicts={"no_gain": 2}, scans=scans)
    return dict(report, **others)


def make_run(scans, ends_by_completeness=True, **others):
    return runs.Run("putto", "BH/IG", 1, pathlib.Path("/nowhere"), make_report(scans, **others), ends_by_completeness)


def make_oracle():
    curve = {"coverage": [0.5, 0.96, 0.99, 1.0], "path_length_m": [0.5, 1.0, 1.5, 2.0]}
    return {"curves": [dict(curve, covered=covered, rule=rule, start=start) for covered in ("partner", "seen") for rule in ("scan", "metre") for start in ("free", "first_path")]}


class Run(unittest.TestCase):
    def test_that_has_ended_keeps_its_coverage(self):
        run = make_run([make_scan(0.3), make_scan(0.8)])
        self.assertEqual([0.3, 0.8, 0.8], [run.coverage_after(count) for count in (1, 2, 30)])

    def test_ends_when_a_complete_mesh_has_hardly_grown_twice_in_a_row(self):
        scans = [make_scan(0.3, 0.99, 1000), make_scan(0.5, 0.98, 1001), make_scan(0.7, 0.9875, 1020), make_scan(0.8, 0.9875, 1021), make_scan(0.9, 0.9875, 1031),
                 make_scan(1.0, 0.99, 1031)]
        self.assertEqual((5, True), make_run(scans).find_end())
        self.assertEqual((4, False), make_run(scans[:4]).find_end())

    def test_of_a_complete_mesh_ends_when_nothing_is_left_to_scan(self):
        scans = [make_scan(0.3, 0.99, 1000), make_scan(0.5, 0.99, 2000)]
        self.assertEqual((2, True), make_run(scans, end_reason="no_candidates").find_end())
        self.assertEqual((2, False), make_run(scans).find_end())
        scans[1]["completeness"] = 0.98
        self.assertEqual((2, False), make_run(scans, end_reason="no_candidates").find_end())

    def test_with_an_end_rule_of_its_own_ends_where_it_ended(self):
        scans = [make_scan(0.3, 0.99), make_scan(0.5, 0.99), make_scan(0.7, 0.99)]
        self.assertEqual((3, True), make_run(scans, ends_by_completeness=False, end_reason="no_candidates").find_end())
        self.assertEqual((3, False), make_run(scans, ends_by_completeness=False).find_end())

    def test_mean_selection_leaves_out_the_first_path(self):
        run = make_run([make_scan(0.3), make_scan(0.5, selection_s=0.1), make_scan(0.7, selection_s=0.4)])
        self.assertAlmostEqual(0.25, run.selection_after(3))
        self.assertIsNone(run.selection_after(1))

    def test_reaches_a_coverage_once(self):
        run = make_run([make_scan(0.3), make_scan(0.5), make_scan(0.49)])
        self.assertEqual((2, None), (run.scans_to(0.5), run.scans_to(0.6)))


class Figures(unittest.TestCase):
    def test_have_a_spread_from_two_seeds_on(self):
        self.assertEqual(["2.0 ± 1.4", "3.0", "–", "1.0"], [tables.mean_and_spread(values, 1) for values in ([1, 3], [3], [None], [1, None])])

    def test_of_the_oracle_are_its_first_scan_with_the_coverage(self):
        curve = tables.find_curve(make_oracle(), "seen", "metre")
        self.assertEqual([(2, 1.0), (1, 0.5), (4, 2.0)], [tables.oracle_reach(curve, coverage) for coverage in (0.96, 0.1, 1.0)])
        self.assertIsNone(tables.oracle_reach(dict(curve, coverage=[0.5]), 0.6))

    def test_are_compared_with_both_oracles(self):
        run = make_run([make_scan(0.3), make_scan(0.5), make_scan(0.7), make_scan(0.96)])
        self.assertEqual(["4.0", "2.00 (2.00)", "2.00", "2.00 (2.00)"], tables.compare_reach([run], make_oracle(), 0.95))
        self.assertEqual(["–"] * 4, tables.compare_reach([run], make_oracle(), 0.99))


class Plot(unittest.TestCase):
    def test_is_an_svg_whose_text_is_escaped(self):
        svg = plots.make_plot([plots.Curve("<a & b>", "red", [(0, 0), (1, 50)])], "x", "y", (0.0, 1.0), (0.0, 100.0))
        texts = [element.text for element in xml.etree.ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}text")]
        self.assertIn("<a & b>", texts)
        self.assertIn("0.2", texts)

    def test_averages_lines_between_their_points(self):
        self.assertEqual([(1, 15.0), (2, 25.0), (3, 30.0)], plots.average([[(0, 0), (2, 20)], [(1, 20), (2, 30), (3, 40)]], [1, 2, 3]))


class Page(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="nbs-page-"))
        self.addCleanup(shutil.rmtree, self.folder)
        (self.folder / "settings").write_text("max-scans 30\ncell free\ncommand scripts/experiments --seeds 1-2\n")
        (self.folder / "methods").write_text("BH/IG completeness\nS/IG completeness\nB nothing_left\n")

    def add_run(self, object_name, method, seed, report):
        place = self.folder / "runs" / object_name / method / f"seed{seed}"
        place.mkdir(parents=True)
        (place / "report.json").write_text(json.dumps(report))

    def make_page(self):
        result = subprocess.run([sys.executable, "-B", SOURCE / "scripts/experiments_page", self.folder], capture_output=True, text=True)
        self.assertEqual((0, ""), (result.returncode, result.stderr))
        return (self.folder / "results.md").read_text()

    def test_shows_mean_and_spread_beside_the_paper(self):
        for seed, coverage in ((1, 0.90), (2, 0.94)):
            self.add_run("putto", "BH-IG", seed, make_report([make_scan(0.3), make_scan(coverage)]))
        page = self.make_page()
        self.assertIn("| BH/IG | 2 | 92.00 ± 2.83 | 92.00 ± 2.83 |", page)
        self.assertIn("| BH/IG, the paper's putto | – | 80.1 | 97.9 | 99.2 | 99.6 | 99.8 | 99.8 |", page)
        self.assertIn("| BH/IG | 2 | 0 of 2 | 2.0 ± 0.0 | 11 | 1.00 ± 0.00 | 4.4 | 0.200 ± 0.000 | 7.1 | 92.00 ± 2.83 | 99.0 |", page)
        self.assertIn("scripts/experiments --seeds 1-2", page)

    def test_mean_over_objects_weighs_them_equally(self):
        for object_name, seed, coverage in (("a", 1, 0.8), ("b", 1, 0.9), ("b", 2, 1.0)):
            self.add_run(object_name, "BH-IG", seed, make_report([make_scan(0.3), make_scan(coverage)]))
        self.add_run("a", "B", 1, make_report([make_scan(0.3), make_scan(0.4)]))
        section = self.make_page().split("## Mean over the objects")[1].split("\n## ")[0]
        self.assertIn("| BH/IG | 2 | 2.0 | 1.00 | 0.200 | 87.50 |", section)
        self.assertNotIn("| B |", section)

    def test_variant_of_a_method_stands_after_it(self):
        for method in ("BH-IG+sum", "S-IG", "BH-IG"):
            self.add_run("putto", method, 1, make_report([make_scan(0.3), make_scan(0.9)]))
        self.assertEqual(["BH/IG", "BH/IG:sum", "S/IG"], runs.read_experiments(self.folder).methods)

    def test_names_failed_runs_and_leaves_out_what_is_not_whole(self):
        self.add_run("putto", "BH-IG", 1, make_report([make_scan(0.3), make_scan(0.9)]))
        self.add_run("putto", "BH-IG", 2, make_report([make_scan(0.3)], end_reason="no_candidates", failed=True))
        (self.folder / "runs/putto/BH-IG/seed2.failed").write_text("out of | luck\n")
        page = self.make_page()
        self.assertIn("| putto | BH/IG | 2 | out of \\| luck |", page)
        self.assertEqual([1], [run.seed for run in runs.read_experiments(self.folder).runs])

    def test_takes_a_run_for_done_that_the_scripts_take_for_done(self):
        for seed, failed, cut in ((1, False, 0), (2, True, 0), (3, False, 2)):
            self.add_run("putto", "BH-IG", seed, {})
            place = self.folder / f"runs/putto/BH-IG/seed{seed}"
            text = json.dumps(make_report([make_scan(0.3)], failed=failed), indent=2) + "\n"
            (place / "report.json").write_text(text[:len(text) - cut])
            done = subprocess.run(["bash", "-c", 'source "$1" && run_done "$2"', "bash", SOURCE / "scripts/experiments_job.sh", place]).returncode == 0
            self.assertEqual((seed == 1, seed == 1), (done, runs.read_report(place) is not None))

    def test_says_when_runs_of_several_versions_are_mixed(self):
        self.add_run("putto", "BH-IG", 1, make_report([make_scan(0.3), make_scan(0.9)]))
        self.assertNotIn("several versions", self.make_page())
        self.add_run("putto", "BH-IG", 2, dict(make_report([make_scan(0.3), make_scan(0.9)]), version="2"))
        self.assertIn("several versions", self.make_page())

    def test_of_no_runs_is_made(self):
        (self.folder / "runs").mkdir()
        self.assertTrue(self.make_page().startswith("# Experiments\n"))

    def test_oracle_stands_in_the_tables(self):
        self.add_run("putto", "BH-IG", 1, make_report([make_scan(0.3), make_scan(0.97)]))
        (self.folder / "oracle/putto").mkdir(parents=True)
        (self.folder / "oracle/putto/oracle.json").write_text(json.dumps(make_oracle()))
        page = self.make_page()
        self.assertIn("| oracle | – | 100.00 | 100.00 |", page)
        self.assertIn("| oracle | – | – | 3 | – | 1.50 | – | – | – | ≥ 97.00 | – |", page)

    def test_rims_are_listed_by_kind(self):
        rims_m = {"occluded": 0.5, "seam": 0.25}
        self.add_run("putto", "BH-IG", 1, make_report([make_scan(0.3), make_scan(0.97)], rims_m=rims_m, missing={"occluded": 0.02, "open": 0.01}))
        page = self.make_page()
        self.assertIn("| method | rim m | occluded | seam |\n|---|---|---|---|\n| BH/IG | 1.00 | 0.50 | 0.25 |", page)
        self.assertIn("| method | missing % | occluded | open |\n|---|---|---|---|\n| BH/IG | 3.00 | 2.00 | 1.00 |", page)

    def test_an_arms_error_is_told_where_scans_were_registered(self):
        def make_model(coverage, rmse_mm):
            return {"observable_coverage": coverage, "rmse_mm": rmse_mm}

        for seed in (1, 2):
            self.add_run("putto", "BH-IG", seed, make_report([make_scan(0.3), make_scan(0.97)], registration={"mean_correction_mm": 0.25 * seed, "as_streamed": make_model(0.9, 1.25)},
                                                             shape=dict(make_model(0.99, 0.125), moved_mm=1.5)))
        self.add_run("putto", "S-IG", 1, make_report([make_scan(0.3), make_scan(0.97)], registration=None, shape=None))
        header, rows = tables.make_arm_error_table(runs.read_experiments(self.folder), "putto")
        self.assertEqual([["BH/IG", 2]], [row[:2] for row in rows])
        self.assertEqual(["90.00 ± 0.00", "1.250 ± 0.000", "97.00 ± 0.00", "0.100 ± 0.000", "99.00 ± 0.00", "0.125 ± 0.000", "0.38 ± 0.18", "1.50 ± 0.00"], rows[0][2:])
        self.assertEqual(len(header), len(rows[0]))

    def test_faults_of_motions_are_summed_over_the_seeds(self):
        for seed, contacts in ((1, 2), (2, 3)):
            faults = {"contact_object": {"count": contacts, "first": None}, "speed": {"count": 0, "first": None}}
            self.add_run("putto", "BH-IG", seed, make_report([make_scan(0.3), make_scan(0.97)], motion_faults=faults, states=100 * seed, nearest_mm=50.0 / seed,
                                                             robot_time_s=60.0 * seed, motion_plans={"median_ms": 4.0, "p95_ms": 8.0}))
        self.add_run("putto", "S-IG", 1, make_report([make_scan(0.3), make_scan(0.97)], motion_faults=None))
        page = self.make_page()
        self.assertIn("| contact object | speed | nearest mm |", page)
        self.assertIn("| BH/IG | 2 | 300 | 5 | 0 | 25.0 | 1.5 ± 0.7 | 4.0 ± 0.0 | 8.0 ± 0.0 |", page)
        self.assertNotIn("| S/IG | 0 |", page)

    def test_html_is_escaped(self):
        page = document.Document("a < b")
        page.table(["<x>"], [["1 & 2"]])
        self.assertIn("<th>&lt;x&gt;</th>", page.as_html())
        self.assertIn("<td>1 &amp; 2</td>", page.as_html())
        self.assertIn("<h1>a &lt; b</h1>", page.as_html())


if __name__ == "__main__":
    unittest.main()
