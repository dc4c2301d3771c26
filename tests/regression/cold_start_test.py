#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Strong light on cold metal: light stands still over a step, so that neither error control nor any limit of the flow,
which has not begun, keeps the first step from heating a particle far beyond boiling.

usage: cold_start_test.py PROGRAM [unittest options]
"""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
# pylint: disable=wrong-import-position
from meltray_runner import REPOSITORY, Scratch, history, main, run, summary  # noqa: E402

WELD = REPOSITORY / "validation" / "studies" / "weld.toml"
# No output cuts the first step short: it was 34 us long, and its particles left at 2 km/s.
LIGHT = ["--set", "laser.power_w=4000", "--set", "output.interval_s=1e-4", "--set", "time.end_s=1e-4"]


class ColdStart(Scratch):
    def test_first_steps_heat_no_further_than_asked(self):
        folder = run(WELD, self.folder / "run", *LIGHT, "--until", "1e-5", "--set", "time.laser_heating_k=400")
        self.assertGreater(summary(folder)["limiter"]["laser"], 0)
        risen = history(folder)["max_temperature_k"][-1] - 300
        self.assertGreater(risen, 1000)
        self.assertLess(risen, 400 * summary(folder)["steps"])

    def test_melt_stays(self):
        folder = run(WELD, self.folder / "run", *LIGHT)
        self.assertLess(history(folder)["max_speed_m_s"].max(), 50)

    def test_limit_is_a_key(self):
        """The less a step may heat, the more steps."""
        steps = {}
        for heating in (200, 800):
            folder = run(WELD, self.folder / f"run{heating}", *LIGHT, "--until", "1e-5", "--set",
                         f"time.laser_heating_k={heating}")
            steps[heating] = summary(folder)["steps"]
        self.assertGreater(steps[200], steps[800])


if __name__ == "__main__":
    main()
