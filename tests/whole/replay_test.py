"""A recorded run plays again, bit for bit, and a difference does not go unnoticed."""

import re
import shutil
import subprocess
import unittest

from lcm_log import find_messages
from run_testing import BINARY, WholeRunTest

OUTPUTS = ["MESH", "MESH_SCAN", "VOXELS", "PLAN", "CANDIDATES"]


class Replay(WholeRunTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.finish(cls.start_scan("recorded"))
        cls.run_folder = cls.folder / "recorded"
        cls.log = (cls.run_folder / "bus.lcm").read_bytes()

    def replay(self, code, *arguments, run=None):
        result = self.finish(self.start("replay", run or self.run_folder, *arguments), code)
        self.assert_nothing_runs()
        return result

    def write_log(self, name, data):
        file = self.folder / name
        file.write_bytes(data)
        return file

    def write_log_with_change(self, channel):
        """The recorded log with the last byte but nine of a middle message of the channel changed by one."""
        messages = find_messages(self.log, channel)
        offset, length = messages[len(messages) // 2]
        log = bytearray(self.log)
        log[offset + length - 9] ^= 1
        return self.write_log(f"changed_{channel}.lcm", log)

    def test_twice_makes_every_output_again(self):
        for _ in range(2):
            output, errors = self.replay(0)
            self.assertEqual("", errors)
            lines = output.splitlines()
            self.assertEqual(OUTPUTS, [line.split(":")[0] for line in lines])
            for line in lines:
                recorded, made, identical = map(int, re.findall(r"(\d+) (?:recorded|made|identical)", line))
                self.assertGreater(recorded, 0)
                self.assertEqual((recorded, recorded), (made, identical))

    def test_of_a_run_that_was_cut_short_makes_again_what_it_has(self):
        cut = self.folder / "cut"
        shutil.copytree(self.run_folder, cut)
        # Stripes were on their way to a mesher that had folded half of them, and the coordinator had not come to the end.
        for channel, share in (("MESH", 0.5), ("MESH_SCAN", 0.5), ("RUN_STATE", 0.8)):
            file = cut / f"streams/{channel}.lcm"
            history = file.read_bytes()
            messages = find_messages(history, channel)
            offset, length = messages[int(share * len(messages))]
            file.write_bytes(history[: offset + length])
        subprocess.run([BINARY / "bin/nbs-reporter", "--run", cut, "--offline"], check=True)
        output, errors = self.replay(0, run=cut)
        self.assertEqual("", errors)
        first, *lines = output.splitlines()
        self.assertEqual("the recorded run was cut short: what was made beyond its record is not compared", first)
        counts = [tuple(map(int, re.findall(r"(\d+) (?:recorded|made|identical)", line))) for line in lines]
        self.assertEqual(len(OUTPUTS), len(counts))
        for recorded, made, identical in counts:
            self.assertGreaterEqual(made, recorded)
            self.assertEqual(recorded, identical)

    def test_as_fast_as_the_bus_goes_is_repaired_to_the_same(self):
        self.replay(0, "--speed", 0)

    def test_leaves_the_run_as_it_was(self):
        before = {file: file.stat().st_mtime_ns for file in self.run_folder.rglob("*")}
        self.replay(0)
        self.assertEqual(before, {file: file.stat().st_mtime_ns for file in self.run_folder.rglob("*")})

    def test_of_a_record_with_another_output_names_it(self):
        _, errors = self.replay(2, "--log", self.write_log_with_change("VOXELS"))
        self.assertIn("VOXELS", errors)
        self.assertEqual(1, errors.count("\n"))

    def test_of_other_inputs_finds_other_outputs(self):
        _, errors = self.replay(2, "--log", self.write_log_with_change("STRIPE"))
        self.assertTrue("MESH" in errors or "VOXELS" in errors or "STRIPE" in errors, errors)

    def test_with_another_planner_finds_another_plan(self):
        other = self.folder / "other"
        shutil.copytree(self.run_folder, other)
        text = (other / "run.yaml").read_text()
        # As if its code had changed: it scans from nearer by.
        self.assertIn("standoff_m: 0.325\n", text)
        (other / "run.yaml").write_text(text.replace("standoff_m: 0.325\n", "standoff_m: 0.3\n"))
        _, errors = self.replay(2, run=other)
        self.assertTrue("PLAN" in errors or "CANDIDATES" in errors, errors)

    def test_of_a_cut_log_fails(self):
        messages = find_messages(self.log, "STRIPE")
        offset, length = messages[len(messages) // 2]
        self.replay(2, "--log", self.write_log("cut.lcm", self.log[: offset + length // 2]))

    def test_of_a_log_with_garbage_fails(self):
        offset, _ = find_messages(self.log, "STRIPE")[5]
        self.replay(2, "--log", self.write_log("garbage.lcm", self.log[: offset - 34] + bytes(40) + self.log[offset + 6 :]))

    def test_of_what_is_no_log_fails(self):
        self.replay(2, "--log", self.write_log("letter.lcm", b"Dear reader,\n" * 100))

    def test_bad_input_gets_one_sentence(self):
        for arguments in ((), (self.folder,), (self.run_folder, "--log", "/nowhere"), (self.run_folder, "--speed", "fast"), (self.run_folder, "--loud")):
            with self.subTest(arguments):
                output, errors = self.finish(self.start("replay", *arguments), 1)
                self.assertEqual(("", 1), (output, errors.count("\n")))


if __name__ == "__main__":
    unittest.main()
