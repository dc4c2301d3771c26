#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Damaged files of a run folder: exit code 2 with a message that names file and damage, and nothing else is touched.

usage: damaged_files_test.py PROGRAM [unittest options]
"""
import io
import shutil

import h5py
from meltray_runner import CASES, Scratch, main, meltray, run, snapshots, summary

WELD = CASES / "tiny_weld.toml"
BLOCK = 512  # bytes of text before the HDF5 part of a checkpoint


def fnv1a(data):
    value = 0xcbf29ce484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001b3 & 0xffffffffffffffff
    return value


def flipped(data, place):
    return data[:place] + bytes([data[place] ^ 0x10]) + data[place + 1:]


def without_field(data, name):
    """A checkpoint that lacks a field, but has a valid checksum."""
    file = io.BytesIO(data[BLOCK:])
    with h5py.File(file, "r+") as f:
        del f[name]
    image = file.getvalue()
    text = f"meltray checkpoint\nschema 3\nbytes {len(image)}\nfnv1a64 {fnv1a(image):016x}\n".encode()
    return text.ljust(BLOCK, b"\0") + image


class DamagedFiles(Scratch):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.stopped = run(WELD, cls.shared / "stopped", "--until", "6e-5")
        cls.whole = run(WELD, cls.shared / "whole", "--set", "time.end_s=8e-5")
        cls.other = run(WELD, cls.shared / "other", "--until", "2e-5")

    def copy(self, name):
        folder = self.folder / name
        shutil.copytree(self.stopped, folder)
        return folder

    def refused(self, folder, *message):
        before = {f: f.read_bytes() for f in folder.rglob("*") if f.is_file()}
        done = meltray("resume", folder, "--quiet")
        self.assertEqual(done.returncode, 2, done.stderr)
        for part in message:
            self.assertIn(part, done.stderr)
        self.assertEqual({f: f.read_bytes() for f in folder.rglob("*") if f.is_file()}, before, "something was changed")

    def test_both_checkpoints(self):
        other = (self.other / "checkpoint-a.h5").read_bytes()
        snapshot = snapshots(self.other)[0].read_bytes()
        damages = {
            "truncated": (lambda b: b[:len(b) // 2], "truncated checkpoint"),
            "truncated at the start": (lambda b: b[:200], "truncated checkpoint: 200 bytes"),
            "flipped byte in the state": (lambda b: flipped(b, len(b) // 2), "damaged checkpoint", "checksum"),
            "flipped byte at the end": (lambda b: flipped(b, len(b) - 1), "damaged checkpoint", "checksum"),
            "flipped byte in the checksum": (lambda b: flipped(b, b.index(b"fnv1a64 ") + 9), "damaged checkpoint"),
            "not HDF5": (lambda b: b"time_s,power_w\n" * 100, "not a Meltray checkpoint"),
            "another HDF5 file": (lambda b: snapshot, "not a Meltray checkpoint", "HDF5 file of another kind"),
            "another schema": (lambda b: b.replace(b"schema 3\n", b"schema 9\n", 1), "checkpoint schema 9",
                               "reads schema 3"),
            "empty": (lambda b: b"", "not a Meltray checkpoint", "empty"),
            "zeros": (lambda b: bytes(len(b)), "not a Meltray checkpoint"),
            "of another run": (lambda b: other, "checkpoint of another run"),
        }
        for name, (damage, *message) in damages.items():
            with self.subTest(name):
                folder = self.copy(name.replace(" ", "-"))
                for slot in ("checkpoint-a.h5", "checkpoint-b.h5"):
                    (folder / slot).write_bytes(damage((folder / slot).read_bytes()))
                self.refused(folder, "checkpoint-a.h5", "checkpoint-b.h5", *message)

    def test_field_missing_behind_a_valid_checksum(self):
        folder = self.copy("field")
        for slot in ("checkpoint-a.h5", "checkpoint-b.h5"):
            (folder / slot).write_bytes(without_field((folder / slot).read_bytes(), "state/run/case_fingerprint"))
        self.refused(folder, "checkpoint-", "run/case_fingerprint")

    def test_one_checkpoint(self):
        """The other one is used, with a warning; the result is that of the undisturbed run."""
        for slot in ("checkpoint-a.h5", "checkpoint-b.h5"):
            with self.subTest(slot):
                folder = self.copy(slot)
                (folder / slot).write_bytes((folder / slot).read_bytes()[:1000])
                done = meltray("resume", folder, "--quiet", "--until", "8e-5")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(f"{slot}: truncated checkpoint", done.stderr)
                reference = summary(self.whole)["budgets"]
                self.assertEqual(summary(folder)["budgets"], reference)

    def test_case_file_changed(self):
        folder = self.copy("case")
        text = (folder / "case.toml").read_text(encoding="utf-8")
        self.assertIn("power_w = 3000", text)
        (folder / "case.toml").write_text(text.replace("power_w = 3000", "power_w = 2000"), encoding="utf-8")
        self.refused(folder, "case.toml", "was changed since", "--set KEY=VALUE --out DIR")

    def test_case_file_damaged(self):
        folder = self.copy("case")
        text = (folder / "case.toml").read_text(encoding="utf-8")
        (folder / "case.toml").write_text(text[:len(text) // 2], encoding="utf-8")
        self.refused(folder, "case.toml")

    def test_marker(self):
        folder = self.copy("marker")
        (folder / ".meltray-run").write_text("{}", encoding="utf-8")
        self.refused(folder, ".meltray-run", "damaged marker")
        (folder / ".meltray-run").unlink()
        self.refused(folder, "not a run folder of meltray")

    def test_history(self):
        """Another header is refused; a half-written last line is cut off."""
        folder = self.copy("header")
        text = (folder / "history.csv").read_text(encoding="utf-8")
        (folder / "history.csv").write_text("t," + text, encoding="utf-8")
        self.refused(folder, "history.csv:1:", "columns")
        folder = self.copy("line")
        (folder / "history.csv").write_text(text[:-40], encoding="utf-8")
        done = meltray("resume", folder, "--quiet", "--until", "8e-5")
        self.assertEqual(done.returncode, 0, done.stderr)
        whole = (self.whole / "history.csv").read_text(encoding="utf-8").splitlines()
        lines = (folder / "history.csv").read_text(encoding="utf-8").splitlines()
        # the row of t = 6e-5 s, whose checkpoint vouched for it, was cut by hand and cannot come back
        self.assertEqual(lines, [line for line in whole if not line.startswith("6e-05,")])

    def test_snapshot(self):
        """A damaged snapshot does not stop a run; it is written again when the run gets there."""
        folder = self.copy("snapshot")
        last = snapshots(folder)[-1]
        last.write_bytes(last.read_bytes()[:500])
        done = meltray("resume", folder, "--quiet", "--until", "8e-5")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_measurements(self):
        """A bad CSV of `meltray compare`."""
        header = "material,f_hz,amplitude_ratio_mm_per_kw,mean_depth_mm,phase_lag_deg,definition,uncertainty,source\n"
        for name, text in {"no header": "1,2,3\n", "no number": header + "iron,fast,1,2,3,axis,0.1,x\n", "empty": "",
                           "fields": header + "iron,100\n"}.items():
            with self.subTest(name):
                table = self.write("measured.csv", text)
                done = meltray("compare", self.stopped, "--measured", table)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn("measured.csv", done.stderr)


if __name__ == "__main__":
    main()
