"""The rules of the layers, checked on the includes.

common <- a service's algorithms <- its node <- its main. Services never include each other; what talks to a library sits in few places.
"""

import pathlib
import re

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
MAIN = re.compile(r"^int main\(", re.MULTILINE)
ROOTS = ("common", "services", "sim")
MAX_MAIN_LINES = 60

# Libraries that sit behind wrappers: what their headers begin with, the folders whose .cc files may include them, and whether headers there may.
WRAPPED = {
    "LCM": (("lcm/", "nbs_msgs/"), ("common/bus", "common/messages"), True),
    "OctoMap": (("octomap/",), ("common/mapping",), False),
    "OMPL": (("ompl/",), ("services/planner/motion_planning",), False),
    "Embree": (("embree3/",), ("sim",), False),
    "urdfdom": (("urdf_parser/", "urdf_model/"), ("common/kinematics",), False),
    "yaml-cpp": (("yaml-cpp/",), ("common/config",), False),
    "assimp": (("assimp/",), ("common/geometry",), False),
}
# The services that stand in for, or compare with, the physical world.
MAY_INCLUDE_SIM = ("services/simulator", "services/reporter")
# What the build generates; its include root is the build tree.
GENERATED = "nbs_msgs/"
# A node has no thread and no clock of its own.
NOT_IN_A_NODE = ("thread", "mutex", "condition_variable", "future", "chrono", "atomic", "ctime")


def is_inside(path, folder):
    return path == folder or path.startswith(folder + "/")


def service_of(path):
    """services/mesher for everything in it."""
    parts = path.split("/")
    return "/".join(parts[:2]) if parts[0] == "services" and len(parts) > 2 else None


def explain_own(path, name, is_main):
    """Why the file may not include the project's header `name`; None if it may."""
    file = str(path)
    own, target = service_of(file), service_of(name)
    if name.startswith("tests/"):
        return "the product does not know its tests"
    if target and target != own:
        return "services meet on the bus only" if own else "services are above this layer"
    if is_inside(name, "sim") and not is_inside(file, "sim") and own not in MAY_INCLUDE_SIM:
        return "only simulator, reporter and sim itself know the truth"
    if is_inside(name, "common/bus") and not is_inside(file, "common/bus") and not is_main:
        return "only mains know the bus"
    if is_inside(name, "common/messages") and not is_inside(file, "common/messages") and not is_inside(file, "common/bus") and not is_main:
        return "only bus and mains know the messages' encoding"
    return None


def explain_library(path, name, is_main):
    """Why the file may not include the foreign header `name`; None if it may."""
    file = str(path)
    for library, (prefixes, folders, headers_too) in WRAPPED.items():
        if not name.startswith(prefixes):
            continue
        allowed = any(is_inside(file, folder) for folder in folders) or (library == "LCM" and is_main)
        if not allowed:
            return f"{library} belongs in {', '.join(folders)}"
        if path.suffix == ".h" and not headers_too:
            return f"{library} belongs in .cc files"
    if path.stem.endswith("_node") and name in NOT_IN_A_NODE:
        return "a node has no thread and no clock"
    return None


def check_file(root, path):
    text = (root / path).read_text(encoding="utf-8")
    lines = text.splitlines()
    is_main = MAIN.search(text) is not None
    for number, line in enumerate(lines, start=1):
        match = INCLUDE.match(line)
        if not match:
            continue
        name = match.group(2)
        own = name.split("/")[0] in ROOTS + ("tests",) and "/" in name
        reason = explain_own(path, name, is_main) if own else explain_library(path, name, is_main)
        if match.group(1) == '"' and not own and not name.startswith(GENERATED):
            reason = reason or "an include of ours names the path from the root"
        if reason:
            yield f"{path}:{number}: must not include {name}: {reason}"
    if is_main and len(lines) >= MAX_MAIN_LINES:
        yield f"{path}: {len(lines)} lines: a main has fewer than {MAX_MAIN_LINES}"


def find_violations(root):
    """All violations under a source tree, one sentence each."""
    root = pathlib.Path(root)
    files = sorted(file.relative_to(root) for folder in ROOTS for suffix in ("h", "cc") for file in (root / folder).rglob(f"*.{suffix}"))
    return [violation for path in files for violation in check_file(root, path)]
