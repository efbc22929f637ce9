"""An arm that is not where it says: after its run the scans are registered with each other, and the run folder holds both models."""

import json
import unittest

from run_testing import WholeRunTest


class Registration(WholeRunTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.output, cls.errors = cls.finish(cls.start_scan("arm", "--cell", "kr16"))
        cls.run_folder = cls.folder / "arm"
        cls.report = json.loads((cls.run_folder / "report.json").read_text())

    def test_the_registered_model_is_the_models_and_its_figures_are_the_reports(self):
        registration = self.report["registration"]
        self.assertGreater(registration["mean_correction_mm"], 0.05)
        self.assertGreater(registration["largest_correction_mm"], registration["mean_correction_mm"])
        self.assertLess(registration["largest_correction_mm"], 3)
        self.assertEqual(registration["as_streamed"]["coverage"], self.report["scans"][-1]["coverage"])
        self.assertNotEqual(registration["as_streamed"]["rmse_mm"], self.report["rmse_mm"])
        self.assertIn(b"\nelement face %d\n" % self.report["triangles"], (self.run_folder / "model.ply").read_bytes())
        self.assertIn(b"\nelement face %d\n" % registration["as_streamed"]["triangles"], (self.run_folder / "model_as_streamed.ply").read_bytes())

    def test_the_terminal_says_so(self):
        self.assertEqual("", self.errors)
        self.assertIn("scans registered with each other: moved by", self.output)

    def test_the_same_run_gives_the_same_models(self):
        self.finish(self.start_scan("again", "--cell", "kr16"))
        for model in ("model.ply", "model_as_streamed.ply"):
            self.assertTrue((self.run_folder / model).read_bytes() == (self.folder / "again" / model).read_bytes(), model)


if __name__ == "__main__":
    unittest.main()
