#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Energy, mass, momentum and the ledger of the laser close in every row and at the end of runs through the program.

usage: budgets_test.py PROGRAM [unittest options]
"""
import pathlib
import sys
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
# pylint: disable=wrong-import-position
from meltray_runner import CASES, REPOSITORY, Scratch, history, main, run, summary  # noqa: E402

WELD = CASES / "tiny_weld.toml"
TAME = ["flow.interface_viscosity_free=1", "flow.interface_viscosity_solid=1"]
# Sums of some ten thousand terms, each rounded to 1e-16: far below the 1e-3 of the contract.
ROUND_OFF = 1e-10


class Budgets(Scratch):
    def go(self, *settings, case=WELD, until=None):
        options = [x for s in settings for x in ("--set", s)] + (["--until", until] if until else [])
        folder = run(case, self.folder / "run", "--threads", "1", *options)
        return history(folder), summary(folder)

    def assert_closed(self, rows, result):
        budgets = result["budgets"]
        energy, mass, momentum, laser = (budgets[name] for name in ("energy", "mass", "momentum", "laser"))
        self.assertLess(energy["relative_error"], ROUND_OFF)
        self.assertLess(rows["energy_relative_error"][1:].max(), ROUND_OFF)
        supplied = energy["laser_j"] + energy["boundary_j"]
        lost = sum(energy[f"{name}_j"] for name in ("evaporation", "radiation", "ejected", "cropped"))
        self.assertGreater(supplied, 0)
        self.assertLess(abs(energy["stored_j"] - energy["initial_j"] - supplied + lost), ROUND_OFF * energy["stored_j"])

        self.assertLess(mass["relative_error"], 1e-14)
        gone = mass["initial_kg"] - mass["current_kg"] - mass["ejected_kg"] - mass["cropped_kg"]
        self.assertLess(abs(gone), 1e-14 * mass["initial_kg"])
        self.assertLess(momentum["relative_error"], ROUND_OFF)

        self.assertLess(laser["relative_error"], ROUND_OFF)
        self.assertLess(laser["worst_trace_relative_error"], ROUND_OFF)
        # What is left of a ray at its end is deposited as well.
        self.assertAlmostEqual(laser["absorbed_j"] + laser["residual_j"], energy["laser_j"] + energy["undeposited_j"],
                               delta=ROUND_OFF * max(laser["in_j"], 1e-30))
        self.assertEqual(laser["dropped_rays"], 0)

    def test_lively_weld(self):
        """Steps are rejected; a drop leaves through the top and takes its mass, heat and momentum along."""
        case = self.write("drop.toml", f"""
include = "{WELD}"
[[bodies]]
shape = "box"
min_m = [0.0, -0.3e-3, -0.5e-3]
max_m = [0.6e-3, 0.3e-3, 0.0]
[[bodies]]
shape = "ball"
center_m = [0.45e-3, 0.0, 0.2e-3]
radii_m = [0.6e-4, 0.6e-4, 0.6e-4]
temperature_k = 2000.0
velocity_m_s = [0.0, 0.0, 10.0]
""")
        rows, result = self.go("laser.power_w=5000", case=case)
        self.assertGreaterEqual(result["ejected"], 8)
        self.assertGreater(rows["ejected_mass_kg"][-1], 0)
        self.assertGreater(result["rejected_steps"], 0)
        self.assert_closed(rows, result)
        self.assertAlmostEqual(result["budgets"]["laser"]["in_j"], 5000 * 2e-4, delta=1e-12)

    def test_calm_weld(self):
        rows, result = self.go(*TAME, "laser.power_w=1500")
        self.assert_closed(rows, result)
        self.assertTrue(numpy.all(rows["ejected_mass_kg"] == 0))

    def test_all_that_hits_is_absorbed(self):
        """Absorptivity 1 on a closed workpiece: nothing escapes, and the first hit takes all."""
        rows, result = self.go(*TAME, "laser.power_w=700", "laser.absorptivity=1")
        self.assert_closed(rows, result)
        laser = result["budgets"]["laser"]
        self.assertAlmostEqual(laser["absorbed_j"], laser["in_j"], delta=ROUND_OFF * laser["in_j"])
        self.assertEqual((laser["escaped_j"], laser["residual_j"]), (0, 0))
        # rows carry the power of the last trace; the first one is written before any
        self.assertTrue(numpy.allclose(rows["absorbed_power_w"][1:], 700, rtol=1e-12, atol=0))

    def test_constant_absorptivity_of_a_flat_plate(self):
        """Weak beam: the plate stays flat, every ray hits once, 0.3 of the power stays."""
        rows, result = self.go("laser.power_w=50", "laser.absorptivity=0.3")
        self.assert_closed(rows, result)
        laser = result["budgets"]["laser"]
        self.assertAlmostEqual(laser["absorbed_j"], 0.3 * laser["in_j"], delta=ROUND_OFF * laser["in_j"])

    def test_modulated_power(self):
        """In = the integral of P + A sin(2 pi f t); power is frozen over a step, here below 1/500 of the period."""
        rows, result = self.go(*TAME, "laser.power_w=600", 'laser.modulation="sine"', "laser.amplitude_w=500",
                               "laser.frequency_hz=5000", "time.max_step_s=4e-7", "laser.retrace_interval_s=4e-7")
        self.assert_closed(rows, result)
        self.assertAlmostEqual(result["budgets"]["laser"]["in_j"], 600 * 2e-4, delta=2e-3 * 600 * 2e-4)
        expected = 600 + 500 * numpy.sin(2 * numpy.pi * 5000 * rows["time_s"])
        # rows carry the power of the last trace, which is what closes with the absorbed; the first has none
        self.assertTrue(numpy.allclose(rows["laser_power_w"][1:], expected[1:], rtol=0, atol=10))
        out = rows["absorbed_power_w"] + rows["escaped_power_w"] + rows["residual_power_w"]
        self.assertTrue(numpy.allclose(rows["laser_power_w"], out, rtol=1e-9, atol=0))

    def test_held_temperature(self):
        """Heat through a wall is the heat that the block gains."""
        rows, result = self.go(case=REPOSITORY / "cases" / "melting_block.toml", until="1e-3")
        self.assert_closed(rows, result)
        self.assertGreater(result["budgets"]["energy"]["boundary_j"], 0)

    def test_isolated_pool(self):
        """Nothing goes in or out: the error is round-off of the energy that is there, not of a sum that is zero."""
        case = self.write("pool.toml", """
[domain]
dimension = 2
min_m = [0.0, 0.0]
max_m = [5e-4, 4e-4]
spacing_m = 2.5e-5
[[bodies]]
shape = "box"
min_m = [0.0, 0.0]
max_m = [2.5e-4, 2.5e-4]
temperature_k = 2600.0
[[bodies]]
shape = "box"
min_m = [2.5e-4, 0.0]
max_m = [5e-4, 2.5e-4]
temperature_k = 2000.0
[material]
name = "iron"
[terms]
conduction = true
[time]
end_s = 1e-3
[output]
interval_s = 1e-5
""")
        _, result = self.go(case=case)
        self.assertLess(result["budgets"]["energy"]["relative_error"], ROUND_OFF)


if __name__ == "__main__":
    main()
