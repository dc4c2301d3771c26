#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Melt in a trough of its own solid, pressed evenly by recoil, crept over the rim at 0.03 to 0.05 m/s: dry solid beside
it took part in the average of the surface pressure, with none of its own. Between walls of the box it rests at 0.01.

usage: dry_solid_test.py PROGRAM [unittest options]
"""
import pathlib
import sys
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
# pylint: disable=wrong-import-position
from meltray_runner import REPOSITORY, Scratch, main, run, snapshots  # noqa: E402

POOL = REPOSITORY / "validation" / "recoil_flat_plate" / "case.toml"


class DrySolid(Scratch):
    def test_a_pressed_pool_rests_in_a_trough_of_its_own_solid(self):
        text = POOL.read_text(encoding="utf-8")
        text = text.replace("min_m = [-1e-3, -1e-3]\nmax_m = [1e-3, 0.5e-3]",
                            "min_m = [-1.2e-3, -1.2e-3]\nmax_m = [1.2e-3, 0.5e-3]")
        pool = "[[bodies]]\nshape = \"box\"\n"
        solid = pool + "min_m = [-1.2e-3, -1.2e-3]\nmax_m = [1.2e-3, 0.0]\ntemperature_k = 300.0\n\n"
        case = self.folder / "trough.toml"
        case.write_text(text.replace(pool, solid + pool, 1), encoding="utf-8")
        folder = run(case, self.folder / "run", "--set", "output.snapshot_interval_s=2e-4")
        speeds, above = [], 0
        for path in snapshots(folder)[5:]:  # once the ramp is over
            with h5py.File(path, "r") as file:
                position, velocity, phase, spacing = (file["position"][:], file["velocity"][:], file["phase"][:],
                                                      file.attrs["spacing_m"])
            melt = phase == 1
            speeds.append(numpy.sqrt((velocity[melt] ** 2).sum(axis=1).mean()))
            above += int((position[melt][:, -1] > spacing).sum())
        self.assertGreater(len(speeds), 2)
        self.assertEqual(above, 0)
        self.assertLess(max(speeds), 0.02, speeds)


if __name__ == "__main__":
    main()
