"""A real object: nothing is known of it but a box, and a profiler of one's own answers in place of the simulator."""

import json
import math
import os
import re
import struct
import subprocess
import unittest

from run_testing import BINARY, WholeRunTest

RADIUS_M, MIDDLE_M = 0.05, (0.0, 0.0, 0.06)  # Of the ball that tests/whole/ball_profiler.cc measures.


def read_vertices(ply):
    header, data = ply.split(b"end_header\n", 1)
    lines = header.decode().splitlines()
    count = int(next(line.split()[2] for line in lines if line.startswith("element vertex")))
    first_face = next(i for i, line in enumerate(lines) if line.startswith("element face"))
    sizes = {"float": 4, "int": 4, "uint": 4, "ushort": 2, "uchar": 1}
    stride = sum(sizes[line.split()[1]] for line in lines[:first_face] if line.startswith("property"))
    return [struct.unpack_from("<3f", data, i * stride) for i in range(count)]


class Hardware(WholeRunTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_folder = cls.folder / "ball"
        launch = cls.start("launch", "hardware", "robot", "--box", "0.12,0.12,0.12", "--max-scans", 4, "--out", cls.run_folder)
        said = ""
        while "LCM_DEFAULT_URL=" not in said:
            line = launch.stdout.readline()
            assert line, launch.communicate()[1]
            said += line
        url = re.search("LCM_DEFAULT_URL='(.*)'", said)[1]
        profiler = subprocess.Popen([*cls.find_namespace(launch), BINARY / "tests/ball_profiler", "--run", cls.run_folder, "--lcm-url", url])
        cls.addClassCleanup(profiler.wait)
        cls.addClassCleanup(profiler.terminate)
        cls.output, cls.errors = cls.finish(launch)
        cls.report = json.loads((cls.run_folder / "report.json").read_text())

    @staticmethod
    def find_namespace(launch):
        """Where there is no route for multicast and no right to make one, a set lives in a network namespace of its own."""
        if os.readlink(f"/proc/{launch.pid}/ns/net") == os.readlink("/proc/self/ns/net"):
            return []
        return ["nsenter", "--user", "--net", "--preserve-credentials", "-t", str(launch.pid)]

    def test_the_model_is_the_ball(self):
        vertices = read_vertices((self.run_folder / "model.ply").read_bytes())
        self.assertGreater(len(vertices), 2000)
        self.assertLess(max(abs(math.dist(v, MIDDLE_M) - RADIUS_M) for v in vertices), 0.0005)

    def test_there_is_no_truth_to_rate_it_by(self):
        self.assertEqual("", self.errors)
        for key in ("object", "coverage", "observable_coverage", "rmse_mm"):
            self.assertIn(key, self.report)
            self.assertIsNone(self.report[key], key)
        self.assertGreater(self.report["completeness"], 0.9)
        text = re.sub("base64,[^']*", "", (self.run_folder / "report.html").read_text())
        self.assertIn("<td class='text'>object</td><td class='text'>a real object</td>", text)
        self.assertIsNone(re.search(r"\bnan\b", text))

    def assert_refused(self, script, *arguments, says):
        output, errors = self.finish(self.start(script, *arguments, "--out", self.folder / "refused"), code=1)
        self.assertEqual(("", 1), (output, errors.count("\n")), errors)
        self.assertIn(says, errors)
        self.assertFalse((self.folder / "refused").exists())

    def test_hardware_is_not_let_loose_on_the_default_object(self):
        self.assert_refused("launch", "hardware", says="--box X,Y,Z")

    def test_a_box_that_is_none_is_refused(self):
        self.assert_refused("launch", "hardware", "--box", "0.1,0.1", says="--box: At least 3 required but received 2")
        self.assert_refused("launch", "hardware", "--box", "0.1,0.1,-0.1", says="must all be above 0")
        self.assert_refused("launch", "hardware", "--box", "0.1,0.1,0.1", "--object", "statue", says="--box")

    def test_a_simulation_wants_a_mesh(self):
        self.assert_refused("scan", "--box", "0.1,0.1,0.1", says="scripts/launch hardware")


if __name__ == "__main__":
    unittest.main()
