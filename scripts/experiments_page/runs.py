"""What a folder of experiments holds: runs by object, method and seed, oracles, and the runs that failed."""

import dataclasses
import json
import pathlib

WANTED_COMPLETENESS = 0.9875  # section IV-B of the paper
# As the coordinator (services/coordinator/run_logic.h): a complete mesh must also have stopped growing, for so many scans in a row.
COMPLETE_GROWTH = 0.01
SETTLED_SCANS = 2


@dataclasses.dataclass
class Run:
    object: str
    method: str
    seed: int
    folder: pathlib.Path
    report: dict
    ends_by_completeness: bool = True

    @property
    def scans(self):
        return self.report["scans"]

    def coverage_after(self, count):
        """After `count` scans, 0 to 1; a run that had ended by then keeps what it had."""
        return self.scans[min(count, len(self.scans)) - 1]["coverage"]

    def path_after(self, count):
        return sum(scan["path_length_m"] for scan in self.scans[:count])

    def scans_to(self, coverage):
        """The number of scans with which the coverage was first reached; None if never."""
        return next((i + 1 for i, scan in enumerate(self.scans) if scan["coverage"] >= coverage), None)

    def selection_after(self, count):
        """Mean duration of a selection in seconds, without the first path, which is set beforehand; None if there was no other."""
        times = [scan["selection_s"] for scan in self.scans[:count] if scan["selection_s"] is not None]
        return sum(times) / len(times) if times else None

    def find_end(self):
        """(scans, reached): where the method ends by itself. By mesh completeness that is the first scan after which the mesh is complete and has stopped
        growing, or with which nothing was left to scan of a complete mesh; with an end rule of its own, or if that never happens, the end of the run."""
        ended_by_itself = self.report["end_reason"] != "scan_limit"
        if self.ends_by_completeness:
            grown_out = 0
            for i in range(1, len(self.scans)):
                before, after = self.scans[i - 1], self.scans[i]
                growth = (after["edges"] - before["edges"]) / max(before["edges"], 1)
                grown_out = grown_out + 1 if growth < COMPLETE_GROWTH else 0
                if after["completeness"] >= WANTED_COMPLETENESS and grown_out >= SETTLED_SCANS:
                    return i + 1, True
            return len(self.scans), ended_by_itself and self.scans[-1]["completeness"] >= WANTED_COMPLETENESS
        return len(self.scans), ended_by_itself


@dataclasses.dataclass
class Failure:
    object: str
    method: str
    seed: int
    reason: str


@dataclasses.dataclass
class Experiments:
    folder: pathlib.Path
    settings: dict
    methods: list
    runs: list
    failures: list
    oracles: dict

    def objects(self):
        return sorted({run.object for run in self.runs} | set(self.oracles))

    def of(self, object_name, method):
        return sorted((run for run in self.runs if (run.object, run.method) == (object_name, method)), key=lambda run: run.seed)


def read_report(folder):
    """The report of a run that came to a good end; None if it did not, or has not yet."""
    try:
        report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return report if report.get("failed") is False else None


def read_oracles(folder):
    oracles = {}
    for file in sorted(folder.glob("oracle/*/oracle.json")):
        try:
            oracles[file.parent.name] = json.loads(file.read_text(encoding="utf-8"))
        except ValueError:
            continue
    return oracles


def name_method(folder_name):
    """BH-IG+sum is the folder of BH/IG:sum."""
    method, _, gain = folder_name.partition("+")
    return method.replace("-", "/") + (":" + gain if gain else "")


def read_settings(file):
    """Lines of KEY VALUE."""
    return dict(line.split(" ", 1) for line in file.read_text(encoding="utf-8").splitlines() if line)


def read_methods(file):
    """Lines of METHOD END, in the order of the tables: {method: ends by completeness}."""
    lines = [line.split() for line in file.read_text(encoding="utf-8").splitlines() if line]
    return {method: end == "completeness" for method, end in lines}


def read_experiments(folder):
    methods = read_methods(folder / "methods")
    runs, failures = [], []
    for place in sorted(folder.glob("runs/*/*/seed*")):
        if not place.is_dir() and place.suffix != ".failed":
            continue
        object_name, method = place.parts[-3], name_method(place.parts[-2])
        seed = int(place.stem.removeprefix("seed"))
        report = read_report(place.with_suffix(""))
        if place.suffix == ".failed":
            if report is None:
                failures.append(Failure(object_name, method, seed, place.read_text(encoding="utf-8").strip()))
        elif report is not None:
            runs.append(Run(object_name, method, seed, place, report, methods.get(method.partition(":")[0], True)))
    return Experiments(folder, read_settings(folder / "settings"), order_methods(methods, runs), runs, failures, read_oracles(folder))


def order_methods(known, runs):
    """Methods that were run: as the project lists them, each followed by its variants."""
    names = list(known)
    found = {run.method for run in runs}

    def place(method):
        plain = method.partition(":")[0]
        return (names.index(plain) if plain in names else len(names), method)

    return sorted(found, key=place)
