#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A film one particle thick on its own solid ran about at 0.4 m/s (contact angle 10 degrees) and at 2 m/s (60 degrees):
wetting turned its normals, though it has no line of contact.

usage: resting_film_test.py PROGRAM [unittest options]
"""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
# pylint: disable=wrong-import-position
from meltray_runner import Scratch, history, main, run  # noqa: E402

FILM = """
title = "A film at rest on its own solid"

[domain]
dimension = 3
min_m = [0.0, 0.0, -1.2e-4]
max_m = [3.6e-4, 3.6e-4, 1.2e-4]
spacing_m = 3e-5
arrangement = "jittered"
jitter = 0.05

[faces.x_min]
kind = "periodic"
[faces.x_max]
kind = "periodic"
[faces.y_min]
kind = "periodic"
[faces.y_max]
kind = "periodic"

[[bodies]]
shape = "box"
min_m = [0.0, 0.0, -1.2e-4]
max_m = [3.6e-4, 3.6e-4, 0.0]
temperature_k = 1000.0

[[bodies]]
shape = "box"
min_m = [0.0, 0.0, 0.0]
max_m = [3.6e-4, 3.6e-4, 3e-5]
temperature_k = 2000.0

[material]
name = "iron"

[terms]
viscosity = true
pressure = true
surface_tension = true
wetting = true

[time]
end_s = 5e-4

[output]
interval_s = 1e-4
"""


class RestingFilm(Scratch):
    def test_a_film_without_a_line_of_contact_rests(self):
        case = self.folder / "film.toml"
        case.write_text(FILM, encoding="utf-8")
        for degrees in (10, 60):
            with self.subTest(contact_angle_deg=degrees):
                folder = run(case, self.folder / f"run-{degrees}", "--set", f"material.contact_angle_deg={degrees}")
                speeds = history(folder)["max_speed_m_s"]
                self.assertEqual(len(speeds), 6)
                self.assertLess(max(speeds), 0.05, speeds)


if __name__ == "__main__":
    main()
