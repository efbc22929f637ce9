"""Starting, watching over and stopping services, with stand-ins for the services: what the scripts promise whatever the services do."""

import fcntl
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest

SOURCE = pathlib.Path(os.environ.get("NBS_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
SERVICES = ["robot", "simulator", "sensor", "mesher", "voxelmap", "planner", "coordinator", "reporter"]


def wait_until(condition, what, seconds=20):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.02)
    raise AssertionError(f"did not happen within {seconds} s: {what}")


def is_alive(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


class ScriptTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="nbs-scripts-"))
        self.addCleanup(shutil.rmtree, self.folder)
        binaries = self.folder / "build" / "bin"
        binaries.mkdir(parents=True)
        for name in SERVICES + ["prepare", "remesh"]:
            (binaries / f"nbs-{name}").symlink_to(SOURCE / "tests/scripts/fake_service.sh")
        self.environment = dict(os.environ, NBS_READY="1", NBS_BUILD_DIR=str(self.folder / "build"), NBS_STATE_DIR=str(self.folder / "state"),
                                NBS_RUNS_DIR=str(self.folder / "runs"))
        self.started = []
        self.addCleanup(self.end_all)

    def end_all(self):
        for process in self.started:
            if process.poll() is None:
                process.kill()
            process.wait()
            process.stdout.close()
            process.stderr.close()

    def start(self, script, *arguments):
        """In a session of its own, as on a terminal of its own."""
        process = subprocess.Popen([SOURCE / "scripts" / script, *map(str, arguments)], env=self.environment, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True, start_new_session=True)
        self.started.append(process)
        return process

    def run_script(self, script, *arguments):
        process = self.start(script, *arguments)
        output, errors = process.communicate(timeout=60)
        return process.returncode, output, errors

    def start_scan(self, name="run", services=SERVICES):
        run = self.folder / name
        process = self.start("scan", "--out", run)
        self.wait_for_services(run, services)
        return process, run

    def wait_for_services(self, run, services):
        wait_until(lambda: all((run / f"{service}.starts").exists() and (run / f"{service}.starts").read_text().endswith("\n")
                               for service in services), "all services started")

    def pids(self, run):
        return [int(line.split()[0]) for file in run.glob("*.starts") for line in file.read_text().splitlines()]

    def assert_nothing_runs(self, run):
        wait_until(lambda: not any(map(is_alive, self.pids(run))), "all services have ended", seconds=2)
        self.assertEqual([], list((self.folder / "state/sets").glob("*")))


class Scan(ScriptTest):
    def test_ends_with_the_reporter_and_writes_the_report(self):
        process, run = self.start_scan()
        (run / "finish").touch()
        output, errors = process.communicate(timeout=30)
        self.assertEqual((0, f"scan 0\nrun folder: {run}\n", ""), (process.returncode, output, errors))
        self.assertTrue((run / "report.json").exists())
        self.assert_nothing_runs(run)

    def test_default_folder_is_named_after_object_method_and_seed(self):
        process = self.start("scan", "--object", "/tmp/a b.ply", "--method", "B/IG", "--seed", "7")
        wait_until(lambda: list((self.folder / "runs").glob("*/reporter.starts")), "the run has started")
        (run,) = (self.folder / "runs").iterdir()
        self.assertRegex(run.name, r"^a b-B-IG-seed7-\d{8}-\d{6}$")
        (run / "finish").touch()
        process.communicate(timeout=30)

    def test_refused_options_leave_no_folder(self):
        code, _, errors = self.run_script("scan", "--method", "BAD")
        self.assertEqual((1, "unknown method `BAD`\n"), (code, errors))
        self.assertEqual([], list((self.folder / "runs").iterdir()))

    def test_interrupted_before_it_begins_leaves_what_was_there(self):
        mine = self.folder / "mine"
        mine.mkdir()
        for folder, arguments in ((self.folder / "runs", []), (self.folder / "new", ["--out", self.folder / "new"]), (mine, ["--out", mine])):
            with self.subTest(arguments):
                process = self.start("scan", "--object", "slow.ply", *arguments)
                wait_until(lambda: list(folder.glob("**/checking")), "the planner checks")
                os.killpg(process.pid, signal.SIGINT)
                process.communicate(timeout=30)
                self.assertEqual((130, []), (process.returncode, list(folder.glob("*"))))
        self.assertEqual((True, False), (mine.exists(), (self.folder / "new").exists()))

    def test_without_a_bus_leaves_no_folder(self):
        (self.folder / "state").write_text("no folder")
        code, _, errors = self.run_script("scan", "--out", self.folder / "run")
        self.assertEqual((1, 1, False), (code, errors.count("\n"), (self.folder / "run").exists()))

    def test_interrupt_stops_everything_and_saves(self):
        process, run = self.start_scan()
        # As a terminal does: to the whole foreground group.
        os.killpg(process.pid, signal.SIGINT)
        output, errors = process.communicate(timeout=30)
        self.assertEqual(130, process.returncode)
        self.assertEqual("\ninterrupted: stopping and saving what was scanned\n", errors)
        self.assertTrue((run / "report.json").exists())
        self.assert_nothing_runs(run)

    def test_kill_of_the_script_itself_leaves_no_orphan(self):
        process, run = self.start_scan()
        process.kill()
        process.wait()
        wait_until(lambda: not any(map(is_alive, self.pids(run))), "all services have ended", seconds=2)

    def test_service_that_is_killed_is_started_again_at_once(self):
        for number, name, service in ((signal.SIGKILL, "KILL", "mesher"), (signal.SIGTERM, "TERM", "mesher"), (signal.SIGTERM, "TERM", "reporter")):
            with self.subTest(name, service=service):
                process, run = self.start_scan(f"{service}-{name}")
                starts = run / f"{service}.starts"
                os.kill(int(starts.read_text().split()[0]), number)
                killed = time.monotonic()
                wait_until(lambda: len(starts.read_text().splitlines()) == 2, f"{service} started again", seconds=5)
                self.assertLess(time.monotonic() - killed, 0.5)
                (run / "finish").touch()
                _, errors = process.communicate(timeout=30)
                self.assertEqual((0, f"supervisor: {service} died of signal {name}; started again\n"), (process.returncode, errors))
                self.assertIn(f"{service} died of signal {name}", (run / "logs/supervisor.log").read_text())

    def test_service_that_does_not_stop_is_killed_and_named_once(self):
        process, run = self.start_scan()
        os.kill(int((run / "mesher.starts").read_text().split()[0]), signal.SIGSTOP)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=30)
        self.assertEqual((130, 1), (process.returncode, errors.count("supervisor: mesher does not stop: killed\n")))
        self.assert_nothing_runs(run)

    def test_service_that_keeps_dying_ends_the_run(self):
        process, run = self.start_scan()
        (run / "planner.order").write_text("137 crash\n")
        _, errors = process.communicate(timeout=30)
        self.assertEqual(2, process.returncode)
        self.assertIn("planner died 5 times within 30 s (signal KILL): giving up", errors)
        self.assert_nothing_runs(run)

    def test_service_that_refuses_its_input_ends_the_run_with_its_sentence(self):
        process, run = self.start_scan()
        (run / "sensor.order").write_text("1 run.yaml:3: unknown key\n")
        _, errors = process.communicate(timeout=30)
        self.assertEqual((1, "supervisor: sensor ended with exit code 1: run.yaml:3: unknown key\n"), (process.returncode, errors))
        self.assert_nothing_runs(run)

    def test_whose_report_says_so_has_failed(self):
        process, run = self.start_scan()
        (run / "failed").touch()
        (run / "finish").write_text("no_candidates")
        _, errors = process.communicate(timeout=30)
        self.assertEqual((2, 'the run failed: Said "so", fully.\n'), (process.returncode, errors))

    def test_whose_report_cannot_be_written_has_failed(self):
        process, run = self.start_scan()
        (run / "unwritable").touch()
        (run / "finish").touch()
        _, errors = process.communicate(timeout=30)
        self.assertEqual((2, "the report could not be written: no space left\n"), (process.returncode, errors))
        self.assert_nothing_runs(run)

    def test_whose_scans_cannot_be_registered_has_failed_but_leaves_its_report(self):
        process, run = self.start_scan()
        (run / "unregistrable").touch()
        (run / "finish").write_text("scan_limit")
        _, errors = process.communicate(timeout=30)
        self.assertEqual((2, "the scans could not be registered with each other: a history is damaged\n"), (process.returncode, errors))
        self.assertTrue((run / "report.json").exists())
        self.assert_nothing_runs(run)

    def test_reporter_that_fails_is_named(self):
        process, run = self.start_scan()
        (run / "reporter.order").write_text("2 the disk is full\n")
        _, errors = process.communicate(timeout=30)
        self.assertEqual((2, "supervisor: reporter ended with exit code 2: the disk is full\n"), (process.returncode, errors))
        self.assert_nothing_runs(run)

    def test_two_at_the_same_time_use_two_ports(self):
        first, first_run = self.start_scan("first")
        second, second_run = self.start_scan("second")
        urls = {line.split()[1] for run in (first_run, second_run) for file in run.glob("*.starts") for line in file.read_text().splitlines()}
        self.assertEqual(2, len(urls))
        for process, run in ((first, first_run), (second, second_run)):
            (run / "finish").touch()
            process.communicate(timeout=30)
            self.assertEqual(0, process.returncode)

    def test_leaves_alone_a_port_that_others_listen_to(self):
        def find_port(name):
            process, run = self.start_scan(name)
            (run / "finish").touch()
            process.communicate(timeout=30)
            return int(re.search(r":(\d+)\?", (run / "robot.starts").read_text()).group(1))

        port = find_port("first")
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            other.bind(("", port))
            self.assertNotEqual(port, find_port("second"))

    def test_bad_options_get_one_sentence(self):
        for arguments in (["--colour", "red"], ["statue"], ["--seed"], ["--seed", "010"], ["--seed", "9" * 19], ["--out", ""]):
            with self.subTest(arguments):
                code, output, errors = self.run_script("scan", *arguments)
                self.assertEqual((1, "", 1), (code, output, errors.count("\n")))


class Launch(ScriptTest):
    def test_stop_ends_it(self):
        run = self.folder / "run"
        process = self.start("launch", "all", "--out", run)
        self.wait_for_services(run, SERVICES)
        code, output, _ = self.run_script("stop")
        self.assertEqual((0, f"stopping {' '.join(SERVICES)} of {run}\n"), (code, output))
        process.communicate(timeout=30)
        self.assertEqual(130, process.returncode)
        self.assert_nothing_runs(run)

    def test_prints_the_url_that_the_services_use(self):
        run = self.folder / "run"
        process = self.start("launch", "sim", "--out", run)
        self.wait_for_services(run, ["robot", "simulator"])
        (run / "finish").touch()
        output, _ = process.communicate(timeout=30)
        url = (run / "robot.starts").read_text().split()[1]
        self.assertEqual(0, process.returncode)
        self.assertEqual(f"run folder: {run}\nexport LCM_DEFAULT_URL='{url}'\n", output)

    def test_sets_of_one_run_share_a_bus(self):
        run = self.folder / "run"
        self.start("launch", "sim", "--out", run)
        self.wait_for_services(run, ["robot", "simulator"])
        self.start("launch", "hardware", "--run", run)
        self.wait_for_services(run, SERVICES)
        urls = {line.split()[1] for file in run.glob("*.starts") for line in file.read_text().splitlines()}
        self.assertEqual(1, len(urls))
        code, _, errors = self.run_script("launch", "planner", "--run", run)
        self.assertEqual(1, code)
        self.assertIn("the planner of this run is running already", errors)
        self.run_script("stop", "--run", run)
        self.assert_nothing_runs(run)

    def test_run_folder_that_cannot_be_written_is_refused(self):
        run = self.folder / "run"
        (run / "logs/supervisor.log").mkdir(parents=True)
        (run / "run.yaml").touch()
        result = self.run_script("launch", "sim", "--run", run)
        self.assertEqual((1, "", f"launch: cannot write to the run folder {run}\n"), result)

    def register_set(self, pid, run, namespace, age_s):
        """As bus.sh does, and locked as if it ran."""
        file = self.folder / "state/sets" / str(pid)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(f"{run}\nudpm://239.255.76.67:{pid}?ttl=0\n{namespace}\nrobot simulator\n")
        os.utime(file, (time.time() - age_s, time.time() - age_s))
        lock = file.open()
        self.addCleanup(lock.close)
        fcntl.flock(lock, fcntl.LOCK_EX)

    def test_joins_the_namespace_of_its_own_run(self):
        tools = self.folder / "tools"
        tools.mkdir()
        (tools / "nsenter").write_text('#!/bin/sh\necho "entered $5"\n')
        (tools / "nsenter").chmod(0o755)
        self.environment["PATH"] = f"{tools}:{self.environment['PATH']}"
        for number, run in enumerate(("first", "second")):
            (self.folder / run).mkdir()
            (self.folder / run / "run.yaml").touch()
            self.register_set(101 + number, self.folder / run, 201 + number, age_s=number)
        for run, namespace in (("first", 201), ("second", 202)):
            code, output, errors = self.run_script("launch", "mapping", "--run", self.folder / run)
            self.assertEqual((0, f"entered {namespace}\n", ""), (code, output, errors))

    def test_bad_options_get_one_sentence(self):
        for arguments in ([], ["everything"], ["all", "--run", self.folder], ["sim", "--run"]):
            with self.subTest(arguments):
                code, output, errors = self.run_script("launch", *arguments)
                self.assertEqual((1, "", 1), (code, output, errors.count("\n")))


class Every(ScriptTest):
    def test_script_explains_itself(self):
        for script in sorted((SOURCE / "scripts").iterdir()):
            if not os.access(script, os.X_OK) or script.is_dir():
                continue
            with self.subTest(script.name):
                code, output, errors = self.run_script(script.name, "--help")
                self.assertEqual((0, ""), (code, errors))
                self.assertTrue(output.startswith(f"usage: scripts/{script.name}"))


if __name__ == "__main__":
    unittest.main()
