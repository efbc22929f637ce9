"""What a user can get wrong: one clear sentence, exit code 1, nothing left behind."""

import itertools
import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from blob import encode_ply, make_blob
from run_testing import SOURCE, WholeRunTest


class BadInput(WholeRunTest):
    numbers = itertools.count()

    def write(self, name, data):
        file = self.folder / name
        file.write_bytes(data)
        return file

    def assert_refused(self, *arguments, says, out=None, **environment):
        """`out`: a folder that exists already, or cannot be made; otherwise a new one, which must not be left."""
        is_new = out is None
        out = out or f"refused-{next(self.numbers)}"
        process = self.start("scan", *arguments, "--out", self.folder / out, **environment)
        output, errors = self.finish(process, code=1)
        self.assertEqual(("", 1), (output, errors.count("\n")), errors)
        for word in [says] if isinstance(says, str) else says:
            self.assertIn(word, errors)
        if is_new:
            self.assertFalse((self.folder / out).exists(), "a run folder was left")
        self.assert_nothing_runs()

    def test_missing_object_is_refused(self):
        self.assert_refused("--object", self.folder / "nothing.ply", says="nothing.ply")

    def test_object_that_is_a_folder_is_refused(self):
        self.assert_refused("--object", self.folder, says=str(self.folder))

    def test_truncated_object_is_refused(self):
        file = self.write("truncated.ply", self.blob.read_bytes()[:5000])
        self.assert_refused("--object", file, says="truncated.ply")

    def test_object_that_is_no_mesh_is_refused(self):
        file = self.write("letter.ply", b"Dear reader,\n")
        self.assert_refused("--object", file, says="letter.ply")

    def test_empty_object_is_refused(self):
        file = self.write("empty.stl", b"")
        self.assert_refused("--object", file, says="empty.stl")

    def test_object_of_an_unknown_format_is_refused(self):
        file = self.write("picture.jpg", b"\xff\xd8\xff")
        self.assert_refused("--object", file, says="picture.jpg")

    def test_object_with_a_coordinate_that_is_no_number_is_refused(self):
        vertices, triangles = make_blob(levels=1)
        vertices[7] = (0.0, float("nan"), 0.0)
        file = self.write("nan.ply", encode_ply(vertices, triangles))
        self.assert_refused("--object", file, says="nan.ply")

    def test_object_without_triangles_is_refused(self):
        file = self.write("points.ply", encode_ply(make_blob(levels=1)[0], []))
        self.assert_refused("--object", file, says="points.ply")

    def test_object_in_millimetres_is_refused(self):
        file = self.write("huge.ply", encode_ply(*make_blob(height_m=2000.0, levels=2)))
        self.assert_refused("--object", file, says=["huge.ply", "metres"])

    def test_object_of_two_millimetres_is_refused(self):
        file = self.write("tiny.ply", encode_ply(*make_blob(height_m=0.002, levels=2)))
        self.assert_refused("--object", file, says=["tiny.ply", "metres"])

    def test_unknown_object_name_is_refused(self):
        self.assert_refused("--object", "statu", says="statu")

    def test_unknown_method_is_refused(self):
        self.assert_refused("--object", self.blob, "--method", "BHIG", says=["BHIG", "BH/IG"])

    def test_unknown_gain_rule_is_refused(self):
        self.assert_refused("--object", self.blob, "--gain", "sun", says=["sun", "sum"])

    def test_gain_rule_of_a_method_without_gain_is_refused(self):
        self.assert_refused("--object", self.blob, "--method", "B", "--gain", "sum", says=["B", "--gain"])

    def test_unknown_cell_is_refused(self):
        self.assert_refused("--object", self.blob, "--cell", "fre", says=["fre", "free"])

    def test_unknown_key_of_a_cell_is_refused_with_its_line(self):
        file = self.write("cell.yaml", b"name: mine\nresolutoin_m: 0.01\n")
        self.assert_refused("--object", self.blob, "--cell", file, says="cell.yaml:2: unknown key `resolutoin_m`: did you mean `resolution_m`?")

    def test_unknown_option_is_refused(self):
        self.assert_refused("--colour", "red", says="--colour")

    def test_bad_numbers_are_refused(self):
        for option, value in (("--seed", "one"), ("--seed", "-1"), ("--seed", "1.5"), ("--max-scans", "0"), ("--max-scans", "many"),
                              ("--completeness", "98.75"), ("--completeness", "nan"), ("--completeness", "0"), ("--rate", "fast")):
            with self.subTest(f"{option} {value}"):
                self.assert_refused("--object", self.blob, option, value, says=value)

    def write_cell(self, urdf=(), cell=()):
        """The robot cell with some of its text replaced: pairs (what, by what); in the URDF by regular expressions."""
        cells = SOURCE / "sim/cells"
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        text = (cells / "kr16.urdf").read_text()
        for what, by in urdf:
            text, count = re.subn(what, by, text, flags=re.DOTALL)
            self.assertTrue(count, what)
        (folder / "kr16.urdf").write_text(text)
        text = (cells / "kr16.yaml").read_text()
        for what, by in cell:
            self.assertIn(what, text)
            text = text.replace(what, by)
        (folder / "cell.yaml").write_text(text)
        return folder / "cell.yaml"

    def assert_cell_refused(self, says, **changes):
        self.assert_refused("--object", self.blob, "--cell", self.write_cell(**changes), says=says)

    def test_robot_cell_as_it_stands_begins_and_sees_an_object_that_is_low(self):
        low = self.write("low.ply", encode_ply(*make_blob(height_m=0.06)))
        for name, object_file in (("begins", self.blob), ("low", low)):
            with self.subTest(name):
                self.finish(self.start("scan", "--object", object_file, "--cell", self.write_cell(), "--max-scans", 1, "--out", self.folder / name))
                report = json.loads((self.folder / name / "report.json").read_text())
                self.assertGreater(report["observable_coverage"], 0.1)

    def test_urdf_that_is_missing_or_malformed_is_refused(self):
        self.assert_cell_refused(["nothing.urdf"], cell=[("kr16.urdf ", "nothing.urdf ")])
        self.assert_cell_refused(["kr16.urdf:", "no valid XML"], urdf=[("</robot>", "")])
        self.assert_cell_refused(["kr16.urdf", "robot"], urdf=[("<robot name", "<machine name"), ("</robot>", "</machine>")])
        self.assert_cell_refused(["kr16.urdf", "link_9"], urdf=[('<child link="link_3"/>', '<child link="link_9"/>')])

    def test_urdf_without_limits_or_speeds_is_refused(self):
        self.assert_cell_refused(["kr16.urdf", "joint_a3", "limits"], urdf=[(r'(<joint name="joint_a3".*?)<limit[^>]*/>', r"\1")])
        self.assert_cell_refused(["kr16.urdf", "joint_a3", "velocity"], urdf=[(r'(<joint name="joint_a3".*?<limit[^>]*) velocity="[^"]*"', r"\1")])
        self.assert_cell_refused(["kr16.urdf", "joint_a3", "lower"], urdf=[(r'(<joint name="joint_a3".*?<limit[^>]*) lower="[^"]*"', r"\1")])

    def test_urdf_without_collision_bodies_is_refused(self):
        self.assert_cell_refused(["kr16.urdf", "link_4", "collision body"], urdf=[(r'(<link name="link_4">).*?(</link>)', r"\1\2")])
        self.assert_cell_refused(["kr16.urdf", "link_4", "collision"], urdf=[(r'(<link name="link_4">.*?)<cylinder radius="[^"]*"', r"\1<cylinder")])
        self.assert_cell_refused(["kr16.urdf", "link_6", "mesh"], urdf=[(r'(<link name="link_6">.*?)<sphere [^>]*/>', r'\1<mesh filename="l6.stl"/>')])

    def test_arm_without_a_spherical_wrist_is_refused_with_the_remedy(self):
        self.assert_cell_refused(["robot.urdf", "wrist", "inverse_kinematics: numeric"],
                                 urdf=[(r'(<joint name="joint_a5".*?<origin xyz=")0 0 0"', r'\g<1>0 0.1 0.05"')])

    def test_arm_that_starts_in_collision_or_beyond_its_limits_is_refused(self):
        start = "start_rad: [0, -1.9, 1.9, 0, 1.2, 0]"
        self.assert_cell_refused(["starts in collision", "itself"], cell=[(start, "start_rad: [0, -0.5, 2.68, 0, 2.2, 0]")])
        self.assert_cell_refused(["starts in collision", "floor"], cell=[(start, "start_rad: [3.1, 0.5, 0.6, 0, 0, 0]")])
        self.assert_cell_refused(["starts inside the box that is unknown"], cell=[(start, "start_rad: [0, -1.1, 2.15, 0, 0, 0]")])
        self.assert_cell_refused(["beyond the limits of its joints"], cell=[(start, "start_rad: [0, 1.9, 1.9, 0, 1.2, 0]")])
        self.assert_cell_refused(["5 joint values"], cell=[(start, "start_rad: [0, -1.9, 1.9, 0, 1.2]"), ("[5.0, 5.0, 5.0, 10.0, 10.0, 15.0]", "[5.0, 5.0, 5.0, 10.0, 10.0]")])

    def test_first_path_out_of_reach_or_in_collision_is_refused(self):
        self.assert_cell_refused(["first scan path", "reach"], cell=[("position_m: [-1.0, 0, -0.30]", "position_m: [-3.0, 0, -0.30]")])
        near = self.write_cell(cell=[("first_standoff_m: 0.20", "first_standoff_m: 0.01")])
        high = self.write("high.ply", encode_ply(*make_blob(height_m=0.5)))
        self.assert_refused("--object", high, "--cell", near, says=["first scan path", "unknown"])
        self.assert_refused("--object", self.blob, "--cell", near, says=["only", "of the first scan path"])
        self.assert_cell_refused(["first scan path", "table"], cell=[("first_above_table_m: 0.15", "first_above_table_m: 0.0"), ("first_along_W: [0, 0, 1]", "first_along_W: [0, 1, 0]")])

    def test_empty_folder_is_left_as_it_was(self):
        (self.folder / "mine").mkdir()
        cell = self.write_cell(cell=[("first_standoff_m: 0.20", "first_standoff_m: 0.01")])
        self.assert_refused("--object", self.blob, "--cell", cell, says="first scan path", out="mine")
        self.assertEqual([], os.listdir(self.folder / "mine"))

    def test_folder_that_is_no_run_is_refused_and_left_alone(self):
        other = self.folder / "holiday"
        other.mkdir()
        (other / "beach.txt").write_text("sand")
        self.assert_refused("--object", self.blob, says="holiday", out="holiday")
        self.assertEqual(["beach.txt"], os.listdir(other))

    def test_earlier_run_is_refused_and_left_alone(self):
        earlier = self.folder / "earlier"
        earlier.mkdir()
        (earlier / "run.yaml").write_text("name: earlier\n")
        self.assert_refused("--object", self.blob, says="earlier", out="earlier")
        self.assertEqual("name: earlier\n", (earlier / "run.yaml").read_text())

    def test_file_in_the_place_of_the_folder_is_refused(self):
        self.write("taken", b"mine")
        self.assert_refused("--object", self.blob, says="taken", out="taken")
        self.assertEqual(b"mine", (self.folder / "taken").read_bytes())

    def test_no_multicast_route_and_no_right_to_make_one_is_refused(self):
        tools = self.folder / "tools"
        tools.mkdir(exist_ok=True)
        for name in ("ip", "unshare"):
            (tools / name).write_text("#!/bin/sh\nexit 1\n")
            (tools / name).chmod(0o755)
        self.assert_refused("--object", self.blob, says=["no multicast route", "ip route add"], PATH=f"{tools}:{os.environ['PATH']}")

    @unittest.skipUnless(os.geteuid() == 0, "needs root to mount a small disk")
    def test_full_disk_is_refused(self):
        disk = self.folder / "disk"
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", disk], capture_output=True).returncode:
            self.skipTest("may not mount")
        try:
            self.assert_refused("--object", self.blob, says="free", out="disk/run")
        finally:
            subprocess.run(["umount", disk], check=True)


if __name__ == "__main__":
    unittest.main()
