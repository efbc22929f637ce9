"""Runs the real scripts with the real services, from Python's unittest."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import time
import unittest

from blob import encode_ply, make_blob

SOURCE = pathlib.Path(os.environ.get("NBS_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BINARY = pathlib.Path(os.environ.get("NBS_BINARY_DIR", SOURCE / "build/release"))
LONGEST_RUN_S = 240


def wait_until(condition, what, seconds=60):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.002)
    raise AssertionError(f"did not happen within {seconds} s: {what}")


def list_service_processes(text):
    """Command lines of the services that run and mention `text`."""
    lines = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout.splitlines()
    return [line for line in lines if "/nbs-" in line and text in line]


class WholeRunTest(unittest.TestCase):
    """One folder for all tests of a class; `blob` is the object in it."""

    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="nbs-whole-"))
        cls.addClassCleanup(cls.remove_folder)
        cls.blob = cls.folder / "blob.ply"
        cls.blob.write_bytes(encode_ply(*make_blob()))
        cls.environment = dict(os.environ, NBS_READY="1", NBS_BUILD_DIR=str(BINARY), NBS_STATE_DIR=str(cls.folder / "state"))

    @classmethod
    def remove_folder(cls):
        if os.environ.get("NBS_KEEP_RUNS"):
            print(f"kept: {cls.folder}")
        else:
            shutil.rmtree(cls.folder)

    @classmethod
    def start(cls, script, *arguments, **environment):
        return subprocess.Popen([SOURCE / "scripts" / script, *map(str, arguments)], env=dict(cls.environment, **environment), stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True)

    @classmethod
    def start_scan(cls, name, *arguments, **environment):
        return cls.start("scan", "--object", cls.blob, "--max-scans", 4, "--seed", 3, "--out", cls.folder / name, *arguments, **environment)

    @classmethod
    def finish(cls, process, code=0):
        """Waits for the end; returns what was written on stdout and stderr."""
        try:
            output, errors = process.communicate(timeout=LONGEST_RUN_S)
        except subprocess.TimeoutExpired:
            process.terminate()
            output, errors = process.communicate(timeout=30)
            raise AssertionError(f"still running after {LONGEST_RUN_S} s:\n{output}\n{errors}")
        if process.returncode != code:
            raise AssertionError(f"exit code {process.returncode} instead of {code}:\n{output}\n{errors}")
        return output, errors

    def assert_nothing_runs(self):
        self.assertEqual([], list_service_processes(str(self.folder)))
        self.assertEqual([], list((self.folder / "state/sets").glob("*")) if (self.folder / "state/sets").exists() else [])
