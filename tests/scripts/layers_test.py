"""The layers of the source tree hold, and the check sees when they do not."""

import os
import pathlib
import tempfile
import unittest

from layers import find_violations

SOURCE = pathlib.Path(os.environ.get("NBS_SOURCE_DIR", pathlib.Path(__file__).parents[2]))


class Layers(unittest.TestCase):
    maxDiff = None

    def test_source_tree_keeps_them(self):
        self.assertEqual([], find_violations(SOURCE))

    def test_source_tree_is_really_read(self):
        self.assertTrue((SOURCE / "common/config/yaml_tree.cc").exists())
        self.assertGreater(len(list((SOURCE / "common").rglob("*.cc"))), 5)


class Check(unittest.TestCase):
    maxDiff = None

    def find_with(self, path, text):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, path)
            file.parent.mkdir(parents=True)
            file.write_text(text)
            return find_violations(folder)

    def assert_found(self, path, include, reason):
        self.assertEqual([f"{path}:2: must not include {include.strip('<>' + chr(34))}: {reason}"], self.find_with(path, f"\n#include {include}\n"))

    def assert_allowed(self, path, include, after=""):
        self.assertEqual([], self.find_with(path, f"#include {include}\n{after}"))

    def test_finds_common_that_knows_a_service(self):
        self.assert_found("common/mapping/grid.cc", '"services/mesher/mesh.h"', "services are above this layer")

    def test_finds_service_that_knows_another(self):
        self.assert_found("services/planner/gain.cc", '"services/mesher/mesh.h"', "services meet on the bus only")

    def test_finds_algorithm_that_knows_the_truth(self):
        self.assert_found("services/planner/gain.cc", '"sim/scene.h"', "only simulator, reporter and sim itself know the truth")

    def test_finds_common_that_knows_the_truth(self):
        self.assert_found("common/mapping/grid.cc", '"sim/scene.h"', "only simulator, reporter and sim itself know the truth")

    def test_finds_sim_that_knows_a_service(self):
        self.assert_found("sim/scene.cc", '"services/robot/robot_node.h"', "services are above this layer")

    def test_finds_node_that_knows_the_bus(self):
        self.assert_found("services/mesher/mesher_node.cc", '"common/bus/service_main.h"', "only mains know the bus")

    def test_finds_algorithm_that_knows_the_encoding(self):
        self.assert_found("services/mesher/mesh.cc", '"common/messages/translate.h"', "only bus and mains know the messages' encoding")

    def test_finds_generated_type_outside_its_place(self):
        self.assert_found("services/mesher/mesh.cc", '<nbs_msgs/stripe_t.hpp>', "LCM belongs in common/bus, common/messages")

    def test_finds_library_outside_its_place(self):
        for include, reason in (("<octomap/OcTree.h>", "OctoMap belongs in common/mapping"), ("<embree3/rtcore.h>", "Embree belongs in sim"),
                                ("<ompl/geometric/SimpleSetup.h>", "OMPL belongs in services/planner/motion_planning"),
                                ("<yaml-cpp/yaml.h>", "yaml-cpp belongs in common/config"), ("<assimp/scene.h>", "assimp belongs in common/geometry"),
                                ("<urdf_parser/urdf_parser.h>", "urdfdom belongs in common/kinematics")):
            with self.subTest(include):
                self.assert_found("services/mesher/mesh.cc", include, reason)

    def test_finds_library_in_a_header_of_its_place(self):
        self.assert_found("common/mapping/exchange.h", "<octomap/OcTree.h>", "OctoMap belongs in .cc files")

    def test_finds_clock_in_a_node(self):
        self.assert_found("services/mesher/mesher_node.cc", "<chrono>", "a node has no thread and no clock")

    def test_finds_include_without_its_path(self):
        self.assert_found("services/mesher/mesh.cc", '"mesh.h"', "an include of ours names the path from the root")

    def test_finds_long_main(self):
        self.assertEqual(["services/mesher/main.cc: 60 lines: a main has fewer than 60"], self.find_with("services/mesher/main.cc", "int main() {}\n" + "//\n" * 59))
        self.assertEqual([], self.find_with("services/mesher/main.cc", "int main() {}\n" + "//\n" * 58))

    def test_allows_what_the_rules_allow(self):
        self.assert_allowed("services/mesher/main.cc", '"common/bus/service_main.h"', "int main() {}\n")
        self.assert_allowed("services/mesher/mesher_node.cc", '"common/runtime/node.h"')
        self.assert_allowed("services/reporter/evaluation.cc", '"sim/coverage.h"')
        self.assert_allowed("common/bus/runner.cc", '"common/messages/translate.h"')
        self.assert_allowed("common/bus/lcm_bus.h", "<lcm/lcm-cpp.hpp>")
        self.assert_allowed("common/mapping/exchange.cc", "<octomap/OcTree.h>")


if __name__ == "__main__":
    unittest.main()
