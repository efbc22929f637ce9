"""The programs that read a run folder, each by itself: 0 done, 1 bad input, 2 the run failed."""

import pathlib
import subprocess
import tempfile
import unittest

from blob import encode_ply, make_blob
from run_testing import BINARY

READERS = [["nbs-pictures"], ["nbs-reporter", "--offline"]]


class Tools(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="nbs-tools-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.run_folder = self.folder / "run"
        (self.folder / "blob.ply").write_bytes(encode_ply(*make_blob(levels=2)))
        self.call("nbs-prepare", "--object", self.folder / "blob.ply", "--cell", "free", "--out", self.run_folder, code=0)

    def call(self, program, *arguments, code):
        done = subprocess.run([BINARY / "bin" / program, *map(str, arguments)], capture_output=True, text=True, timeout=60)
        self.assertEqual(code, done.returncode, done.stderr)
        return done.stdout + done.stderr

    def damage(self, channel):
        (self.run_folder / "streams" / f"{channel}.lcm").write_bytes(b"no log of LCM's at all" * 10)

    def test_damaged_history_is_a_failure_of_the_run_and_no_bad_input(self):
        self.damage("RUN_STATE")
        for program, *options in READERS:
            with self.subTest(program):
                self.assertRegex(self.call(program, *options, "--run", self.run_folder, code=2), f"^{program}: .*RUN_STATE")

    def test_folder_that_is_no_run_is_bad_input(self):
        for program, *options in [*READERS, ["nbs-remesh"], ["nbs-oracle"]]:
            with self.subTest(program):
                self.assertRegex(self.call(program, *options, "--run", self.folder / "nothing", code=1), f"^{program}: .*nothing")

    def test_unknown_option_or_impossible_number_is_bad_input(self):
        for program, *options in [["nbs-pictures", "--colour"], ["nbs-oracle", "--paths", 0], ["nbs-oracle", "--threads", -1], ["nbs-reporter", "--colour"]]:
            with self.subTest(program):
                self.assertIn(str(options[0]), self.call(program, "--run", self.run_folder, *options, code=1))

    def test_offline_stands_in_the_reporters_help_and_among_any_other_options(self):
        self.assertIn("--offline", self.call("nbs-reporter", "--help", code=0))
        self.assertNotIn("--offline", self.call("nbs-mesher", "--help", code=0))
        for options in (["--offline", "--run", self.run_folder], [f"--run={self.run_folder}", "--offline", "--lcm-url", "udpm://239.255.76.67:7667?ttl=0"]):
            with self.subTest(str(options)):
                (self.run_folder / "report.json").unlink(missing_ok=True)
                self.call("nbs-reporter", *options, code=0)
                self.assertTrue((self.run_folder / "report.json").exists())


if __name__ == "__main__":
    unittest.main()
