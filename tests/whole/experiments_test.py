"""scripts/experiments with real services: what it leaves, that it goes on where it was, and that a run that fails stops no other."""

import json
import os
import shutil
import signal
import unittest

from run_testing import BINARY, WholeRunTest, list_service_processes, wait_until

# Fails for one method and seed, as long as the file `broken` is there; otherwise is the planner.
FRAGILE_PLANNER = """#!/bin/bash
for ((i = 1; i < $#; ++i)); do [[ ${{!i}} != --run ]] || {{ next=$((i + 1)); run=${{!next}}; }}; done
if [[ -e {folder}/broken && $run == */B-IG/seed2 ]]; then echo "the planner broke" >&2; exit 2; fi
exec {binary}/bin/nbs-planner "$@"
"""
# Stands in for ssh HOST -- COMMAND: notes the host and runs the command here, in a login shell's environment.
FAKE_SSH = """#!/bin/bash
echo "$1" >>{folder}/hosts
export SHELL=/bin/bash
shift 2
exec bash -c "$*"
"""


class Experiments(WholeRunTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        build = cls.folder / "build"
        (build / "bin").mkdir(parents=True)
        for program in (BINARY / "bin").iterdir():
            (build / "bin" / program.name).symlink_to(program)
        cls.write_program(build / "bin/nbs-planner", FRAGILE_PLANNER)
        cls.environment = dict(cls.environment, NBS_BUILD_DIR=str(build))

    @classmethod
    def write_program(cls, file, text):
        file.unlink(missing_ok=True)
        file.write_text(text.format(folder=cls.folder, binary=BINARY))
        file.chmod(0o755)

    def experiments(self, name, *arguments, code=0, seeds="1-2", **environment):
        """On the blob with two scans each; returns what it said."""
        process = self.start("experiments", "--objects", self.blob, "--methods", "BH/IG", "B/IG", "--seeds", seeds, "--max-scans", 2, "--oracle-paths", 40, "--jobs", 2,
                             "--out", self.folder / name, *arguments, **environment)
        return self.finish(process, code)

    def reports(self, name):
        return {str(file.parent.relative_to(self.folder / name / "runs")): file.stat().st_mtime_ns for file in (self.folder / name).glob("runs/*/*/*/report.json")}

    def test_failing_run_is_named_and_the_same_command_goes_on(self):
        (self.folder / "broken").touch()
        _, errors = self.experiments("resumed", code=2)
        self.assertIn("experiments: failed: blob, B/IG, seed 2: ", errors)
        self.assertIn("the planner broke", errors)
        self.assertIn("5 of 5, 1 failed", errors)
        page = (self.folder / "resumed/results.md").read_text()
        self.assertRegex(page, r"\| blob \| B/IG \| 2 \| .*the planner broke")
        first = {run: time for run, time in self.reports("resumed").items() if run != "blob/B-IG/seed2"}
        self.assertEqual({"blob/BH-IG/seed1", "blob/BH-IG/seed2", "blob/B-IG/seed1"}, set(first))

        # A run that was cut short: its report says so, or is not whole.
        cut = self.folder / "resumed/runs/blob/BH-IG/seed2/report.json"
        cut.write_text(cut.read_text()[:-100])
        (self.folder / "broken").unlink()
        output, errors = self.experiments("resumed")
        self.assertEqual(f"page: {self.folder}/resumed/index.html\n", output)
        self.assertIn("2 of 2, 0 failed", errors)
        second = self.reports("resumed")
        self.assertEqual([run for run in sorted(second) if second[run] != first.get(run)], ["blob/B-IG/seed2", "blob/BH-IG/seed2"])
        self.assertNotIn("the planner broke", (self.folder / "resumed/results.md").read_text())
        _, errors = self.experiments("resumed")
        self.assertEqual("", errors)
        self.check_page(self.folder / "resumed")
        self.assert_nothing_runs()

    def check_page(self, folder):
        page, html = (folder / "results.md").read_text(), (folder / "index.html").read_text()
        coverage = [json.loads((folder / f"runs/blob/BH-IG/seed{seed}/report.json").read_text())["coverage"] for seed in (1, 2)]
        self.assertRegex(page, rf"\| BH/IG \| 2 \| {100 * sum(coverage) / 2:.2f} ± ")
        oracle = json.loads((folder / "oracle/blob/oracle.json").read_text())
        self.assertIn(f"| oracle | – | {100 * oracle['curves'][0]['coverage'][4]:.2f} |", page)
        for file in ("plots/blob-scans.svg", "plots/blob-path.svg", "runs/blob/BH-IG/seed1/pictures/after-05-front.png"):
            self.assertTrue((folder / file).exists(), file)
            self.assertIn(file, page)
            self.assertIn(file, html)
        self.assertFalse((folder / "runs/blob/BH-IG/seed1/streams").exists())

    def test_interrupted_stops_all_and_leaves_what_is_done(self):
        process = self.start("experiments", "--objects", self.blob, "--methods", "BH/IG", "B/IG", "--seeds", "1-9", "--max-scans", 30, "--oracle-paths", 0, "--jobs", 2, "--out",
                             self.folder / "interrupted")
        wait_until(lambda: len(list_service_processes(str(self.folder / "interrupted"))) >= 10, "two runs have started")
        os.killpg(process.pid, signal.SIGINT)
        _, errors = self.finish(process, code=130)
        self.assertIn("interrupted; the same command goes on from here", errors)
        wait_until(lambda: not list_service_processes(str(self.folder / "interrupted")), "all services have ended", seconds=20)
        wait_until(lambda: not list((self.folder / "state/sets").glob("*")), "all scans have forgotten their sets", seconds=20)
        self.assert_nothing_runs()

    def test_runs_are_spread_over_the_hosts_of_a_file(self):
        self.write_program(self.folder / "ssh", FAKE_SSH)
        (self.folder / "logins").write_text("1/first.example\n1/second.example\n")
        _, errors = self.experiments("spread", "--sshloginfile", self.folder / "logins", seeds="1", PARALLEL_SSH=str(self.folder / "ssh"))
        self.assertIn("3 of 3, 0 failed", errors)
        hosts = (self.folder / "hosts").read_text().split()
        self.assertEqual({"first.example", "second.example"}, set(hosts))

    def test_end_is_read_off_where_a_run_with_the_end_rule_ends(self):
        self.finish(self.start("experiments", "--objects", self.blob, "--methods", "BH/IG", "--seeds", "3", "--max-scans", 12, "--oracle-paths", 0, "--out", self.folder / "ends"))
        self.finish(self.start("scan", "--object", self.blob, "--seed", 3, "--max-scans", 12, "--out", self.folder / "ended"))
        ended = json.loads((self.folder / "ended/report.json").read_text())
        self.assertEqual("completeness_reached", ended["end_reason"])
        self.assertLess(ended["n_scans"], 12)
        row = next(line for line in (self.folder / "ends/results.md").read_text().splitlines() if line.startswith("| BH/IG | 1 | 1 of 1"))
        self.assertEqual([f"{ended['n_scans']:.1f}", f"{ended['path_length_m']:.2f}", f"{100 * ended['coverage']:.2f}"], [row.split(" | ")[k] for k in (3, 5, 9)])

    def assert_refused(self, says, *arguments):
        out = self.folder / "refused"
        _, errors = self.finish(self.start("experiments", *arguments, "--out", out), code=1)
        self.assertEqual(1, errors.count("\n"), errors)
        self.assertIn(says, errors)
        self.assertFalse(out.exists())

    def test_bad_requests_are_refused_in_one_sentence(self):
        self.assert_refused("BHIG", "--objects", self.blob, "--methods", "BH/IG", "BHIG")
        self.assert_refused("nothing.ply", "--objects", self.blob, self.folder / "nothing.ply")
        self.assert_refused("5-2", "--objects", self.blob, "--seeds", "5-2")
        self.assert_refused("1..4", "--objects", self.blob, "--seeds", "1..4")
        self.assert_refused("--jobs", "--objects", self.blob, "--jobs", "0")
        self.assert_refused("--methods", "--objects", self.blob, "--methods")
        self.assert_refused("--colour", "--colour", "red")
        (self.folder / "two").mkdir()
        shutil.copy(self.blob, self.folder / "two")
        self.assert_refused("two objects are called blob", "--objects", self.blob, self.folder / "two/blob.ply")

    def test_folder_of_other_settings_is_refused(self):
        out = self.folder / "other"
        out.mkdir()
        (out / "settings").write_text("max-scans 7\ncell free\ncommand scripts/experiments\n")
        _, errors = self.experiments("other", code=1)
        self.assertIn("max-scans 7", errors)
        (out / "settings").rename(out / "letter")
        _, errors = self.experiments("other", code=1)
        self.assertIn("holds no experiments", errors)


if __name__ == "__main__":
    unittest.main()
