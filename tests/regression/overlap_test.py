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
         "flow.interface_viscosity_solid=0.1"]


def overlapping(folder):
    """Share of the melt that is nearer than 0.6 of a spacing to another particle at the end."""
    with h5py.File(sorted((folder / "particles").glob("*.h5"))[-1], "r") as file:
        position, phase, spacing = file["position"][:], file["phase"][:], file.attrs["spacing_m"]
    melt = position[phase == 1]
    distance = numpy.linalg.norm(melt[:, None, :] - position[None, :, :], axis=2)
    nearest = numpy.partition(distance, 1, axis=1)[:, 1]  # the very nearest is the particle itself
    return numpy.mean(nearest < 0.6 * spacing)


class Overlap(Scratch):
    def test_pressed_melt_keeps_its_distance(self):
        pressed = run(WELD, self.folder / "pressed", *FACES, "--set", "flow.least_distance=0")
        apart = run(WELD, self.folder / "apart", *FACES)
        self.assertGreater(overlapping(pressed), 0.1)
        self.assertLess(overlapping(apart), 0.02)


if __name__ == "__main__":
    main()
