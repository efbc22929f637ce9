"""What the scripts have built on a fresh machine is all that they run, and all that the READMEs tell people to run."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("NBS_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
BINARY = pathlib.Path(os.environ.get("NBS_BINARY_DIR", SOURCE / "build/release"))


def list_named(files):
    """Programs named in these files."""
    return {name for file in files for name in re.findall(r"\bnbs-([a-z]+(?:-[a-z]+)*)\b(?!\$)", file.read_text())}


def list_needed():
    """The arguments of need_programs and the services that launch knows."""
    text = (SOURCE / "scripts/launch").read_text()
    names = set(re.search(r"^all_services=\((.*)\)$", text, re.MULTILINE).group(1).split())
    for script in ("scan", "launch", "replay"):
        for line in re.findall(r"^need_programs (.*)$", (SOURCE / "scripts" / script).read_text(), re.MULTILINE):
            names.update(word for word in line.split() if word[0].isalpha())
    return names


class Programs(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="nbs-programs-"))
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copytree(SOURCE / "scripts", self.folder / "scripts")
        for name in ("setup", "build"):
            tool = self.folder / "scripts" / name
            tool.write_text(f'#!/bin/sh\nprintf "%s\\n" "$@" >{self.folder}/{name}.arguments\n')

    def list_built(self, script, *arguments):
        """The programs that a script has built when nothing is: those that its targets link."""
        environment = {name: value for name, value in os.environ.items() if not name.startswith("NBS_")}
        result = subprocess.run([self.folder / "scripts" / script, *map(str, arguments)], env=environment, capture_output=True, text=True)
        self.assertEqual(1, result.returncode)
        targets = [word for word in (self.folder / "build.arguments").read_text().split() if word != "--quiet"]
        commands = subprocess.run(["ninja", "-C", BINARY, "-t", "commands", *targets], capture_output=True, text=True, check=True).stdout
        return set(re.findall(r" -o bin/nbs-([a-z-]+) ", commands))

    def test_that_are_named_are_built_first(self):
        (self.folder / "run.yaml").touch()
        (self.folder / "bus.lcm").touch()
        needed = list_needed() | list_named([*SOURCE.rglob("README.md"), *(file for file in (SOURCE / "scripts").iterdir() if file.is_file())])
        self.assertLessEqual({"prepare", "remesh", "pictures", "reporter", "repair-server"}, needed)
        for script, arguments in (("scan", []), ("launch", ["sim"]), ("replay", [self.folder]), ("experiments", [])):
            with self.subTest(script):
                self.assertEqual(set(), needed - self.list_built(script, *arguments))


if __name__ == "__main__":
    unittest.main()
