#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Malformed case files: exit code 2, a message with file, line, key, what was found and what is allowed, no output.

usage: malformed_cases_test.py PROGRAM [unittest options]
"""
import collections
import re

from meltray_runner import Scratch, main, meltray

CASE = """title = "sample"

[domain]
min_m = [0.0, -4e-4, -8e-4]
max_m = [1e-3, 4e-4, 4e-4]
spacing_m = 5e-5

[faces.z_min]
kind = "wall"

[[bodies]]
shape = "box"
min_m = [0.0, -4e-4, -8e-4]
max_m = [1e-3, 4e-4, 0.0]

[material]
name = "iron"

[terms]
conduction = true
pressure = true
viscosity = true
surface_tension = true
melting = true

[laser]
power_w = 1000

[time]
end_s = 1e-3

[output]
interval_s = 1e-5
"""

Malformed = collections.namedtuple("Malformed", "kind name old new message options files", defaults=[(), {}])


def edit(kind, name, old, new, *message):
    """The sample with `old` replaced by `new`."""
    return Malformed(kind, name, old, new, message)


def append(kind, name, new, *message):
    """The sample with lines at its end (line 34)."""
    return Malformed(kind, name, None, new, message)


def with_set(kind, name, options, *message):
    """The sample as it is, with --set options."""
    return Malformed(kind, name, None, "", message, [x for o in options for x in ("--set", o)])


def with_files(kind, name, text, files, *message):
    """Another text, beside other files."""
    return Malformed(kind, name, CASE, text, message, (), files)


FOUND_UNKNOWN = "found an unknown key; allowed "
TABLE = [
    append("syntax", "unclosed string", 'x = "abc\n', "case.toml:34: TOML syntax: "),
    append("syntax", "unclosed section", "[heat\n", "case.toml:34: TOML syntax: "),
    edit("syntax", "no value", "end_s = 1e-3", "end_s =", "case.toml:30: TOML syntax: "),
    edit("syntax", "words without quotes", 'name = "iron"', "name = iron", "case.toml:17: TOML syntax: "),
    edit("syntax", "array not closed", "max_m = [1e-3, 4e-4, 0.0]", "max_m = [1e-3, 4e-4, 0.0", "case.toml:",
         "TOML syntax: "),
    edit("syntax", "comma for a point", "power_w = 1000", "power_w = 1000,5", "case.toml:27: TOML syntax: "),
    with_set("syntax", "--set without a value", ["time.end_s"], "--set: 'time.end_s'", "allowed section.key=value"),

    edit("unknown key", "typing error", "spacing_m", "spacng_m", "case.toml:6: domain.spacng_m: " + FOUND_UNKNOWN,
         "did you mean 'domain.spacing_m'?"),
    append("unknown key", "section", "[lasre]\n", "case.toml:34: lasre: found an unknown section",
           "did you mean 'laser'?"),
    append("unknown key", "key of another section", "[heat]\nend_s = 1\n", "case.toml:35: heat.end_s: " + FOUND_UNKNOWN,
           "did you mean 'time.end_s'?"),
    edit("unknown key", "face", "[faces.z_min]", "[faces.z_mim]", "case.toml:9: faces.z_mim.kind: " + FOUND_UNKNOWN,
         "did you mean 'faces.z_min.kind'?"),
    with_set("unknown key", "--set", ["laser.powr_w=3"], "--set: laser.powr_w: " + FOUND_UNKNOWN,
             "did you mean 'laser.power_w'?"),
    append("unknown key", "body that is not there", "[bodies2]\n", "case.toml:34: bodies2: found an unknown section"),

    edit("type", "text for a number", "spacing_m = 5e-5", 'spacing_m = "5e-5"',
         'case.toml:6: domain.spacing_m: found "5e-5" (text); allowed a number > 0 [m]'),
    edit("type", "boolean for a number", "end_s = 1e-3", "end_s = true",
         "case.toml:30: time.end_s: found true (boolean); allowed a number > 0 [s]"),
    edit("type", "number for a boolean", "melting = true", "melting = 1",
         "case.toml:24: terms.melting: found 1; allowed true or false"),
    edit("type", "fraction for an integer", "power_w = 1000", "power_w = 1000\nrays = 1.5",
         "case.toml:28: laser.rays: found 1.5; allowed an integer"),
    edit("type", "number for a vector", "min_m = [0.0, -4e-4, -8e-4]\nmax_m = [1e-3, 4e-4, 4e-4]",
         "min_m = 0.0\nmax_m = [1e-3, 4e-4, 4e-4]", "case.toml:4: domain.min_m: found 0.0; allowed an array"),
    edit("type", "two entries in 3-D", "max_m = [1e-3, 4e-4, 4e-4]", "max_m = [1e-3, 4e-4]",
         "case.toml:5: domain.max_m: found ", "with 2 entries; allowed 3 entries"),
    edit("type", "unknown word", "power_w = 1000", 'power_w = 1000\nprofile = "gausian"',
         'case.toml:28: laser.profile: found "gausian"', 'allowed "gaussian", "top_hat"', "did you mean 'gaussian'?"),
    edit("type", "date", "end_s = 1e-3", "end_s = 2024-01-01", "case.toml:30: time.end_s: found a date or time"),

    edit("range", "negative spacing", "spacing_m = 5e-5", "spacing_m = -5e-5",
         "case.toml:6: domain.spacing_m: found -5e-05; allowed a number > 0 [m]"),
    edit("range", "no power", "power_w = 1000", "power_w = 0",
         "case.toml:27: laser.power_w: found 0; allowed a number > 0"),
    edit("range", "grazing beam", "power_w = 1000", "power_w = 1000\nincidence_deg = 95",
         "case.toml:28: laser.incidence_deg: found 95; allowed ", "[deg]"),
    edit("range", "absorptivity above 1", "power_w = 1000", "power_w = 1000\nabsorptivity = 1.2",
         "case.toml:28: laser.absorptivity: found 1.2; allowed "),
    edit("range", "order 6", "end_s = 1e-3", "end_s = 1e-3\norder = 6",
         "case.toml:31: time.order: found 6; allowed an integer from 1 to 5"),
    edit("range", "below absolute zero", 'shape = "box"', 'shape = "box"\ntemperature_k = -20',
         "case.toml:13: bodies.0.temperature_k: found -20; allowed a number > 0", "[K]"),
    edit("range", "more particles than memory", "spacing_m = 5e-5", "spacing_m = 7.7e-7",
         "domain.spacing_m: found 7.7e-07, at least ", "GB of memory; allowed: a spacing of "),
    edit("range", "too many particles", "spacing_m = 5e-5", "spacing_m = 1e-9", "case.toml:6: domain.spacing_m: found ",
         "particles", "allowed "),

    edit("contradiction", "unit of another key", "power_w = 1000", "power_kw = 1",
         "case.toml:27: laser.power_kw: " + FOUND_UNKNOWN, "did you mean 'laser.power_w'?"),
    edit("contradiction", "box upside down", "max_m = [1e-3, 4e-4, 4e-4]", "max_m = [1e-3, 4e-4, -9e-4]",
         "case.toml:5: domain.max_m: found -0.0009 in z where min_m is -0.0008; allowed ", "max_m > min_m"),
    edit("contradiction", "periodic on one side", "[faces.z_min]\nkind = \"wall\"",
         "[faces.x_min]\nkind = \"periodic\"", "case.toml:9: faces.x_min.kind: found ", "faces.x_max.kind as well"),
    edit("contradiction", "order 1 of imex", "end_s = 1e-3", "end_s = 1e-3\norder = 1",
         'case.toml:31: time.order: found 1 with method "imex"; allowed 2 to 5'),
    edit("contradiction", "solidus above liquidus", 'name = "iron"', 'name = "iron"\nsolidus_k = 1900',
         "case.toml:18: material.solidus_k: found solidus 1900 K", "allowed solidus_k < liquidus_k"),
    edit("contradiction", "beam beside the workpiece", "power_w = 1000", "power_w = 1000\nstart_y_m = 1e-2",
         "case.toml:28: laser.start_y_m: found 0.01; allowed a place in the domain"),
    edit("contradiction", "negative power of a sine", "power_w = 1000",
         'power_w = 1000\nmodulation = "sine"\namplitude_w = 1001\nfrequency_hz = 5',
         "case.toml:29: laser.amplitude_w: found 1001; allowed at most laser.power_w = 1000"),
    append("contradiction", "term that is not smooth implicit", '[splitting]\nsurface_tension = "implicit"\n',
           'case.toml:35: splitting.surface_tension: found "implicit"', "not smooth"),
    edit("contradiction", "smallest step above the largest", "end_s = 1e-3",
         "end_s = 1e-3\nmin_step_s = 1e-5\nmax_step_s = 1e-6",
         "case.toml:31: time.min_step_s: found 1e-05; allowed less than time.max_step_s"),

    edit("inert", "amplitude of constant power", "power_w = 1000", "power_w = 1000\namplitude_w = 5",
         "case.toml:28: laser.amplitude_w: found 5, which has no effect here; allowed this key only with "
         'laser.modulation = "sine"'),
    append("inert", "interface viscosity off", "[flow]\ninterface_viscosity_free = 1.0\n",
           "case.toml:35: flow.interface_viscosity_free: found 1.0, which has no effect here",
           "terms.interface_viscosity = true"),
    edit("inert", "temperature of an adiabatic face", 'kind = "wall"', 'kind = "wall"\ntemperature_k = 300',
         "case.toml:10: faces.z_min.temperature_k: found 300, which has no effect here", 'thermal = "temperature"'),
    edit("inert", "marangoni alone", "surface_tension = true", "marangoni = true",
         "case.toml:23: terms.marangoni: found true without effect", "terms.surface_tension"),
    edit("inert", "jitter of a lattice", "spacing_m = 5e-5", "spacing_m = 5e-5\njitter = 0.1",
         "case.toml:7: domain.jitter: found 0.1, which has no effect here", 'domain.arrangement = "jittered"'),
    edit("inert", "first step of fixed steps", "end_s = 1e-3",
         "end_s = 1e-3\nfixed_step_s = 1e-6\ninitial_step_s = 1e-7", "case.toml:32: time.initial_step_s: found 1e-07",
         "time.fixed_step_s = 0"),

    with_files("missing file", "include", 'title = "x"\ninclude = "gone.toml"\n' + CASE.partition("\n")[2], {},
               "case.toml:2: include: found no such file", "gone.toml"),
    with_files("missing file", "include of a folder", 'include = "."\n' + CASE, {},
               "case.toml:1: include: found a folder"),
    with_files("missing file", "include of an include", 'include = "base.toml"\n' + CASE,
               {"base.toml": '\ninclude = "gone.toml"\n'}, "base.toml:2: include: found no such file", "gone.toml"),
    edit("missing file", "power table", "power_w = 1000", 'modulation = "table"\npower_table = "nowhere.csv"',
         "case.toml:28: laser.power_table: found no readable file at ", "nowhere.csv", "allowed "),

    with_files("include cycle", "itself", 'include = "case.toml"\n' + CASE, {},
               "case.toml:1: include: found a cycle: case.toml -> case.toml"),
    with_files("include cycle", "two files", 'include = "b.toml"\n' + CASE, {"b.toml": '\n\ninclude = "case.toml"\n'},
               "b.toml:3: include: found a cycle: case.toml -> b.toml -> case.toml"),
    with_files("include cycle", "below the case", 'include = ["b.toml"]\n' + CASE,
               {"b.toml": 'include = "c.toml"\n', "c.toml": 'include = ["./b.toml"]\n'},
               "c.toml:1: include: found a cycle: ", "b.toml -> c.toml -> b.toml"),

    edit("non-finite", "nan", "end_s = 1e-3", "end_s = nan",
         "case.toml:30: time.end_s: found nan; allowed finite numbers: a number > 0 [s]"),
    edit("non-finite", "inf", "power_w = 1000", "power_w = inf", "case.toml:27: laser.power_w: found inf; allowed finite"),
    edit("non-finite", "in a vector", "max_m = [1e-3, 4e-4, 0.0]", "max_m = [1e-3, nan, 0.0]",
         "case.toml:14: bodies.0.max_m: found ", "allowed finite"),
    edit("non-finite", "overflow", "spacing_m = 5e-5", "spacing_m = 1e999", "case.toml:6: ", "1e999"),
    with_set("non-finite", "--set", ["time.rtol=nan"], "--set: time.rtol: found nan; allowed finite"),

    edit("duplicate", "key", "end_s = 1e-3", "end_s = 1e-3\nend_s = 2e-3", "case.toml:31: TOML syntax: ", "end_s"),
    append("duplicate", "section", "[time]\nrtol = 1e-3\n", "case.toml:34: TOML syntax: ", "time"),
    with_files("duplicate", "face in two ways", 'faces.z_min.kind = "free"\n' + CASE, {},
               "case.toml:9: TOML syntax: ", "z_min"),
    with_set("duplicate", "--set", ["time.end_s=1", "time.end_s=2"], "--set: time.end_s: found a duplicate"),
]


class MalformedCases(Scratch):
    def check(self, command, case):
        folder = self.folder / f"{command}-{TABLE.index(case)}"
        folder.mkdir()
        text = CASE + case.new if case.old is None else CASE.replace(case.old, case.new, 1)
        files = {"case.toml": text, **case.files}
        for name, content in files.items():
            (folder / name).write_text(content, encoding="utf-8")
        if case.old is not None:
            self.assertIn(case.old, CASE)
        output = ["--out", folder / "out"] if command == "run" else []
        done = meltray(command, "case.toml", *case.options, *output, cwd=folder)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        for part in case.message:
            self.assertIn(part, done.stderr)
        self.assertEqual(done.stdout, "", "nothing but the message")
        self.assertEqual({path.name for path in folder.iterdir()}, set(files), "nothing is written")

    def test_table(self):
        for command in ("check", "run"):
            for case in TABLE:
                with self.subTest(command=command, kind=case.kind, name=case.name):
                    self.check(command, case)

    def test_table_covers_every_kind(self):
        count = collections.Counter(case.kind for case in TABLE)
        self.assertGreaterEqual(len(TABLE), 40)
        self.assertEqual(len(count), 10)
        self.assertGreaterEqual(min(count.values()), 3, count)

    def test_sample_is_well_formed(self):
        """Every case of the table is wrong in its edit only."""
        self.write("case.toml", CASE)
        done = meltray("check", "case.toml", cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_message_form(self):
        """meltray: FILE:LINE: KEY: found X; allowed Y"""
        self.write("case.toml", CASE.replace("power_w = 1000", "power_w = -1"))
        done = meltray("run", "case.toml", cwd=self.folder)
        self.assertRegex(done.stderr, re.compile(r"^meltray: case\.toml:27: laser\.power_w: found -1; allowed .+ \[W\]\n$"))

    def test_no_such_case(self):
        for command in ("check", "run"):
            done = meltray(command, "gone.toml", cwd=self.folder)
            self.assertEqual(done.returncode, 2)
            self.assertIn("gone.toml: found no such file", done.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    main()
