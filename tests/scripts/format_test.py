"""Every source file is laid out by clang-format, and every script passes shellcheck where it is installed."""

import os
import pathlib
import shutil
import subprocess
import unittest

SOURCE = pathlib.Path(os.environ.get("NBS_SOURCE_DIR", pathlib.Path(__file__).parents[2]))


def list_sources():
    return sorted(file for folder in ("common", "services", "sim", "tests") for suffix in ("h", "cc") for file in (SOURCE / folder).rglob(f"*.{suffix}"))


class Format(unittest.TestCase):
    maxDiff = None

    def test_of_sources_is_that_of_clang_format(self):
        self.assertGreater(len(list_sources()), 20)
        check = subprocess.run(["clang-format", "--dry-run", "-Werror", *list_sources()], capture_output=True, text=True)
        faults = sorted({line.split(":")[0] for line in check.stderr.splitlines() if "clang-formatted" in line})
        self.assertEqual((0, []), (check.returncode, faults), "run clang-format -i on these files")

    def test_of_lines_has_no_trailing_space(self):
        scripts = sorted(file for file in (SOURCE / "scripts").rglob("*") if file.is_file())
        files = list_sources() + scripts + sorted((SOURCE / "tests").rglob("*.py"))
        faults = [f"{file}:{number}" for file in files for number, line in enumerate(file.read_text().splitlines(), start=1) if line != line.rstrip()]
        self.assertEqual([], faults)

    @unittest.skipUnless(shutil.which("shellcheck"), "shellcheck is not installed")
    def test_of_scripts_satisfies_shellcheck(self):
        scripts = sorted(file for file in (SOURCE / "scripts").iterdir() if os.access(file, os.X_OK) and file.is_file())
        check = subprocess.run(["shellcheck", "-x", *scripts], cwd=SOURCE, capture_output=True, text=True)
        self.assertEqual("", check.stdout)


if __name__ == "__main__":
    unittest.main()
