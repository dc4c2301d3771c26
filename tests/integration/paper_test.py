#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The paper's matrix from outside: what is to run, that it is run once, and the table and pictures of it.

usage: paper_test.py PROGRAM [unittest options]
"""
import csv
import shlex

from meltray_runner import Scratch, main, meltray


class Paper(Scratch):
    def paper(self, *options):
        done = meltray("study", "paper", "--out", self.folder / "paper", "--threads", "1", *options)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout

    def test_list_is_the_matrix(self):
        lines = self.paper("--list", "--metals", "iron", "--frequencies", "100,500", "--models", "isph,wcsph_reduced",
                           "--seeds", "2", "--until", "1e-3").splitlines()
        self.assertEqual(len(lines), 8)
        self.assertEqual(len(set(lines)), 8)
        for line in lines:
            self.assertTrue(line.startswith("meltray run "))
            self.assertIn("--set domain.seed=", line)
        self.assertFalse((self.folder / "paper").exists())

    def test_runs_once_and_draws(self):
        part = ["--metals", "iron", "--frequencies", "500", "--models", "isph", "--until", "1e-5"]
        self.paper(*part)
        folder = self.folder / "paper"
        with open(folder / "paper.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(r["metal"], r["f_hz"], r["model"], r["outcome"]) for r in rows],
                         [("iron", "500", "isph", "stopped")])  # before the end of its case
        self.assertAlmostEqual(float(rows[0]["mean_step_s"]) * int(rows[0]["steps"]), 1e-5, delta=1e-11)
        for name in ("depth.png", "period.png", "ratio.png"):
            self.assertTrue((folder / name).is_file())
        summary = (folder / "iron-500hz-isph-seed0" / "summary.json").stat().st_mtime_ns
        self.assertEqual(self.paper(*part, "--list"), "")
        self.assertEqual(self.paper(*part[:-1], "2e-5", "--list").split(),
                         ["meltray", "resume", str(folder / "iron-500hz-isph-seed0"), "--until", "2e-05"])
        self.paper(*part)
        self.assertEqual((folder / "iron-500hz-isph-seed0" / "summary.json").stat().st_mtime_ns, summary)

    def test_settings_of_ones_own(self):
        """They win over those of the row, and never mix with the runs of the paper's own cases."""
        part = ["--metals", "iron", "--frequencies", "500", "--models", "wcsph_reduced", "--list",
                "--set", "flow.artificial_viscosity=0.2", "--set", 'surface.temperature="face"']
        lines = self.paper(*part).splitlines()
        self.assertEqual(len(lines), 1)
        self.assertEqual(lines[0].count("flow.artificial_viscosity"), 1)
        self.assertIn("flow.artificial_viscosity=0.2", lines[0])
        self.assertIn('surface.temperature="face"', shlex.split(lines[0]))
        done = meltray("study", "paper", *part)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--out", done.stderr)

    def test_unknown_model(self):
        done = meltray("study", "paper", "--models", "sph")
        self.assertEqual(done.returncode, 2)
        self.assertIn("sph", done.stderr)


if __name__ == "__main__":
    main()
