#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A run that was killed, stopped or run on other threads gives the bits of the undisturbed run.

usage: restart_test.py PROGRAM [unittest options]; MELTRAY_KILLS=20 in the environment for the long variant.
"""
import os
import random
import signal
import time
import unittest

from meltray_runner import CASES, Scratch, history, main, meltray, run, snapshots, start, summary

WELD, DAM_BREAK = CASES / "tiny_weld.toml", CASES / "dam_break.toml"
KILLS = int(os.environ.get("MELTRAY_KILLS", "5"))
SEED = int(os.environ.get("MELTRAY_SEED", "1"))


def wait_for_summary(folder, process):
    """Until the first summary is there: only from then on a run that dies has all that belongs to it, its name included."""
    while not (folder / "summary.json").exists() and process.poll() is None:
        time.sleep(0.001)


def half_written(folder):
    """Names of the files that are being written, or were when the process died."""
    return [name for f in (folder, folder / "particles") if f.is_dir() for name in os.listdir(f) if name.endswith(".part")]


def stop_in_write(folder, process, seconds):
    """Waits `seconds`, then until the process stands still in the middle of a write; False when it has ended before. A file
    that was seen may be complete a moment later: what counts is what is there once nothing moves any more."""
    time.sleep(seconds)
    while process.poll() is None:
        if not half_written(folder):
            continue
        process.send_signal(signal.SIGSTOP)
        state = os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)
        if state.si_code == os.CLD_STOPPED and half_written(folder):
            return True
        process.send_signal(signal.SIGCONT)
    return False


class Restart(Scratch):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        began = time.monotonic()
        cls.reference = run(WELD, cls.shared / "reference", "--threads", "1")
        cls.seconds = time.monotonic() - began

    def finish(self, folder, *options):
        done = meltray("resume", folder, "--quiet", *options)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_reference_does_what_it_is_for(self):
        """The scene melts, boils, traces the beam and rejects steps."""
        result = summary(self.reference)
        self.assertEqual(result["outcome"], "finished")
        self.assertGreater(result["particles"]["liquid"], 20)
        self.assertGreater(result["rejected_steps"], 0)
        self.assertGreater(result["budgets"]["laser"]["traces"], 40)
        self.assertGreater(result["budgets"]["energy"]["evaporation_j"], 0)
        self.assertEqual(len(snapshots(self.reference)), 6)

    def test_two_threads(self):
        two = run(WELD, self.folder / "two", "--threads", "2")
        self.assert_same_results(self.reference, two, "1 and 2 threads")

    def test_projection_in_every_stage(self):
        """The other projection: stopped between checkpoints and resumed on two threads."""
        option = ("--set", "splitting.projection=stage")
        one = run(WELD, self.folder / "one", "--threads", "1", *option)
        two = run(WELD, self.folder / "two", "--threads", "2", "--until", "1.27e-4", *option)
        self.finish(two, "--threads", "2")
        self.assert_same_results(one, two, "projection in every stage")

    def test_elastic_solid(self):
        """Stress and the zone that moves are part of the state."""
        option = [o for s in ("model=wcsph", "flow.elastic_modulus_scale=1e-4", "time.end_s=6e-5",
                              "output.checkpoint_interval_s=2e-5") for o in ("--set", s)]
        one = run(WELD, self.folder / "one", "--threads", "1", *option)
        two = run(WELD, self.folder / "two", "--threads", "2", "--until", "3.1e-5", *option)
        self.finish(two, "--threads", "2")
        self.assert_same_results(one, two, "elastic solid")

    def test_vapour_at_the_face(self):
        """Faces are found anew from the state and the light, with both solvers."""
        for model in (("model=isph",), ("model=wcsph_reduced", "time.method=multirate", "time.fixed_step_s=1e-6")):
            option = [o for s in (*model, "surface.temperature=face", "time.end_s=8e-5",
                                  "output.checkpoint_interval_s=2e-5") for o in ("--set", s)]
            one = run(WELD, self.folder / f"{model[0]} one", "--threads", "1", *option)
            two = run(WELD, self.folder / f"{model[0]} two", "--threads", "2", "--until", "4.1e-5", *option)
            self.finish(two, "--threads", "2")
            self.assert_same_results(one, two, model[0])

    def test_fast_sound(self):
        """Octets and the lists of a slow step that outlast it are made anew at a checkpoint in both runs."""
        option = [o for s in ("model=wcsph_reduced", "time.method=multirate", "time.fixed_step_s=1e-6",
                              "time.end_s=6e-5", "output.checkpoint_interval_s=2e-5") for o in ("--set", s)]
        one = run(WELD, self.folder / "one", "--threads", "1", *option)
        two = run(WELD, self.folder / "two", "--threads", "2", "--until", "3.1e-5", *option)
        self.finish(two, "--threads", "2")
        self.assert_same_results(one, two, "multirate")

    def test_without_list_of_pairs(self):
        one = run(DAM_BREAK, self.folder / "one", "--threads", "1")
        two = run(DAM_BREAK, self.folder / "two", "--threads", "2", "--until", "0.6")
        self.finish(two, "--threads", "2")
        self.assert_same_results(one, two, "dam break")
        rows, density = history(two)["density_variation"], summary(two)["density_variation"]
        self.assertAlmostEqual(density["mean"], rows.mean(), delta=1e-6 * rows.mean())
        self.assertLess(density["mean"], density["largest"])

    def test_kill(self):
        """kill -9 again and again, every second time in the middle of a write; threads change on the way."""
        chance = random.Random(SEED)
        kills = writes = chains = 0
        while kills < KILLS:
            chains += 1
            folder = self.folder / f"killed-{chains}"
            process = start("run", WELD, "--out", folder, "--quiet", "--threads", "1")
            wait_for_summary(folder, process)
            while kills < KILLS:
                wait = chance.uniform(0.02, 0.6) * self.seconds
                if kills % 2:
                    writing = stop_in_write(folder, process, wait)
                else:
                    time.sleep(wait)
                    writing = False
                alive = process.poll() is None
                process.kill()
                process.wait()
                if not alive:
                    self.assertEqual(process.returncode, 0)
                    break
                kills, writes = kills + 1, writes + writing
                process = start("resume", folder, "--quiet", "--threads", str(chance.choice([1, 2])))
            self.assertEqual(process.wait(), 0)
            self.assert_same_results(self.reference, folder, f"chain {chains}, seed {SEED}")
            self.assertFalse(half_written(folder), "half-written files are left over")
        print(f"{kills} kills in {chains} runs, {writes} of them while a file was written", flush=True)
        self.assertEqual(writes, KILLS // 2)

    def test_signals(self):
        for number, code, outcome in ((signal.SIGTERM, 143, "terminated"), (signal.SIGINT, 130, "interrupted")):
            with self.subTest(outcome):
                folder = self.folder / outcome
                process = start("run", WELD, "--out", folder, "--quiet", "--threads", "1")
                time.sleep(0.5 * self.seconds)
                process.send_signal(number)
                self.assertEqual(process.wait(), code)
                result = summary(folder)
                self.assertEqual((result["outcome"], result["exit_code"]), (outcome, code))
                self.assertLess(result["time_s"], 2e-4)
                self.assertEqual(result["checkpoint_time_s"], result["time_s"])
                self.finish(folder)
                self.assert_same_results(self.reference, folder, outcome)

    def test_signal_before_the_first_scheduled_checkpoint(self):
        folder = self.folder / "early"
        process = start("run", WELD, "--out", folder, "--quiet", "--threads", "1")
        wait_for_summary(folder, process)
        process.terminate()
        self.assertEqual(process.wait(), 143)
        self.assertLess(summary(folder)["time_s"], 2e-5)
        self.finish(folder)
        self.assert_same_results(self.reference, folder, "early signal")

    def test_stop_at_a_time_between_two_checkpoints(self):
        folder = run(WELD, self.folder / "until", "--until", "1.27e-4")
        self.assertEqual(summary(folder)["outcome"], "stopped")
        self.assertEqual(summary(folder)["time_s"], 1.27e-4)
        self.finish(folder)
        self.assert_same_results(self.reference, folder, "--until")

    def test_finished_run_has_nothing_to_do(self):
        before = (self.reference / "summary.json").read_bytes()
        done = meltray("resume", self.reference)
        self.assertEqual(done.returncode, 0)
        self.assertIn("nothing to do", done.stdout)
        self.assertEqual((self.reference / "summary.json").read_bytes(), before)

    def test_checkpoints_deleted(self):
        """A run that has been done and cannot go on is refused, not begun anew over what it has."""
        folder = run(WELD, self.folder / "done", "--until", "1.27e-4")
        for path in folder.glob("checkpoint-*.h5"):
            path.unlink()
        before = (folder / "history.csv").read_bytes()
        done = meltray("resume", folder, "--quiet", "--until", "1e-2")
        self.assertEqual(done.returncode, 2)
        self.assertIn("its checkpoints are gone", done.stderr)
        self.assertIn(f"--out {folder} --overwrite", done.stderr)
        self.assertEqual((folder / "history.csv").read_bytes(), before)

    def test_fork(self):
        """A fork goes on in a folder of its own with another setting and leaves the first run alone."""
        before = {f: f.read_bytes() for f in self.reference.rglob("*") if f.is_file()}
        fork = self.folder / "fork"
        done = meltray("resume", self.reference, "--until", "2.2e-4", "--set", "laser.power_w=500", "--out", fork)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual({f: f.read_bytes() for f in self.reference.rglob("*") if f.is_file()}, before)
        self.assertIn("reference", summary(fork)["forked_from"])
        self.assertEqual(summary(fork)["time_s"], 2.2e-4)
        laser = [summary(f)["budgets"]["laser"]["in_j"] for f in (self.reference, fork)]
        self.assertAlmostEqual(laser[1] - laser[0], 500 * 2e-5, delta=1e-9)


if __name__ == "__main__":
    main()
