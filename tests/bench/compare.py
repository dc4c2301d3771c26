#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Two results of ./dev bench side by side, as ratios.

usage: compare.py BEFORE.json AFTER.json    (both of kernels, or both of scenes)
"""
import json
import pathlib
import sys


def times(path):
    """name -> seconds, of a result of either kind."""
    content = json.loads(pathlib.Path(path).read_text())
    if "benchmarks" in content:
        return {b["name"]: b["real_time"] for b in content["benchmarks"] if b.get("run_type") != "aggregate"}
    return {f"{group}: {r['name']}": r["milliseconds_per_step"] for group, rows in content.items() for r in rows}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    before, after = times(sys.argv[1]), times(sys.argv[2])
    for name in before:
        if name in after:
            print(f"{name:44} {before[name]:10.3f} {after[name]:10.3f} ms   {before[name] / after[name]:5.2f} x")
    for name in sorted(before.keys() ^ after.keys()):
        print(f"{name:44} only in {'the first' if name in before else 'the second'}")


if __name__ == "__main__":
    main()
