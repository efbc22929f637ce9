"""What a user can get wrong: one clear sentence, exit code 1, nothing left behind."""

import itertools
import os
import subprocess
import unittest

from blob import encode_ply, make_blob
from run_testing import WholeRunTest


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
