# SPDX-License-Identifier: MIT
"""What the tests of the command line share: start the program, read its results, compare run folders bit for bit."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
CASES = pathlib.Path(__file__).resolve().parent / "cases"
PROGRAM = None  # set by main()
# Threads that wait sleep: the tests share the machine, and a spinning thread would take the core of the one it waits for.
ENVIRONMENT = {**os.environ, "OMP_WAIT_POLICY": "passive"}

# What may differ between two runs of the same case: how long they took, in how many sessions, on how many threads.
SESSION_KEYS = {"wall_seconds", "session_wall_seconds", "session_start_s", "resumed", "forked_from", "peak_memory_bytes",
                "wall_seconds_per_simulated_ms", "time_by_part", "memory_by_part_bytes", "threads", "warnings"}
SESSION_STATE = {"run/wall_seconds", "run/resumed"}


def main():
    """Runs the tests of the calling script: SCRIPT PROGRAM [unittest options]."""
    global PROGRAM
    if len(sys.argv) < 2:
        sys.exit(f"usage: {sys.argv[0]} PROGRAM [unittest options]")
    PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)


def meltray(*arguments, cwd=None, timeout=300, stdout=subprocess.PIPE):
    """The finished process; its output is text, unless `stdout` says where it goes."""
    return subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, timeout=timeout, check=False, text=True,
                          env=ENVIRONMENT, stdout=stdout, stderr=subprocess.PIPE)


def start(*arguments, cwd=None):
    """The program in the background; its output is dropped."""
    return subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=cwd, env=ENVIRONMENT,
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def run(case, out, *options):
    """Runs a case to its end, fails the test otherwise."""
    done = meltray("run", case, "--out", out, "--quiet", *options)
    if done.returncode != 0:
        raise AssertionError(f"meltray run {case}: exit {done.returncode}\n{done.stderr}")
    return out


def summary(folder):
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def history(folder):
    """Columns of history.csv by name; words become nan."""
    table = numpy.genfromtxt(folder / "history.csv", delimiter=",", names=True, dtype=float)
    return {name: numpy.atleast_1d(table[name]) for name in table.dtype.names}


def snapshots(folder):
    return sorted((folder / "particles").glob("*.h5"))


def particles(file):
    """Fields of a snapshot by name."""
    with h5py.File(file) as f:
        return {name: f[name][...] for name in f}


def state(folder):
    """Fields of the newest checkpoint by name."""
    newest, newest_time = {}, -1.0
    for file in folder.glob("checkpoint-?.h5"):
        with h5py.File(file) as f:
            if f["header/time_s"][()] <= newest_time:
                continue
            newest_time, newest = f["header/time_s"][()], {}
            f["state"].visititems(lambda name, item: newest.update({name: item[()]})
                                  if isinstance(item, h5py.Dataset) else None)
    return newest


def differing_fields(a, b):
    """Names in which two dictionaries of arrays differ in any bit, with the largest difference."""
    names = []
    for name in sorted(a.keys() | b.keys()):
        if name not in a or name not in b:
            names.append(f"{name} (in one only)")
            continue
        x, y = numpy.asarray(a[name]), numpy.asarray(b[name])
        if x.shape != y.shape:
            names.append(f"{name} (shape {x.shape}, {y.shape})")
        elif x.tobytes() != y.tobytes():
            numbers = x.dtype.kind in "fiu"
            names.append(f"{name} ({numpy.max(numpy.abs(x.astype(float) - y.astype(float))):.3g})" if numbers else name)
    return names


def differences(one, other):
    """How the results of two run folders differ; empty when they agree bit for bit."""
    found = []
    for name in ("history.csv", "seam.csv"):
        a, b = ((folder / name).read_text(encoding="utf-8").splitlines() for folder in (one, other))
        if a != b:
            line = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
            found.append(f"{name}: {len(a)} and {len(b)} lines, first difference in line {line + 1}")
    a, b = snapshots(one), snapshots(other)
    if [x.name for x in a] != [x.name for x in b]:
        found.append(f"snapshots: {len(a)} and {len(b)}")
    for x, y in zip(a, b):
        fields = differing_fields(particles(x), particles(y))
        if fields:
            found.append(f"{x.name}: {', '.join(fields)}")
            break
    a, b = summary(one), summary(other)
    found += [f"summary.json: {key}: {a.get(key)} and {b.get(key)}" for key in sorted(a.keys() | b.keys())
              if key not in SESSION_KEYS and a.get(key) != b.get(key)]
    fields = [f for f in differing_fields(state(one), state(other)) if f.split(" ")[0] not in SESSION_STATE]
    if fields:
        found.append(f"checkpoint: {', '.join(fields)}")
    return found


class Scratch(unittest.TestCase):
    """Tests with a folder of their own, and one for what they share; both are removed in the end."""

    @classmethod
    def setUpClass(cls):
        cls.shared = pathlib.Path(tempfile.mkdtemp(prefix="meltray-test-"))
        cls.addClassCleanup(shutil.rmtree, cls.shared, ignore_errors=True)

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="test-", dir=self.shared))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def assert_same_results(self, one, other, what=""):
        found = differences(one, other)
        self.assertFalse(found, f"{what}\n  " + "\n  ".join(found))
