"""Which packages setup asks apt for, with stand-ins for dpkg and apt."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("NBS_SOURCE_DIR", pathlib.Path(__file__).parents[2]))


def list_packages(*groups):
    lines = [line.split() for line in (SOURCE / "scripts/packages.txt").read_text().splitlines() if not line.startswith("#")]
    return [package for group, package in lines if group in groups]


class Setup(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="nbs-setup-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.calls = self.folder / "calls"
        self.calls.write_text("")
        self.make_tool("apt-get", f'printf "%s\\n" "$*" >>{self.calls}')
        self.make_tool("id", "echo 0")

    def make_tool(self, name, body):
        tool = self.folder / name
        tool.write_text(f"#!/bin/sh\n{body}\n")
        tool.chmod(0o755)

    def run_setup(self, *groups):
        environment = dict(os.environ, PATH=f"{self.folder}:{os.environ['PATH']}", TMPDIR=str(self.folder))
        return subprocess.run([SOURCE / "scripts/setup", *groups], env=environment, capture_output=True, text=True)

    def installed(self):
        for line in self.calls.read_text().splitlines():
            if " install " in line:
                return line.split("--no-install-recommends ")[1].split()
        return None

    def test_installs_everything_on_a_bare_system(self):
        self.make_tool("dpkg-query", "exit 1")
        self.assertEqual(0, self.run_setup().returncode)
        self.assertEqual(list_packages("build", "run", "test"), self.installed())

    def test_installs_only_what_is_missing(self):
        known = "\n".join(f"installed {package}" for package in list_packages("build", "run") if package != "cmake")
        self.make_tool("dpkg-query", f"echo '{known}'; echo 'not-installed cmake'")
        self.assertEqual(0, self.run_setup("build", "run").returncode)
        self.assertEqual(["cmake"], self.installed())

    def test_does_nothing_where_all_is_there(self):
        self.make_tool("dpkg-query", "echo '" + "\n".join(f"installed {package}" for package in list_packages("spy")) + "'")
        self.assertEqual((0, "", None), (self.run_setup("spy").returncode, self.calls.read_text(), self.installed()))

    def test_without_the_right_to_install_says_the_command(self):
        self.make_tool("dpkg-query", "exit 1")
        self.make_tool("id", "echo 1000")
        self.make_tool("sudo", "exit 1")
        result = self.run_setup("bench")
        self.assertEqual((1, 1), (result.returncode, result.stderr.count("\n")))
        self.assertIn("sudo apt-get install --no-install-recommends libbenchmark-dev", result.stderr)

    def test_names_the_packages_that_apt_cannot_install(self):
        self.make_tool("dpkg-query", "exit 1")
        self.make_tool("apt-get", "echo 'E: no network'; exit 100")
        result = self.run_setup("bench")
        self.assertEqual(1, result.returncode)
        self.assertIn("E: no network", result.stderr)
        self.assertIn("could not install the packages: libbenchmark-dev", result.stderr)


if __name__ == "__main__":
    unittest.main()
