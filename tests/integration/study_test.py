#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Studies from outside: one small study of each kind, what it finds, and that a study goes on where it stopped.

usage: study_test.py PROGRAM [unittest options]
"""
import csv
import json

from meltray_runner import REPOSITORY, Scratch, main, meltray


class Studies(Scratch):
    def study(self, kind, scene, *options):
        """Runs a small study; its JSON, and its words."""
        out = self.folder / "out"
        done = meltray("study", kind, scene, "--small", "--threads", "1", "--out", out, *options)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        data = next(out.glob(f"{kind}*.json"))
        self.assertTrue(data.with_suffix(".png").is_file())
        with open(data.with_suffix(".csv"), newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        found = json.loads(data.read_text(encoding="utf-8"))
        self.assertEqual([list(row) for row in table], [list(row) for row in found["rows"]])
        return found, done.stdout

    def test_work_precision(self):
        found, words = self.study("work-precision", "heat_melting", "--json", self.folder / "copy.json")
        self.assertEqual(json.loads((self.folder / "copy.json").read_text(encoding="utf-8")), found)
        methods = {row["method"] for row in found["rows"]}
        self.assertLessEqual({"euler", "imex 2", "imex 4", "explicit 2", "implicit 2", "multirate 3"}, methods)
        field = [r for r in found["rows"] if r["quantity"] == "temperature [K]"]

        def errors(method):
            return [r["error"] for r in field if r["method"] == method and r["step_s"] > 0]

        # Halved steps: a first-order method halves its error; the second-order pair is better at every step.
        first = errors("euler")
        for coarse, fine in zip(first, first[1:]):
            self.assertAlmostEqual(coarse / fine, 2, delta=0.2)
        for low, high in zip(first, errors("imex 2")):
            self.assertLess(high, low / 10)
        # Steps of 200 us are beyond the limit of explicit conduction: the run ends below 0 K.
        self.assertIsNone(errors("explicit 2")[0])
        for reference in found["references"]:
            self.assertLess(reference["uncertainty"], 1e-5)
        self.assertIn("wins in both", words)
        # The same again computes nothing.
        again, words = self.study("work-precision", "heat_melting")
        self.assertEqual(again["rows"], found["rows"])
        runs, kept = (int(words.split(text)[0].split()[-1]) for text in (" runs,", " of them kept"))
        self.assertEqual(runs, kept)

    def test_splitting(self):
        found, words = self.study("splitting", "heat_melting")
        rows = {r["assignment"]: r for r in found["rows"]}
        explicit, implicit = rows["all explicit"], rows["implicit conduction"]
        # Explicit conduction has a limit within the steps that are tried, implicit conduction has none.
        self.assertFalse(explicit["larger_not_tried"])
        self.assertTrue(implicit["larger_not_tried"])
        self.assertGreater(implicit["largest_stable_step_s"], explicit["largest_stable_step_s"])
        for row in (explicit, implicit):
            self.assertGreater(row["order"], 1.5)
        self.assertIn("recommended for an error of", words)
        self.assertRegex(words, "auto chooses .*: (agrees|differs)")

    def test_case_of_ones_own(self):
        """The studies in steps take a case file as well: its steps begin at twice the mean of the case as it is."""
        case = self.write("own.toml", (REPOSITORY / "validation/studies/heat_melting.toml").read_text(encoding="utf-8"))
        found, words = self.study("splitting", case)
        self.assertEqual(found["scene"], "own")
        rows = {r["assignment"]: r for r in found["rows"]}
        self.assertGreater(rows["implicit conduction"]["order"], 1.5)
        self.assertGreater(rows["implicit conduction"]["largest_stable_step_s"], 0)
        self.assertIn("recommended for an error of", words)

    def test_weakly_compressible_case_of_ones_own(self):
        """Vortices with WCSPH: no projection and no Euler; methods of second order show it, one of fourth is ahead."""
        case = self.write("own.toml", f'include = "{REPOSITORY}/validation/studies/taylor_green.toml"\n'
                          "[domain]\nspacing_m = 0.05\n"
                          '[flow]\nsolver = "wcsph"\nsound_speed_m_s = 10.0\n')
        found, _ = self.study("work-precision", case)
        errors = {}
        for row in found["rows"]:
            if row["quantity"] == "velocity [m/s]" and row["step_s"] > 0:
                errors.setdefault(row["method"], []).append(row["error"])
        self.assertEqual(set(errors), {"imex 2", "explicit 2", "imex 4"})
        for coarse, fine in zip(errors["explicit 2"], errors["explicit 2"][1:]):
            self.assertAlmostEqual(coarse / fine, 4, delta=0.5)
        self.assertLess(errors["imex 4"][0], 0.02 * errors["explicit 2"][0])

    def test_stability(self):
        """The weld holds with its own steps and breaks down with steps eight times as long; the number of a seed does not
        make it expect more speed."""
        found, words = self.study("stability", "weld", "--parameter", "seed")
        usual, long = ([r for r in found["rows"] if r["step_factor"] == factor] for factor in (1, 8))
        self.assertEqual([r["verdict"] for r in usual], ["stable", "stable"], usual)
        broken = [r for r in found["rows"] if r["verdict"] != "stable"]
        self.assertTrue(broken, long)
        for row in broken:
            self.assertIn(row["verdict"], ("degraded", "failed"))
            self.assertIn(f"{row['verdict']}: {row['reason']}", words)
        as_it_is = usual[0]["top_speed_m_s"]  # the case has seed 1
        for row in long:
            self.assertFalse(row["verdict"] == "stable" and row["top_speed_m_s"] > 3 * as_it_is, row)

    def test_a_case_of_ones_own(self):
        case = REPOSITORY / "validation" / "studies" / "drop.toml"
        found, words = self.study("stability", case, "--parameter", "seed")
        self.assertEqual(found["scene"], "drop")
        self.assertEqual({r["parameter"] for r in found["rows"]}, {"seed"})

    def test_refusals(self):
        for arguments, message in ((("study",), "subcommand"), (("study", "splitting"), "ID"),
                                   (("study", "splitting", "dorp"), "did you mean 'drop'"),
                                   (("study", "work-precision", "static_pool"), "study stability"),
                                   (("study", "stability", "drop", "--parameter", "power"), "surface_tension")):
            with self.subTest(arguments):
                done = meltray(*arguments, cwd=self.folder)
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                self.assertIn(message, done.stderr)


if __name__ == "__main__":
    main()
