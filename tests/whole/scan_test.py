"""Whole runs with real processes on a real bus: complete, repeatable, and the same whatever happens to a service or a datagram."""

import json
import os
import re
import signal
import unittest

from run_testing import SOURCE, WholeRunTest, wait_until

RUN_FILES = ["run.yaml", "bus.lcm", "streams", "model.ply", "voxels.ot", "report.json", "report.html", "logs"]
REPORT_KEYS = ["method", "object", "cell", "seed", "version", "end_reason", "failed", "n_scans", "path_length_m", "mean_selection_s", "completeness", "coverage",
               "observable_coverage", "rmse_mm", "rim_length_m", "triangles", "wall_s", "scans"]
SCAN_KEYS = ["scan", "source", "gain", "path_length_m", "stripes", "selection_s", "completeness", "coverage", "candidates", "verdicts"]


class Scan(WholeRunTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.output, cls.errors = cls.finish(cls.start_scan("reference"))
        cls.reference = cls.folder / "reference"
        cls.model = (cls.reference / "model.ply").read_bytes()
        cls.stripe_bytes = (cls.reference / "streams/STRIPE.lcm").stat().st_size

    def assert_same_model(self, name):
        self.assertTrue(self.model == (self.folder / name / "model.ply").read_bytes(), "model.ply differs from that of the undisturbed run")

    def pid_of(self, name, service):
        log = (self.folder / name / "logs/supervisor.log").read_text()
        return int(re.findall(rf"started {service}, process (\d+)", log)[-1])

    def wait_for_share(self, name, share):
        """Until this share of the run's stripes has been published."""
        file = self.folder / name / "streams/STRIPE.lcm"
        wait_until(lambda: file.exists() and file.stat().st_size > share * self.stripe_bytes, f"{share:.0%} of the run", seconds=120)

    def test_leaves_a_complete_run_folder(self):
        self.assertEqual([], [name for name in RUN_FILES if not (self.reference / name).exists()])
        report = json.loads((self.reference / "report.json").read_text())
        self.assertEqual([], [key for key in REPORT_KEYS if key not in report])
        self.assertEqual([], [key for scan in report["scans"] for key in SCAN_KEYS if key not in scan])
        self.assertEqual((False, report["n_scans"]), (report["failed"], len(report["scans"])))

    def test_scans_most_of_the_object(self):
        report = json.loads((self.reference / "report.json").read_text())
        self.assertEqual(("BH/IG", "free", 3), (report["method"], report["cell"], report["seed"]))
        self.assertGreaterEqual(report["n_scans"], 2)
        self.assertGreater(report["coverage"], 0.5)

    def test_shows_a_line_per_scan(self):
        report = json.loads((self.reference / "report.json").read_text())
        sources = re.findall(r"^ *\d+ +(first|boundary|hole|sphere) .*%", self.output, re.MULTILINE)
        self.assertEqual([scan["source"] for scan in report["scans"]], sources)
        self.assertEqual("", self.errors)

    def test_leaves_no_edge_with_more_than_two_triangles(self):
        counts = {}
        for triangle in read_triangles(self.model):
            for i in range(3):
                edge = tuple(sorted((triangle[i], triangle[(i + 1) % 3])))
                counts[edge] = counts.get(edge, 0) + 1
        self.assertGreater(len(counts), 1000)
        self.assertLessEqual(max(counts.values()), 2)

    def test_twice_side_by_side_gives_the_same_model(self):
        processes = [self.start_scan("left"), self.start_scan("right")]
        for process in processes:
            self.finish(process)
        self.assert_same_model("left")
        self.assert_same_model("right")
        self.assert_nothing_runs()

    def kill_in_turn(self, name, services, kind=signal.SIGKILL):
        """A run in which each service is killed once, evenly over the run."""
        process = self.start_scan(name)
        for number, service in enumerate(services):
            self.wait_for_share(name, (number + 1) / (len(services) + 1))
            os.kill(self.pid_of(name, service), kind)
        _, errors = self.finish(process)
        self.assertEqual([f"supervisor: {service} died of signal {kind.name.removeprefix('SIG')}; started again" for service in services], errors.splitlines())
        self.assert_same_model(name)
        self.assert_nothing_runs()

    def test_with_killed_map_and_planner_gives_the_same_model(self):
        self.kill_in_turn("killed", ["mesher", "voxelmap", "planner"])

    def test_with_killed_hardware_and_coordinator_gives_the_same_model(self):
        self.kill_in_turn("killed_too", ["sensor", "robot", "simulator", "coordinator", "reporter"])

    def test_with_services_that_are_told_to_stop_gives_the_same_model(self):
        self.kill_in_turn("stopped", ["mesher", "planner", "robot", "reporter"], signal.SIGTERM)

    def test_with_lost_datagrams_gives_the_same_model(self):
        self.finish(self.start_scan("dropped", NBS_SERVICE_OPTIONS="--drop 0.05 --drop-seed 7"))
        self.assert_same_model("dropped")

    def test_that_sees_nothing_has_failed(self):
        cell = self.folder / "blind.yaml"
        text = (SOURCE / "sim/cells/free.yaml").read_text()
        self.assertIn("first_standoff_m: 0.20\n", text)
        cell.write_text(text.replace("first_standoff_m: 0.20\n", "first_standoff_m: 0.60\n"))
        _, errors = self.finish(self.start_scan("blind", "--cell", cell), code=2)
        self.assertEqual("the run failed: No scan has seen any surface: does the first path look at it?\n", errors)
        report = json.loads((self.folder / "blind/report.json").read_text())
        self.assertEqual((True, 1), (report["failed"], report["n_scans"]))

    def test_interrupted_keeps_what_was_scanned(self):
        process = self.start_scan("interrupted")
        self.wait_for_share("interrupted", 0.6)
        os.killpg(process.pid, signal.SIGINT)
        self.finish(process, code=130)
        report = json.loads((self.folder / "interrupted/report.json").read_text())
        self.assertGreaterEqual(report["n_scans"], 1)
        self.assertTrue(report["failed"])
        self.assertGreater((self.folder / "interrupted/model.ply").stat().st_size, 1000)
        self.assert_nothing_runs()


def read_triangles(ply):
    """The triangles of a binary little-endian PLY whose faces are `list uchar int` or `list uchar uint`."""
    import struct

    header, body = ply.split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    vertices = int(next(line for line in lines if line.startswith("element vertex")).split()[2])
    faces = int(next(line for line in lines if line.startswith("element face")).split()[2])
    sizes = {"float": 4, "float32": 4, "double": 8, "float64": 8, "uchar": 1, "uint8": 1, "int": 4, "uint": 4}
    vertex_lines = lines[next(i for i, line in enumerate(lines) if line.startswith("element vertex")) + 1 :]
    stride = 0
    for line in vertex_lines:
        if line.startswith("element"):
            break
        stride += sizes[line.split()[1]]
    return [struct.unpack_from("<3i", body, vertices * stride + 13 * i + 1) for i in range(faces)]


if __name__ == "__main__":
    unittest.main()
