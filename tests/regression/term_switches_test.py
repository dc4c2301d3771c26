#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Every effect that can be switched changes a measured number, in the direction that physics asks for and, where a few lines
give an estimate, by its size.

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

WELD_SPACING = 5e-5  # [m]

LENGTH, DEPTH, SPACING = 1e-3, 0.25e-3, 2.5e-5  # of the pool [m]
TIME, GRAVITY = 1e-4, 9.80665  # of a run; [m/s^2]
# Liquid iron, src/materials/library.cpp, in SI units.
DENSITY, HEAT_CAPACITY, CONDUCTIVITY, EMISSIVITY, EXPANSION = 7035.0, 824.0, 36.0, 0.5, 1.32e-4
TENSION, TENSION_SLOPE, MELTING, BOILING = 1.87, -4.3e-4, 1811.0, 3134.0
VAPORISATION, MOLAR_MASS = 6.09e6, 0.055845
GAS_CONSTANT, STEFAN_BOLTZMANN, EVAPORATION_COEFFICIENT = 8.314463, 5.670374e-8, 0.82
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
SURFACE_TENSION = "terms.surface_tension=true"
MARANGONI = "terms.marangoni=true"


def temperatures(left, right, count=20):
    """Of the stripes of a pool, whose temperature goes from `left` to `right` [K]."""
    return left + (right - left) * (numpy.arange(count) + 0.5) / count


def stripes(left, right):
    """Bodies side by side with these temperatures."""
    of_stripe = temperatures(left, right)
    width = LENGTH / len(of_stripe)
    return "".join(f'[[bodies]]\nshape = "box"\nmin_m = [{i * width:.9g}, 0.0]\nmax_m = [{(i + 1) * width:.9g}, {DEPTH}]\n'
                   f"temperature_k = {t}\n" for i, t in enumerate(of_stripe))


def kinematic_viscosity(temperature):
    """Of liquid iron by its law of Andrade [m^2/s]."""
    return 10 ** (-3.7209 + 2694.95 / temperature) / DENSITY


def evaporated_heat(temperature):
    """Heat flux of evaporation after Hertz and Knudsen, with the vapour pressure of Clausius and Clapeyron [W/m^2]."""
    pressure = 101325 * numpy.exp(VAPORISATION * MOLAR_MASS / GAS_CONSTANT * (1 / BOILING - 1 / temperature))
    flux = EVAPORATION_COEFFICIENT * pressure * numpy.sqrt(MOLAR_MASS / (2 * numpy.pi * GAS_CONSTANT * temperature))
    return VAPORISATION * flux


def radiated_heat(temperature):
    """Heat flux of radiation [W/m^2]."""
    return EMISSIVITY * STEFAN_BOLTZMANN * (temperature ** 4 - 300.0 ** 4)


def conducted(profile, spacing):
    """A profile of temperature after the time of a run, by finite differences between adiabatic walls."""
    steps = 100
    number = CONDUCTIVITY / (DENSITY * HEAT_CAPACITY) * TIME / steps / spacing ** 2
    for _ in range(steps):
        flux = number * numpy.diff(profile)
        profile = profile + numpy.append(flux, 0) - numpy.insert(flux, 0, 0)
    return profile


def cap_height(angle_deg):
    """Centroid's height of half a disc's area that rests at a contact angle, over that of the half disc."""
    a = numpy.radians(angle_deg)
    area = a - numpy.sin(a) * numpy.cos(a)  # over the square of the cap's radius, as the height over the radius
    height = 2 / 3 * numpy.sin(a) ** 3 / area - numpy.cos(a)
    return height * numpy.sqrt(numpy.pi / 2 / area) / (4 / (3 * numpy.pi))


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
        """Particles of the drop on the wall at the start and at the end."""
        files = snapshots(self.go(self.write("drop.toml", DROP), *settings))
        return [particles(files[k]) for k in (0, -1)]

    def weld(self, *settings):
        """History and summary of the small weld."""
        named = {s.partition("=")[0]: s for s in (*TAME, *settings)}
        if named.get("terms.interface_viscosity") == "terms.interface_viscosity=false":
            named = {key: s for key, s in named.items() if not key.startswith("flow.interface")}
        folder = self.go(WELD, *named.values())
        return history(folder), summary(folder)

    def assert_about(self, found, estimate):
        """Same sign, and within a factor of two: what an estimate with rounded geometry can promise."""
        self.assertGreater(found / estimate, 0.5)
        self.assertLess(found / estimate, 2)


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
        expected = -TENSION_SLOPE * 600 / LENGTH * TIME / (DENSITY * SPACING)
        right, _ = self.pool(2600, 2000, SURFACE_TENSION, MARANGONI)
        self.assertAlmostEqual(surface_speed(right), expected, delta=0.1 * expected)
        left, _ = self.pool(2000, 2600, SURFACE_TENSION, MARANGONI)
        self.assertAlmostEqual(surface_speed(left), -surface_speed(right), delta=1e-4 * expected)
        off, _ = self.pool(2600, 2000, SURFACE_TENSION)
        self.assertLess(abs(surface_speed(off)), 0.02 * expected)

    def test_marangoni_leaves_the_walls_alone(self):
        """Adiabatic walls have no temperature of their own: no stress along them, no particle is thrown out."""
        _, result = self.pool(2400, 2200, SURFACE_TENSION, MARANGONI)
        impulse = result["budgets"]["momentum"]["surface"]
        self.assertLess(abs(impulse[1]), 0.1 * abs(impulse[0]))
        self.assertEqual((result["ejected"], result["budgets"]["mass"]["current_kg"]),
                         (0, result["budgets"]["mass"]["initial_kg"]))

    def test_interface_viscosity_holds_the_surface_back(self):
        """Of Monaghan's form: nu = alpha c h / 8 in the plane. Between the top layer, where |grad c| h is about a half,
        and the next, which has none, alpha is a quarter of alpha_LG; the top layer loses nu t / (2 dx^2) of its speed, t
        / 2 because that grows in proportion to the time."""
        free, _ = self.pool(2600, 2000, SURFACE_TENSION, MARANGONI)
        weak, strong = 0.01, 1.0

        def lost(strength):
            held, _ = self.pool(2600, 2000, SURFACE_TENSION, MARANGONI, "terms.interface_viscosity=true",
                                "flow.reference_speed_m_s=50", f"flow.interface_viscosity_free={strength}")
            return 1 - surface_speed(held) / surface_speed(free)

        self.assert_about(lost(weak), weak / 4 * 50 * 1.3 * SPACING / 8 * TIME / (2 * SPACING ** 2))
        # Strong, it makes the two layers one: they share the momentum.
        self.assert_about(lost(strong), 0.5)
        self.assertLess(lost(strong), 1)

    def test_viscosity(self):
        """The top layer loses nu t / (2 dx^2) of its speed to the next one."""
        with_it, _ = self.pool(2600, 2000, SURFACE_TENSION, MARANGONI)
        without, _ = self.pool(2600, 2000, SURFACE_TENSION, MARANGONI, "terms.viscosity=false")
        self.assert_about(surface_speed(without) / surface_speed(with_it) - 1,
                          kinematic_viscosity(2300) * TIME / (2 * SPACING ** 2))

    def test_buoyancy_lifts_the_hot_side(self):
        """The impulse is that of the mean excess temperature. In shallow melt the pressure is hydrostatic: at the height
        z the excess b = g beta (T - T_mean) drives -b' (H - z) along x, what arrives in an end quarter of length L / 4
        lifts its top by b' H^2 / 2 / (L / 4), its mean by two thirds of that."""
        off, fallen = self.pool(2600, 2000, "terms.gravity=true")
        on, lifted = self.pool(2600, 2000, "terms.gravity=true", "terms.buoyancy=true")
        slope = GRAVITY * EXPANSION * 600 / LENGTH
        self.assert_about(rise(on), 2 * 2 / 3 * slope * DEPTH ** 2 / 2 / (LENGTH / 4) * TIME)
        self.assertLess(abs(rise(off)), 0.02 * rise(on))
        weight = DENSITY * LENGTH * DEPTH * GRAVITY * TIME
        impulse = [r["budgets"]["momentum"]["gravity"][1] for r in (fallen, lifted)]
        self.assertAlmostEqual(impulse[0], -weight, delta=1e-6 * weight)
        # conduction moves heat and does not change its sum
        self.assertAlmostEqual(impulse[1] - impulse[0], EXPANSION * (2300 - MELTING) * weight, delta=1e-6 * weight)
        mirrored, _ = self.pool(2000, 2600, "terms.gravity=true", "terms.buoyancy=true")
        self.assertAlmostEqual(rise(mirrored), -rise(on), delta=0.01 * rise(on))

    def test_evaporation_and_radiation_cool(self):
        """By their fluxes through the flat surface, one metre across, at the temperatures of the start."""
        for term, flux, left, right in (("evaporation", evaporated_heat, 2900, 2700),
                                        ("radiation", radiated_heat, 3500, 3000)):
            _, result = self.pool(left, right, f"terms.{term}=true")
            budget = result["budgets"]["energy"]
            loss = budget["initial_j"] - budget["stored_j"]
            self.assert_about(loss, flux(temperatures(left, right)).mean() * LENGTH * TIME)
            self.assertAlmostEqual(budget[f"{term}_j"], loss, delta=1e-9 * loss)
            others = {"evaporation", "radiation"} - {term}
            self.assertEqual([budget[f"{o}_j"] for o in others], [0])

    def test_conduction(self):
        """Heat goes from the hot to the cold side as finite differences say, and nowhere without the term."""
        spread = []
        for setting in ("terms.conduction=true", "terms.conduction=false"):
            p, _ = self.pool(2600, 2000, setting, "terms.gravity=true")
            spread.append(numpy.ptp(p["temperature"]))
        start = numpy.repeat(temperatures(2600, 2000), 2)  # two columns of particles a stripe
        self.assertAlmostEqual(spread[1], numpy.ptp(start), delta=1e-3)
        self.assert_about(spread[1] - spread[0], spread[1] - numpy.ptp(conducted(start, SPACING)))


class Drop(Switches):
    def test_wetting(self):
        """A small contact angle spreads the half disc over the wall, a large one lifts it; at 90 degrees it rests. The
        time is a good half of sqrt(rho R^3 / sigma), in which inertia takes it to its cap."""
        change = {}
        for angle in (40, 90, 140):
            start, end = self.drop(SURFACE_TENSION, "terms.wetting=true", f"material.contact_angle_deg={angle}")
            change[angle] = end["position"][:, 2].mean() / start["position"][:, 2].mean() - 1
        for angle in (40, 140):
            self.assert_about(change[angle], cap_height(angle) - 1)
        self.assertAlmostEqual(change[90], 0, delta=0.02)

    def test_surface_tension(self):
        """The pressure inside is sigma / R; nothing else could make one."""
        def inside(particles_):
            x = particles_["position"]
            return particles_["pressure"][numpy.hypot(x[:, 0], x[:, 2]) < 1e-4].mean()

        laplace = (TENSION + TENSION_SLOPE * (2000 - MELTING)) / 2e-4
        self.assert_about(inside(self.drop(SURFACE_TENSION)[-1]), laplace)
        self.assertLess(abs(inside(self.drop()[-1])), 1e-3 * laplace)


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

    def test_recoil_at_the_face_drills_before_particles_boil(self):
        """Light heats the face half a spacing above a particle's centre: melt is pushed while it is colder inside."""
        reference = history(self.reference)
        face, result = self.weld('surface.temperature="face"')
        self.assertGreater(face["capillary_depth_m"][-1], 1.2 * reference["capillary_depth_m"][-1])
        self.assertLess(face["max_temperature_k"][-1], reference["max_temperature_k"][-1] - 500)
        self.assertLess(abs(result["budgets"]["energy"]["relative_error"]), 1e-12)
        wcsph = ('model="wcsph_reduced"', "terms.interface_viscosity=false", 'time.method="multirate"',
                 "time.fixed_step_s=1e-6", "time.cfl_acoustic=1", "flow.sound_speed_m_s=140",
                 "flow.artificial_viscosity=0.35")
        weak, weak_face = (self.weld(*wcsph, f'surface.temperature="{where}"')[0] for where in ("particle", "face"))
        self.assertGreater(weak_face["capillary_depth_m"][-1], 1.2 * weak["capillary_depth_m"][-1])
        self.assertLess(weak_face["max_temperature_k"][-1], weak["max_temperature_k"][-1] - 500)

    def test_evaporation_limits_the_temperature(self):
        """On a surface that stays flat (no recoil): what evaporation carries away is missing in the hottest particle."""
        cool, _ = self.weld("terms.recoil=false")
        hot, result = self.weld("terms.recoil=false", "terms.evaporation=false")
        self.assertGreater(hot["max_temperature_k"][-1], cool["max_temperature_k"][-1] + 500)
        self.assertEqual(result["budgets"]["energy"]["evaporation_j"], 0)

    def test_gravity_and_buoyancy(self):
        """Impulses of the weight of the melt, and of what its expansion takes off: about as much as at the boiling
        point."""
        reference, with_both = self.weld("time.end_s=1e-4")
        mass = reference["liquid_particles"].mean() * DENSITY * WELD_SPACING ** 3
        weight = mass * GRAVITY * TIME
        lift = EXPANSION * (BOILING - MELTING) * weight
        _, heavy = self.weld("terms.buoyancy=false", "time.end_s=1e-4")
        _, light = self.weld("terms.gravity=false", "time.end_s=1e-4")
        both, gravity, buoyancy = (r["budgets"]["momentum"]["gravity"][2] for r in (with_both, heavy, light))
        self.assert_about(gravity, -weight)
        self.assert_about(buoyancy, lift)
        # The flow hardly feels either: the same melt.
        self.assertAlmostEqual(both, gravity + buoyancy, delta=0.01 * weight)

    def test_radiation(self):
        """About what the top of the melt radiates at the boiling point."""
        reference, with_it = self.weld("time.end_s=1e-4")
        _, without = self.weld("terms.radiation=false", "time.end_s=1e-4")
        area = reference["liquid_particles"].mean() * WELD_SPACING ** 2
        self.assert_about(with_it["budgets"]["energy"]["radiation_j"], radiated_heat(BOILING) * area * TIME)
        self.assertEqual(without["budgets"]["energy"]["radiation_j"], 0)

    def test_marangoni_drags_melt_out_of_the_hollow(self):
        """From its hot bottom to its rim. Surface tension and recoil count as pressure: nothing else acts along the
        surface."""
        _, with_it = self.weld("terms.wetting=false", "time.end_s=1e-4")
        _, without = self.weld("terms.wetting=false", "terms.marangoni=false", "time.end_s=1e-4")
        x, y, z = with_it["budgets"]["momentum"]["surface"]
        self.assertGreater(z, numpy.hypot(x, y))
        self.assertEqual(without["budgets"]["momentum"]["surface"], [0, 0, 0])

    def test_interface_viscosity_holds_the_melt_back(self):
        """Several hundred times the viscosity of iron in a film of one particle: without it the melt is twice as fast or
        more."""
        held, _ = self.weld("time.end_s=2e-4")
        free, _ = self.weld("terms.interface_viscosity=false", "time.end_s=2e-4")
        self.assertGreater(free["max_speed_m_s"].mean(), 2 * held["max_speed_m_s"].mean())


if __name__ == "__main__":
    main()
