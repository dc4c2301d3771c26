#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Recoil that presses on a film of one or two layers pushed its particles into each other: a fifth of the melt stood
nearer than half a spacing to another particle, and the melt had lost a sixth of its volume.

usage: overlap_test.py PROGRAM [unittest options]
"""
import pathlib
import sys
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
# pylint: disable=wrong-import-position
from meltray_runner import REPOSITORY, Scratch, main, run  # noqa: E402

WELD = REPOSITORY / "validation" / "studies" / "weld.toml"
FACES = ["--set", "surface.temperature=face", "--set", "flow.interface_viscosity_free=0.1", "--set",
         "flow.interface_viscosity_solid=0.1", "--set", "output.snapshot_interval_s=2e-5"]


def overlapping(folder):
    """Share of the melt that is nearer than half a spacing to another particle, from 0.1 ms on."""
    melt = near = 0
    for path in sorted((folder / "particles").glob("*.h5"))[5:]:
        with h5py.File(path, "r") as file:
            position, phase, spacing = file["position"][:], file["phase"][:], file.attrs["spacing_m"]
        distance = numpy.linalg.norm(position[phase == 1][:, None, :] - position[None, :, :], axis=2)
        nearest = numpy.partition(distance, 1, axis=1)[:, 1]  # the very nearest is the particle itself
        melt += len(nearest)
        near += numpy.sum(nearest < 0.5 * spacing)
    return near / melt


class Overlap(Scratch):
    def test_pressed_melt_keeps_its_distance(self):
        pressed = overlapping(run(WELD, self.folder / "pressed", *FACES, "--set", "flow.least_distance=0"))
        apart = overlapping(run(WELD, self.folder / "apart", *FACES))
        self.assertGreater(pressed, 0.05)
        self.assertLess(apart, 0.25 * pressed, pressed)


if __name__ == "__main__":
    main()
