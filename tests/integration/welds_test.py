#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Tier 3 of the validation from outside: the list of welds, what is taken off it, and what finished ones are worth.

usage: welds_test.py PROGRAM [unittest options]
"""
import json
import pathlib
import shlex

from meltray_runner import Scratch, main, meltray


class Welds(Scratch):
    def validate(self, *options):
        return meltray("validate", "keyhole_depth_xray", "--out", self.folder / "runs", *options)

    def finished(self, name, depth_m):
        """A run folder as a weld leaves it, with one depth from beginning to end."""
        folder = self.folder / "runs" / "keyhole_depth_xray" / name
        folder.mkdir(parents=True)
        (folder / "case.toml").write_text("[domain]\nspacing_m = 7e-06\n", encoding="utf-8")
        (folder / "summary.json").write_text(json.dumps({"time_s": 1e-3, "wall_seconds": 1.0}), encoding="utf-8")
        (folder / "history.csv").write_text(f"time_s,capillary_depth_m\n0,{depth_m}\n1e-3,{depth_m}\n", encoding="utf-8")

    def commands(self):
        done = self.validate("--commands")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = done.stdout.splitlines()
        for line in lines:
            self.assertTrue(line.startswith("meltray run "))
        return lines

    def test_finished_welds_leave_the_list(self):
        every = self.commands()
        self.assertEqual(len(every), len(set(every)))
        self.finished("ss316-0.6m-s-208w", 100e-6)
        left = self.commands()
        self.assertEqual(len(left), len(every) - 1)
        self.assertEqual([line for line in every if "ss316-0.6m-s-208w" in line], list(set(every) - set(left)))

    def test_depths_and_slopes_are_judged(self):
        self.finished("ss316-0.6m-s-208w", 100e-6)  # measured: 93.6 um
        done = self.validate("--finished")
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("1 rows judged: 1 passed, 0 failed", done.stdout)
        self.assertIn("dx 7 um", done.stdout)  # the run's own, not that of the list
        self.finished("ss316-0.6m-s-520w", 190e-6)  # measured: 380 um; slope 0.29 of 0.92 mm/kW
        done = self.validate("--finished")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("4 rows judged: 2 passed, 2 failed", done.stdout)

    def test_nothing_finished_is_no_success(self):
        results = self.folder / "results.json"
        done = self.validate("--finished", "--json", results)
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertIn(f"no finished run in {self.folder / 'runs' / 'keyhole_depth_xray'}\n", done.stderr)
        self.assertFalse(results.exists())
        self.finished("ss316-0.6m-s-208w", 100e-6)
        done = self.validate("--finished", "--json", results)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(json.loads(results.read_text(encoding="utf-8"))["rows"]), 1)

    def test_commands_can_be_pasted(self):
        done = meltray("validate", "keyhole_depth_xray", "--out", self.folder / "my runs", "--commands")
        for line in done.stdout.splitlines():
            words = shlex.split(line)
            self.assertEqual(words[:2], ["meltray", "run"])
            out = words[words.index("--out") + 1]
            self.assertEqual(pathlib.Path(out).parent, self.folder / "my runs" / "keyhole_depth_xray")

    def test_only_welds_have_commands(self):
        done = meltray("validate", "fresnel_angles", "--commands")
        self.assertEqual(done.returncode, 2)
        self.assertIn("fresnel_angles", done.stderr)


if __name__ == "__main__":
    main()
