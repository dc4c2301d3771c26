#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Exit codes and refusals of the command line, and that a run that ends badly leaves what is needed to go on.

usage: exit_codes_test.py PROGRAM [unittest options]
"""
import json
import os
import re
import signal
import subprocess
import time
import unittest

from meltray_runner import CASES, REPOSITORY, Scratch, history, main, meltray, run, snapshots, start, state, summary

WELD = CASES / "tiny_weld.toml"


def files(folder):
    return {f: f.read_bytes() for f in folder.rglob("*") if f.is_file()}


class Usage(Scratch):
    def test_overwrite_keeps_what_is_there_until_the_new_run_can_start(self):
        folder = run(WELD, self.folder / "run", "--until", "5e-6")
        before = files(folder)
        done = meltray("run", WELD, "--out", folder, "--overwrite", "--quiet", "--set",
                       "bodies=[{shape='ball', center_m=[9.0, 9.0, 9.0], radius_m=1e-6}]")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(files(folder), before)

    def test_warnings_of_check_are_those_of_a_run(self):
        """On stderr, in log.txt and in the summary; a capillary or pool at the ends of the workpiece as well."""
        low = ["--set", "laser.power_w=4000", "--set", "domain.max_m=[0.6e-3, 0.3e-3, 0.2e-3]", "--until", "3e-4"]
        weld = REPOSITORY / "validation" / "studies" / "weld.toml"
        checked = meltray("check", weld, *low[:4])
        self.assertIn("above the bodies", checked.stdout)
        folder = self.folder / "run"
        done = meltray("run", weld, "--out", folder, "--quiet", *low)
        self.assertEqual(done.returncode, 0, done.stderr)
        for text in (done.stderr, (folder / "log.txt").read_text(encoding="utf-8"), str(summary(folder)["warnings"])):
            self.assertIn("above the bodies", text)
            self.assertIn("of the bodies at t =", text)

    def test_unknown_words(self):
        for arguments, message in (((), "subcommand is required"), (("rum", WELD), "rum"), (("run",), "CASE"),
                                   (("run", WELD, "--frobnicate"), "--frobnicate"),
                                   (("run", WELD, "--threads", "0"), "--threads"),
                                   (("run", WELD, "--threads", "many"), "--threads"),
                                   (("run", WELD, "--until", "-1"), "--until"),
                                   (("run", WELD, "--threads", "1000000"), "--threads"),
                                   (("run", WELD, "--until", "nan"), "--until"),
                                   (("run", WELD, "--until", "inf"), "--until"),
                                   (("resume", "nowhere"), "nowhere: no such run folder"),
                                   (("validate", "--tier", "4"), "allowed 1, 2 or 3"),
                                   (("validate", "--tier", "1", "--commands"), "allowed welds of tier 3"),
                                   (("validate", "--tier", "1", "--all"), "allowed one of them"),
                                   (("validate",), "found no validation case"),
                                   (("run", WELD, "--overwrite"), "--overwrite: has no effect without --out"),
                                   (("run", WELD, "--out", ""), "--out: found ''; a name is needed"),
                                   (("run", WELD, "--out", "", "--overwrite"), "--out: found ''"),
                                   (("resume", "nowhere", "--out", ""), "--out: found ''"),
                                   (("validate", "--small", "--json", ""), "--json: found ''"),
                                   (("plot", "nowhere"), "nowhere"), (("list", "planets"), "planets")):
            with self.subTest(arguments):
                done = meltray(*arguments, cwd=self.folder)
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                self.assertIn(message, done.stderr)
                self.assertEqual(list(self.folder.iterdir()), [])

    def test_unknown_command_is_answered_with_the_nearest(self):
        done = meltray("rum", WELD)
        self.assertIn("found 'rum'", done.stderr)
        self.assertIn("nearest: run\n", done.stderr)
        self.assertIn("validate", done.stderr)
        done = meltray("study", "papr", "--small")
        self.assertEqual(done.returncode, 2)
        self.assertIn("meltray: found 'papr' in place of a command of study", done.stderr)
        self.assertIn("nearest: paper\n", done.stderr)

    def test_unknown_option_is_answered_with_the_nearest(self):
        """Whatever else is wrong because of it."""
        threads = "--thread: no such option of run; nearest: --threads"
        for arguments, message in (
                (("run", WELD, "--thread", "4"), threads), (("run", "--thread=4", WELD), threads),
                (("run", "--quite"), "--quite: no such option of run; nearest: --quiet"),
                (("study", "splitting", "drop", "--smal"),
                 "--smal: no such option of study splitting; nearest: --small"),
                (("--versoin",), "--versoin: no such option of meltray; nearest: --version")):
            with self.subTest(arguments):
                done = meltray(*arguments, cwd=self.folder)
                self.assertEqual((done.returncode, done.stdout), (2, ""))
                self.assertEqual(done.stderr, f"meltray: {message}\n")
                self.assertEqual(list(self.folder.iterdir()), [])

    def test_help_wins_over_unknown_options(self):
        done = meltray("run", "--thread", "4", "--help")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("--threads", done.stdout)

    def test_help_and_version(self):
        for option in ("--help", "--version"):
            done = meltray(option)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("eltray", done.stdout)

    def test_resume_with_set_needs_a_folder(self):
        folder = run(WELD, self.folder / "run", "--until", "1e-5")
        done = meltray("resume", folder, "--set", "laser.power_w=1")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--out DIR", done.stderr)
        for setting in ("domain.spacing_m=1e-4", "bodies.0.temperature_k=500", "heat.initial_temperature_k=500",
                        "faces.z_min.kind=free"):
            done = meltray("resume", folder, "--set", setting, "--out", self.folder / "fork")
            self.assertEqual(done.returncode, 2)
            self.assertIn("a fork keeps its particles", done.stderr)
            self.assertFalse((self.folder / "fork").exists())

    def test_resume_until_a_time_that_has_passed_does_nothing(self):
        folder = run(WELD, self.folder / "run", "--until", "1e-5")
        before = files(folder)
        done = meltray("resume", folder, "--until", "5e-6")
        self.assertEqual(done.returncode, 0)
        self.assertIn("nothing to do", done.stdout)
        self.assertEqual(files(folder), before)

    def test_new_start_is_never_silent(self):
        """Where only a new start gives the result of the uninterrupted run, --quiet says so as well."""
        folder = run(WELD, self.folder / "run", "--until", "1e-5")
        done = meltray("resume", folder, "--until", "1.5e-5", "--quiet")
        self.assertEqual(done.returncode, 0)
        self.assertIn("starting again from t = 0", done.stderr)

    def test_compare_tells_both_depths_and_goes_on_past_a_run_without_them(self):
        folder = run(WELD, self.folder / "run", "--until", "1e-5")
        measured = self.write("measured.csv", "material,f_hz,mean_depth_mm\nIron,100,2.1\n")
        done = meltray("compare", folder, folder, "--measured", measured)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len([line for line in done.stdout.splitlines() if line.startswith("run ")]), 3)

    def test_compare_writes_what_it_prints(self):
        sine = [item for key in ('laser.modulation="sine"', "laser.amplitude_w=300", "laser.frequency_hz=1e5",
                                 "output.interval_s=1e-6", "time.max_step_s=1e-6") for item in ("--set", key)]
        folder = run(WELD, self.folder / "run", "--until", "4e-5", *sine)
        measured = self.write("measured.csv", "material,f_hz,mean_depth_mm,amplitude_ratio_mm_per_kw,definition\n"
                              "Iron,1e5,2,0.5,First Harmonic\niron,100,2,0.5,\n")
        results = self.folder / "compared.json"
        done = meltray("compare", folder, "--measured", measured, "--json", results)
        self.assertEqual(done.returncode, 0, done.stderr)
        compared, = json.loads(results.read_text(encoding="utf-8"))["runs"]
        row, = compared["measured"]  # that of its frequency
        self.assertEqual(row["amplitude"], "harmonic")
        for depth, values in compared["depths"].items():
            self.assertEqual(values["periods"], 3)
            line, = [line for line in done.stdout.splitlines() if f" {depth} " in line and "period" in line]
            self.assertIn(f"{values['mean_mm']:.3f}", line)
            over = row["simulated_over_measured"][depth]
            self.assertAlmostEqual(over["mean"], values["mean_mm"] / 2)
            self.assertAlmostEqual(over["ratio"], values["harmonic_mm_per_kw"] / 0.5)
            self.assertIsNone(over["lag_difference_deg"])


class Folders(Scratch):
    def test_default_folders_are_numbered(self):
        for name in ("tiny_weld", "tiny_weld-002", "tiny_weld-003"):
            self.assertEqual(meltray("run", WELD, "--quiet", "--until", "5e-6", cwd=self.folder).returncode, 0)
            self.assertTrue((self.folder / "runs" / name / "summary.json").is_file())

    def test_foreign_folder(self):
        """Neither --out nor --overwrite touches a folder without our marker."""
        mine = self.folder / "mine"
        mine.mkdir()
        (mine / "history.csv").write_text("my own", encoding="utf-8")
        for options in ((), ("--overwrite",)):
            done = meltray("run", WELD, "--out", mine, *options)
            self.assertEqual(done.returncode, 2)
            self.assertIn("not empty and not a run folder of meltray", done.stderr)
            self.assertEqual(files(mine), {mine / "history.csv": b"my own"})

    def test_file_in_place_of_a_folder(self):
        file = self.write("file", "x")
        done = meltray("run", WELD, "--out", file, "--overwrite")
        self.assertEqual(done.returncode, 2)
        self.assertEqual(file.read_text(encoding="utf-8"), "x")

    def test_finished_run(self):
        folder = run(WELD, self.folder / "run", "--set", "time.end_s=1e-5")
        (folder / "notes.txt").write_text("my own", encoding="utf-8")
        before = files(folder)
        done = meltray("run", WELD, "--out", folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--overwrite", done.stderr)
        self.assertEqual(files(folder), before)
        run(WELD, folder, "--overwrite", "--set", "time.end_s=5e-6")
        self.assertEqual(summary(folder)["time_s"], 5e-6)
        self.assertEqual((folder / "notes.txt").read_text(encoding="utf-8"), "my own")
        self.assertEqual(len((folder / "history.csv").read_text(encoding="utf-8").splitlines()), 3)

    def test_unfinished_run_is_answered_with_the_resume_command(self):
        folder = self.folder / "run"
        process = start("run", WELD, "--out", folder, "--quiet")
        while not (folder / "summary.json").exists() and process.poll() is None:
            time.sleep(0.01)
        process.kill()
        process.wait()
        before = files(folder)
        done = meltray("run", WELD, "--out", folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn(f"meltray resume {folder}", done.stderr)
        self.assertEqual(files(folder), before)

    def test_lock(self):
        """A second process, of whatever command, is refused while the first one works; it goes on undisturbed."""
        folder = self.folder / "run"
        process = start("run", WELD, "--out", folder, "--quiet")
        try:
            while not (folder / "case.toml").exists() and process.poll() is None:
                time.sleep(0.01)
            os.kill(process.pid, signal.SIGSTOP)
            for arguments in (("resume", folder), ("run", WELD, "--out", folder, "--overwrite")):
                done = meltray(*arguments)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn("another meltray process works in this folder", done.stderr)
        finally:
            os.kill(process.pid, signal.SIGCONT)
        self.assertEqual(process.wait(), 0)
        self.assertEqual(summary(folder)["outcome"], "finished")


class InputOutput(Scratch):
    def test_full_device(self):
        """A long output, whose buffer overflows, and short ones, which are written at the very end."""
        for arguments in (("list", "keys"), ("list", "cases"), ("list", "kernels"), ("--version",),
                          ("run", "--help")):
            with self.subTest(arguments), open("/dev/full", "w", encoding="utf-8") as full:
                done = meltray(*arguments, stdout=full)
                self.assertEqual(done.returncode, 4, done.stderr)
                self.assertIn("meltray: standard output: ", done.stderr)

    def test_results_that_could_not_be_written(self):
        """Known before anything is computed."""
        missing = self.folder / "nowhere" / "results.json"
        for arguments in (("validate", "fresnel_angles", "--small"),
                          ("study", "splitting", "heat_melting", "--small", "--out", self.folder / "out")):
            for file in (missing, self.folder, self.write("file", "") / "results.json"):
                with self.subTest((*arguments, file)):
                    done = meltray(*arguments, "--json", file)
                    self.assertEqual((done.returncode, done.stdout), (4, ""), done.stderr)
                    self.assertIn(f"{file}: cannot write", done.stderr)
        self.assertEqual(list((self.folder / "out").rglob("*.json")), [])

    def test_folder_that_cannot_be_made(self):
        done = meltray("run", WELD, "--out", "/proc/nowhere/run")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("/proc/nowhere", done.stderr)

    def test_folder_without_permission(self):
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        folder = self.folder / "closed"
        folder.mkdir(mode=0o500)
        done = meltray("run", WELD, "--out", folder)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn(str(folder), done.stderr)

    def mount(self, size):
        disk = self.folder / "disk"
        disk.mkdir()
        command = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(disk)]
        if os.geteuid() != 0 or subprocess.run(command, check=False, stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("needs the right to mount a small tmpfs")
        self.addCleanup(subprocess.run, ["umount", str(disk)], check=True)
        return disk

    def test_read_only_disk(self):
        disk = self.mount("1m")
        subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True)
        done = meltray("run", WELD, "--out", disk / "run")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn(f"{disk}/run", done.stderr)

    def test_full_disk(self):
        """Exit code 4; the last checkpoint is whole, and with more space the run goes on to the same end."""
        disk = self.mount("8m")
        reference = run(WELD, self.folder / "reference")
        filler = disk / "filler"
        # one checkpoint and a half, besides the small files: the second or third checkpoint does not fit
        room = 1.5 * (reference / "checkpoint-a.h5").stat().st_size + 200e3
        filler.write_bytes(bytes(int(8 * 2**20 - room)))
        folder = disk / "run"
        done = meltray("run", WELD, "--out", folder, "--quiet")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("No space left on device", done.stderr)
        result = summary(folder)
        self.assertEqual((result["outcome"], result["exit_code"]), ("io_error", 4))
        self.assertIn("No space left on device", result["message"])
        self.assertGreater(result["checkpoint_time_s"], 0)
        self.assertLess(result["time_s"], 2e-4)
        filler.unlink()
        done = meltray("resume", folder, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_same_results(reference, folder, "after a full disk")


class NumericalFailures(Scratch):
    def test_step_below_the_smallest(self):
        folder = self.folder / "run"
        done = meltray("run", WELD, "--out", folder, "--quiet", "--set", "time.min_step_s=2e-6", "--set",
                       "time.initial_step_s=3e-6")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertRegex(done.stderr, r"time step of \S+ s at t = \S+ s is below the smallest allowed \(2e-06 s\)")
        self.assertIn(f"meltray resume {folder}", done.stderr)
        result = summary(folder)
        self.assertEqual((result["outcome"], result["exit_code"]), ("failed", 3))
        self.assertIn("below the smallest allowed", result["message"])
        self.assertEqual(result["checkpoint_time_s"], result["time_s"])

        fork = self.folder / "fork"
        done = meltray("resume", folder, "--quiet", "--out", fork, "--set", "time.min_step_s=1e-14")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((summary(fork)["outcome"], summary(fork)["time_s"]), ("finished", 2e-4))
        self.assertLess(summary(fork)["budgets"]["energy"]["relative_error"], 1e-10)

    def test_runaway_particle(self):
        """An explicit interface viscosity far beyond its stability limit throws a particle out of the pool."""
        folder = self.folder / "run"
        done = meltray("run", WELD, "--out", folder, "--quiet", "--set", "time.fixed_step_s=5e-6", "--set",
                       "time.method=explicit", "--set", "flow.interface_viscosity_free=100")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertRegex(done.stderr, r"particle \d+ is not finite or runs away at t = \S+ s")
        for part in ("position (", "neighbours", "explicit viscosity", f"meltray resume {folder}"):
            self.assertIn(part, done.stderr)
        result = summary(folder)
        self.assertEqual((result["outcome"], result["exit_code"]), ("failed", 3))
        self.assertIn("runs away", result["message"])
        self.assertTrue(state(folder), "a checkpoint of the last good state")
        self.assertGreaterEqual(len(snapshots(folder)), 2)

        fork = self.folder / "fork"
        done = meltray("resume", folder, "--quiet", "--out", fork, "--set", "time.fixed_step_s=0", "--set",
                       "time.method=imex", "--set", "flow.interface_viscosity_free=1", "--until", "6e-5")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLess(summary(fork)["budgets"]["energy"]["relative_error"], 1e-10)

    def test_colder_than_zero(self):
        """Heat drawn out of a block faster than it has any, as by a wrong sign, ends the run."""
        folder = self.folder / "run"
        done = meltray("run", REPOSITORY / "cases" / "melting_block.toml", "--out", folder, "--quiet", "--set",
                       "faces.x_max.thermal=flux", "--set", "faces.x_max.flux_w_m2=-1e9")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertRegex(done.stderr, r"particle \d+ is colder than 0 K at t = \S+ s")
        self.assertEqual(summary(folder)["outcome"], "failed")

    def test_fork_to_another_method(self):
        """Partitions of the method of before do not bind one that has none."""
        folder = self.folder / "run"
        done = meltray("run", WELD, "--out", folder, "--quiet", "--set", "model=wcsph_reduced", "--until", "2e-5")
        self.assertEqual(done.returncode, 0, done.stderr)
        multirate = self.folder / "multirate"
        done = meltray("resume", folder, "--quiet", "--out", multirate, "--until", "3e-5", "--set",
                       "time.method=multirate", "--set", "time.order=3", "--set", "time.fixed_step_s=1e-6")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(summary(multirate)["limiter"]["fixed"], 10)
        back = self.folder / "back"
        done = meltray("resume", multirate, "--quiet", "--out", back, "--until", "3.2e-5", "--set",
                       "time.method=imex", "--set", "time.order=2", "--set", "time.fixed_step_s=0")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(summary(back)["limiter"]["acoustic"], summary(folder)["limiter"]["acoustic"])

    def test_unstable_conduction(self):
        """Explicit conduction far beyond its stability limit ends at the first particle whose enthalpy runs away, here
        below that of 0 K. Only forces are named: that conduction did it shows in the numbers of a particle that does not
        move."""
        folder = self.folder / "run"
        done = meltray("run", REPOSITORY / "cases" / "melting_block.toml", "--out", folder, "--quiet", "--set",
                       "time.fixed_step_s=1e-4", "--set", "splitting.conduction=explicit")
        self.assertEqual(done.returncode, 3, done.stderr)
        found = re.search(r"particle \d+ is colder than 0 K at t = \S+ s .* velocity \(0, 0, 0\) m/s, "
                          r"enthalpy (\S+) J/kg", done.stderr)
        self.assertTrue(found, done.stderr)
        self.assertLess(float(found[1]), 0)
        # The state that is kept is the one before: hot, and not yet beyond a particle that runs away.
        self.assertLess(history(folder)["max_temperature_k"].max(), 1e5)
        self.assertTrue(state(folder), "a checkpoint of the last good state")


if __name__ == "__main__":
    main()
