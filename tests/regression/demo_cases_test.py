#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The cases of the repository run, for a shortened time, and do what they are there to show.

usage: demo_cases_test.py PROGRAM [unittest options]
"""
import math
import pathlib
import re
import sys
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
# pylint: disable=wrong-import-position
from meltray_runner import REPOSITORY, Scratch, history, main, meltray, particles, run, snapshots, summary  # noqa: E402

CASES = REPOSITORY / "cases"


def elongation(file):
    """Second moment along z over that along x: 1 for a ball."""
    x = particles(file)["position"].astype(float)
    x -= x.mean(axis=0)
    return (x[:, 2] ** 2).mean() / (x[:, 0] ** 2).mean()


class DemoCases(Scratch):
    def test_every_case_is_well_formed(self):
        for case in sorted(CASES.glob("*.toml")):
            if not re.search(r"^title = ", case.read_text(encoding="utf-8"), re.MULTILINE):
                continue  # a base that others include
            with self.subTest(case.name):
                done = meltray("check", case)
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_drop(self):
        """Runs; keeps its mass and its heat; its centre of mass stays where it is."""
        folder = run(CASES / "drop.toml", self.folder / "drop", "--until", "2e-4")
        result = summary(folder)
        self.assertEqual((result["outcome"], result["ejected"]), ("stopped", 0))
        self.assertEqual(result["budgets"]["mass"]["relative_error"], 0)
        centre = [particles(file)["position"].mean(axis=0) for file in snapshots(folder)]
        self.assertLess(numpy.abs(centre[-1] - centre[0]).max(), 1e-8)
        self.assertLess(elongation(snapshots(folder)[-1]), elongation(snapshots(folder)[0]))

    def test_drop_oscillates(self):
        """A quarter of Rayleigh's period (0.38 ms) after its start the drop is about round, at half of it oblate."""
        folder = run(CASES / "drop.toml", self.folder / "drop", "--until", "8e-4")
        shape = [elongation(file) - 1 for file in snapshots(folder)]  # at 0, 0.2, ..., 0.8 ms
        omega = math.sqrt(8 * 1.832 / (7035 * 0.5e-3 ** 3))  # surface tension at 1900 K
        for k, value in enumerate(shape):
            self.assertAlmostEqual(value, shape[0] * math.cos(omega * 2e-4 * k), delta=0.3 * shape[0])

    def test_melting_block(self):
        """The front is where the two-phase solution has it, to a particle: 2 * 0.614740 sqrt(a t)."""
        folder = run(CASES / "melting_block.toml", self.folder / "block", "--until", "2e-3")
        rows = history(folder)
        exact = 2 * 0.614740 * numpy.sqrt(36 / (7035 * 824) * rows["time_s"])
        front = rows["liquid_particles"] / 20 * 2.5e-5  # 20 particles over the height
        self.assertLess(numpy.abs(front - exact).max(), 2.5e-5)
        self.assertEqual(summary(folder)["outcome"], "stopped")

        self.assertEqual(meltray("plot", folder).returncode, 0)
        names = {p.name for p in (folder / "plots").glob("*.png")}
        self.assertTrue({"budgets.png", "pool.png", "sections.png"} <= names, names)
        self.assertFalse({"depth.png", "power.png"} & names, names)  # it has no laser

    def test_quickstart(self):
        folder = run(CASES / "quickstart.toml", self.folder / "quickstart", "--until", "1e-4")
        result, rows = summary(folder), history(folder)
        self.assertEqual((result["outcome"], result["time_s"]), ("stopped", 1e-4))
        self.assertEqual(rows["time_s"].tolist(), [0, 2e-5, 4e-5, 6e-5, 8e-5, 1e-4])
        self.assertGreater(rows["max_temperature_k"][-1], 1811)
        self.assertGreater(rows["liquid_particles"][-1], 0)
        share = rows["absorbed_power_w"][-1] / rows["laser_power_w"][-1]
        self.assertTrue(0.25 < share < 0.8, share)  # Fresnel on a flat plate of iron: about 0.34
        self.assertLess(result["budgets"]["energy"]["relative_error"], 1e-10)
        self.assertEqual(len(snapshots(folder)), 2)
        for name in ("case.toml", "log.txt", "seam.csv", "particles.xdmf"):
            self.assertTrue((folder / name).is_file(), name)

        done = meltray("plot", folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        pictures = list((folder / "plots").glob("*.png"))
        names = {p.name for p in pictures}
        self.assertTrue({"budgets.png", "depth.png", "pool.png", "power.png", "sections.png"} <= names, names)
        self.assertTrue(all(p.stat().st_size > 5000 for p in pictures))

    def test_resolved_case_is_the_case(self):
        """case.toml of a run folder, run again, gives the same bits."""
        one = run(CASES / "melting_block.toml", self.folder / "one", "--until", "5e-4")
        two = run(one / "case.toml", self.folder / "two", "--until", "5e-4")
        self.assertEqual((one / "history.csv").read_bytes(), (two / "history.csv").read_bytes())
        self.assertEqual((one / "case.toml").read_bytes(), (two / "case.toml").read_bytes())


if __name__ == "__main__":
    main()
