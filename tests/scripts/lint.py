"""clang-tidy over the product's sources (.clang-tidy says what is checked), remembering which files were clean.

usage: lint.py BUILD_FOLDER [FILE…]
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

SOURCE = pathlib.Path(__file__).parents[2]
INCLUDE = re.compile(rb'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def read_with_includes(path, seen):
    """The bytes of a file and of all of the project's headers that it reaches, each once."""
    if path in seen or not path.exists():
        return b""
    seen.add(path)
    text = path.read_bytes()
    return text + b"".join(read_with_includes(SOURCE / name.decode(), seen) for name in INCLUDE.findall(text))


def calc_key(path):
    return hashlib.sha256((SOURCE / ".clang-tidy").read_bytes() + read_with_includes(path, set())).hexdigest()


def write_database(build, folder):
    """compile_commands.json without ccache, which clang-tidy takes for the compiler. Returns the product's sources."""
    commands = json.loads((build / "compile_commands.json").read_text())
    for command in commands:
        command["command"] = re.sub(r"^\S*ccache ", "", command["command"])
    (folder / "compile_commands.json").write_text(json.dumps(commands))
    files = {pathlib.Path(command["file"]) for command in commands}
    return sorted(file for file in files if file.is_relative_to(SOURCE) and file.relative_to(SOURCE).parts[0] in ("common", "services", "sim"))


def lint(folder, path):
    """The complaints about one file, empty when it is clean."""
    stamp = folder / "clean" / calc_key(path)
    if stamp.exists():
        return ""
    run = subprocess.run(["clang-tidy", "-p", folder, "--quiet", path], capture_output=True, text=True)
    complaints = run.stdout.strip()
    if run.returncode == 0 and not complaints:
        stamp.touch()
    return complaints or (run.stderr if run.returncode else "")


def lint_all(build, only=()):
    """Prints complaints as they come; True if there were none."""
    folder = build / "lint"
    (folder / "clean").mkdir(parents=True, exist_ok=True)
    files = [file for file in write_database(build, folder) if not only or file.relative_to(SOURCE) in only]
    is_clean = True
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for complaints in pool.map(lambda file: lint(folder, file), files):
            if complaints:
                print(complaints, flush=True)
                is_clean = False
    print(f"lint: {len(files)} sources {'are clean' if is_clean else 'checked'}")
    return is_clean


if __name__ == "__main__":
    if not shutil.which("clang-tidy"):
        sys.exit("lint: clang-tidy is missing: run scripts/setup")
    sys.exit(0 if lint_all(pathlib.Path(sys.argv[1]), {pathlib.Path(name) for name in sys.argv[2:]}) else 1)
