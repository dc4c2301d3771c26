#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Every effect that can be switched changes a measured number, in the direction that physics asks for.

usage: term_switches_test.py PROGRAM [unittest options]
"""
import pathlib
import sys
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "integration"))
# pylint: disable=wrong-import-position
from meltray_runner import CASES, Scratch, history, main, particles, run, snapshots, summary  # noqa: E402

WELD = CASES / "tiny_weld.toml"
# Tamer than the case itself: no drop leaves the box.
TAME = ["flow.interface_viscosity_free=1", "flow.interface_viscosity_solid=1", "laser.power_w=1500"]

LENGTH, DEPTH, SPACING = 1e-3, 0.25e-3, 2.5e-5  # of the pool [m]
DENSITY, TENSION_SLOPE, EXPANSION, GRAVITY = 7035.0, -4.3e-4, 1.2e-4, 9.80665  # liquid iron, see `meltray list materials`
POOL = f"""title = "Pool of liquid iron in the x-z plane, its temperature falls or rises along x"
[domain]
dimension = 2
min_m = [0.0, 0.0]
max_m = [{LENGTH}, 0.4e-3]
spacing_m = {SPACING}
[faces.x_min]
kind = "wall"
[faces.x_max]
kind = "wall"
[faces.z_min]
kind = "wall"
[material]
name = "iron"
[terms]
conduction = true
viscosity = true
pressure = true
[time]
end_s = 1e-4
[output]
interval_s = 1e-5
"""
DROP = """title = "Half a drop of liquid iron on a wall, in the x-z plane"
[domain]
dimension = 2
min_m = [-0.4e-3, 0.0]
max_m = [0.4e-3, 0.4e-3]
spacing_m = 2.5e-5
[faces.z_min]
kind = "wall"
[[bodies]]
shape = "ball"
center_m = [0.0, 0.0]
radii_m = [0.2e-3, 0.2e-3]
temperature_k = 2000.0
[material]
name = "iron"
[terms]
viscosity = true
pressure = true
[time]
end_s = 1e-4
[output]
interval_s = 1e-5
"""
TENSION = "terms.surface_tension=true"
MARANGONI = "terms.marangoni=true"


def stripes(left, right, count=20):
    """Bodies side by side whose temperature goes from `left` to `right` [K]."""
    width = LENGTH / count
    return "".join(f'[[bodies]]\nshape = "box"\nmin_m = [{i * width:.9g}, 0.0]\nmax_m = [{(i + 1) * width:.9g}, {DEPTH}]\n'
                   f"temperature_k = {left + (right - left) * (i + 0.5) / count}\n" for i in range(count))


class Switches(Scratch):
    def go(self, case, *settings):
        """Run folder of a case with settings."""
        number = len(list(self.folder.iterdir()))
        options = [x for s in settings for x in ("--set", s)]
        return run(case, self.folder / f"run-{number}", "--threads", "1", *options)

    def pool(self, left, right, *settings):
        """Particles and summary of the pool at the end."""
        folder = self.go(self.write("pool.toml", POOL + stripes(left, right)), *settings)
        return particles(snapshots(folder)[-1]), summary(folder)

    def drop(self, *settings):
        """Positions of the drop on the wall at the start and at the end."""
        files = snapshots(self.go(self.write("drop.toml", DROP), *settings))
        return [particles(files[k])["position"] for k in (0, -1)]

    def weld(self, *settings):
        """History and summary of the small weld."""
        named = {s.partition("=")[0]: s for s in (*TAME, *settings)}
        if named.get("terms.interface_viscosity") == "terms.interface_viscosity=false":
            named = {key: s for key, s in named.items() if not key.startswith("flow.interface")}
        folder = self.go(WELD, *named.values())
        return history(folder), summary(folder)


def surface_speed(p):
    """Mean speed along x of the top layer, away from the walls [m/s]."""
    x, v = p["position"], p["velocity"]
    layer = (x[:, 2] > DEPTH - SPACING) & (numpy.abs(x[:, 0] - LENGTH / 2) < LENGTH / 4)
    return v[layer, 0].mean()


def rise(p):
    """How much faster the left quarter rises than the right one [m/s]."""
    x, w = p["position"][:, 0], p["velocity"][:, 2]
    return w[x < LENGTH / 4].mean() - w[x > 3 * LENGTH / 4].mean()


class Pool(Switches):
    def test_marangoni_flows_from_hot_to_cold(self):
        """The stress sigma_T dT/dx moves the top layer: tau t / (rho dx), before viscosity spreads it downwards."""
        expected = -TENSION_SLOPE * 600 / LENGTH * 1e-4 / (DENSITY * SPACING)
        right, _ = self.pool(2600, 2000, TENSION, MARANGONI)
        self.assertAlmostEqual(surface_speed(right), expected, delta=0.1 * expected)
        left, _ = self.pool(2000, 2600, TENSION, MARANGONI)
        self.assertAlmostEqual(surface_speed(left), -surface_speed(right), delta=1e-4 * expected)
        off, _ = self.pool(2600, 2000, TENSION)
        self.assertLess(abs(surface_speed(off)), 0.02 * expected)

    def test_marangoni_leaves_the_walls_alone(self):
        """Adiabatic walls have no temperature of their own: no stress along them, no particle is thrown out."""
        _, result = self.pool(2400, 2200, TENSION, MARANGONI)
        impulse = result["budgets"]["momentum"]["surface"]
        self.assertLess(abs(impulse[1]), 0.1 * abs(impulse[0]))
        self.assertEqual((result["ejected"], result["budgets"]["mass"]["current_kg"]),
                         (0, result["budgets"]["mass"]["initial_kg"]))

    def test_interface_viscosity_holds_the_surface_back(self):
        free, _ = self.pool(2600, 2000, TENSION, MARANGONI)
        held, _ = self.pool(2600, 2000, TENSION, MARANGONI, "terms.interface_viscosity=true",
                            "flow.reference_speed_m_s=50")
        self.assertGreater(surface_speed(held), 0)
        self.assertLess(surface_speed(held), 0.7 * surface_speed(free))

    def test_viscosity(self):
        with_it, _ = self.pool(2600, 2000, TENSION, MARANGONI)
        without, _ = self.pool(2600, 2000, TENSION, MARANGONI, "terms.viscosity=false")
        self.assertGreater(surface_speed(without), 1.01 * surface_speed(with_it))

    def test_buoyancy_lifts_the_hot_side(self):
        off, fallen = self.pool(2600, 2000, "terms.gravity=true")
        on, lifted = self.pool(2600, 2000, "terms.gravity=true", "terms.buoyancy=true")
        self.assertGreater(rise(on), 10 * abs(rise(off)))
        weight = DENSITY * LENGTH * DEPTH * GRAVITY * 1e-4
        impulse = [r["budgets"]["momentum"]["gravity"][1] for r in (fallen, lifted)]
        self.assertAlmostEqual(impulse[0], -weight, delta=1e-6 * weight)
        self.assertGreater(impulse[1] - impulse[0], 0.01 * weight)
        mirrored, _ = self.pool(2000, 2600, "terms.gravity=true", "terms.buoyancy=true")
        self.assertAlmostEqual(rise(mirrored), -rise(on), delta=0.01 * rise(on))

    def test_evaporation_and_radiation_cool(self):
        for term in ("evaporation", "radiation"):
            _, result = self.pool(3500, 3000, f"terms.{term}=true")
            budget = result["budgets"]["energy"]
            loss = budget["initial_j"] - budget["stored_j"]
            self.assertGreater(loss, 0.1)
            self.assertAlmostEqual(budget[f"{term}_j"], loss, delta=1e-9 * loss)
            others = {"evaporation", "radiation"} - {term}
            self.assertEqual([budget[f"{o}_j"] for o in others], [0])

    def test_conduction(self):
        """Heat goes from the hot to the cold side, and nowhere without the term."""
        spread = []
        for setting in ("terms.conduction=true", "terms.conduction=false"):
            p, _ = self.pool(2600, 2000, setting, "terms.gravity=true")
            spread.append(numpy.ptp(p["temperature"]))
        self.assertLess(spread[0], spread[1] - 1)
        self.assertAlmostEqual(spread[1], 600 * 19 / 20, delta=1e-3)


class Drop(Switches):
    def test_wetting(self):
        """A small contact angle spreads the half disc over the wall, a large one lifts it; at 90 degrees it rests."""
        rise = {}
        for angle in (40, 90, 140):
            start, end = self.drop(TENSION, "terms.wetting=true", f"material.contact_angle_deg={angle}")
            rise[angle] = end[:, 2].mean() / start[:, 2].mean()
        self.assertLess(rise[40], 0.85)
        self.assertGreater(rise[140], 1.3)
        self.assertAlmostEqual(rise[90], 1, delta=0.02)

    def test_surface_tension(self):
        self.assertNotAlmostEqual(self.drop(TENSION)[-1][:, 2].mean(), self.drop()[-1][:, 2].mean(), delta=1e-6)


class Weld(Switches):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        options = [x for s in TAME for x in ("--set", s)]
        cls.reference = run(WELD, cls.shared / "reference", "--threads", "1", *options)

    def test_a_fifth_of_the_power_is_shallower(self):
        depth = history(self.reference)["capillary_depth_m"][-1]
        weak, _ = self.weld("laser.power_w=300")
        self.assertGreater(depth, 3e-5)
        self.assertLess(weak["capillary_depth_m"][-1], 0.2 * depth)
        self.assertLess(weak["max_temperature_k"].max(), history(self.reference)["max_temperature_k"].max() - 500)

    def test_recoil_drills(self):
        without, _ = self.weld("terms.recoil=false")
        self.assertLess(without["capillary_depth_m"][-1], 0.2 * history(self.reference)["capillary_depth_m"][-1])
        self.assertLess(without["max_speed_m_s"].max(), 1.0)

    def test_evaporation_limits_the_temperature(self):
        """On a surface that stays flat (no recoil): what evaporation carries away is missing in the hottest particle."""
        cool, _ = self.weld("terms.recoil=false")
        hot, result = self.weld("terms.recoil=false", "terms.evaporation=false")
        self.assertGreater(hot["max_temperature_k"][-1], cool["max_temperature_k"][-1] + 500)
        self.assertEqual(result["budgets"]["energy"]["evaporation_j"], 0)

    def test_every_other_switch_changes_the_weld(self):
        reference, _ = self.weld("time.end_s=1e-4")
        for term in ("marangoni", "wetting", "interface_viscosity", "buoyancy", "radiation", "viscosity", "gravity"):
            with self.subTest(term):
                changed, _ = self.weld(f"terms.{term}=false", "time.end_s=1e-4")
                self.assertGreater(numpy.abs(changed["max_speed_m_s"] - reference["max_speed_m_s"]).max(), 1e-9)


if __name__ == "__main__":
    main()
