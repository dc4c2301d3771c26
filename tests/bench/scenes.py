#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whole scenes at fixed work: what each feature of a weld costs, growth with particles, one thread and two.

usage: scenes.py BINARY [--json FILE] [--quick]

Every scene runs in a process of its own, for a fixed simulated time; numbers are ratios within one run of this
program. Wall times on a machine that does other work mean little; `microseconds per liquid particle and step` and
the shares of the parts are steadier.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"

DROP_STEP = 1e-8  # short, so that every spacing takes the same steps [s]

# name -> what is taken away from the weld
WELD = {
    "weld": [],
    "no marangoni": ["terms.marangoni=false"],
    "no wetting": ["terms.wetting=false"],
    "no interface viscosity": ["terms.interface_viscosity=false"],
    "no evaporation": ["terms.evaporation=false", "terms.radiation=false"],
    "no shifting": ["flow.shifting=0"],
    "projection in every stage": ["splitting.projection=stage"],
}


def run(binary, case, until, settings, threads):
    """The summary of one run."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "run"
        command = [binary, "run", case, "--out", out, "--until", str(until), "--threads", str(threads), "--quiet"]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"scenes.py: {' '.join(map(str, command))}: exit {done.returncode}\n{done.stderr}")
        return json.loads((out / "summary.json").read_text())


def row(name, summary, threads):
    steps = summary["steps"]
    liquid = summary["mean_liquid_particles"]
    wall = summary["session_wall_seconds"] - summary["time_by_part"]["observe"]["seconds"]
    return {
        "name": name,
        "threads": threads,
        "seconds": wall,
        "steps": steps,
        "milliseconds_per_step": 1e3 * wall / steps,
        "mean_liquid": liquid,
        "microseconds_per_liquid_particle_step": 1e6 * wall / steps / max(liquid, 1),
        "peak_memory_mb": summary["peak_memory_bytes"] / 1e6,
        "shares": {part: round(value["share"], 3) for part, value in summary["time_by_part"].items()
                   if value["share"] > 0.005},
    }


def show(title, rows):
    print(f"\n{title}")
    print(f"{'scene':28} {'threads':>7} {'s':>8} {'steps':>6} {'ms/step':>8} {'liquid':>8} {'us/liq':>7} {'MB':>7}")
    for r in rows:
        print(f"{r['name']:28} {r['threads']:7} {r['seconds']:8.2f} {r['steps']:6} {r['milliseconds_per_step']:8.2f} "
              f"{r['mean_liquid']:8.0f} {r['microseconds_per_liquid_particle_step']:7.2f} {r['peak_memory_mb']:7.0f}",
              flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binary")
    parser.add_argument("--json")
    parser.add_argument("--quick", action="store_true", help="a tenth of the work")
    arguments = parser.parse_args()
    weld_time = 1e-4 if arguments.quick else 1e-3
    weld, drop = CASES / "quickstart.toml", CASES / "drop.toml"
    results = {}

    rows = [row(name, run(arguments.binary, weld, weld_time, off, 2), 2) for name, off in WELD.items()]
    results["features"] = rows
    show(f"a weld of {weld_time * 1e3:g} ms with features taken away", rows)
    shares = rows[0]["shares"]
    print("shares of the whole weld: " + ", ".join(f"{k} {100 * v:.0f} %" for k, v in shares.items()))

    rows = [row(f"weld, {n} threads", run(arguments.binary, weld, weld_time, [], n), n) for n in (1, 2)]
    results["threads"] = rows
    show("threads", rows)

    rows = []
    for spacing in (2.5e-5, 1.25e-5) if arguments.quick else (2.5e-5, 1.25e-5, 6.25e-6):
        settings = [f"domain.spacing_m={spacing}", f"time.max_step_s={DROP_STEP}"]
        rows.append(row(f"drop, dx {spacing:g} m", run(arguments.binary, drop, 20 * DROP_STEP, settings, 2), 2))
    results["growth"] = rows
    show("growth with particles: 20 steps of a drop", rows)

    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
