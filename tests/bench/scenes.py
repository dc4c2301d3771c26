#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whole scenes at fixed work: what each feature of a weld costs, growth with particles, one thread and two.

usage: scenes.py BINARY [--json FILE] [--quick] [--only features|rows|threads|growth] [--pool RUN]

  features  a developed pool (the 2 kW weld at 3 ms, or the run --pool) goes on with features taken away, one at a
            time
  rows      the same weld from its start by the rows of Table 1, and in two dimensions
  threads   the weld and a dam break with one thread and two
  growth    a dam break with 24,000 to 2 million particles of water, 82 neighbours, two evaluations a step

Every scene runs in a process of its own, for a fixed simulated time; numbers are ratios within one run of this
program. Wall times on a machine that does other work mean little; microseconds per liquid particle and step and
the shares of the parts are steadier.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
CASES = HERE.parents[1] / "cases"
WELD = CASES / "weld_iron_2kw.toml"
DAM_BREAK = HERE / "dam_break.toml"
DEVELOPED = 3e-3  # [s]

# name -> settings, and the part whose share of the whole weld is compared with what is saved
FEATURES = {
    "weld": ([], None),
    "no marangoni": (["terms.marangoni=false"], "forces"),
    "no wetting": (["terms.wetting=false"], None),
    "no interface viscosity": (["terms.interface_viscosity=false"], "viscosity"),
    "no evaporation": (["terms.evaporation=false", "terms.radiation=false"], None),
    "no shifting": (["flow.shifting=0"], None),
    "light not traced again": (["laser.retrace_interval_s=1", "laser.retrace_motion=10"], "laser"),
    "500 rays": (["laser.rays=500"], None),
    "projection in every stage": (["splitting.projection=stage"], None),
}
# Case and settings of the rows of Table 1
ROWS = {
    "isph": (WELD, []),
    "wcsph_reduced": (CASES / "weld_iron_2kw_wcsph_reduced.toml", []),
    "wcsph_reduced_interface": (CASES / "weld_iron_2kw_wcsph_reduced_interface.toml", []),
    "wcsph, elastic": (CASES / "weld_iron_2kw_wcsph.toml", []),
    "wcsph, fixed solid": (CASES / "weld_iron_2kw_wcsph.toml", ["flow.solid=fixed"]),
}
# Particles of water -> spacing over the height of the column
SIZES = {"24k": 1 / 29, "163k": 1 / 54.5, "0.5M": 1 / 80, "2M": 1 / 126}
STEPS = 60  # of a dam break, about


def call(binary, *arguments):
    command = [str(a) for a in (binary, *arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"scenes.py: {' '.join(command)}: exit {done.returncode}\n{done.stderr}")


def sets(settings):
    return [word for setting in settings for word in ("--set", setting)]


def run(binary, case, out, until, settings, threads):
    """The summary of a run from its start."""
    call(binary, "run", case, "--out", out, "--until", until, "--threads", threads, "--quiet", *sets(settings))
    return json.loads((out / "summary.json").read_text())


def fork(binary, source, out, until, settings, threads):
    """The summary of a run that goes on with other settings; steps are those of its own."""
    before = json.loads((source / "summary.json").read_text())
    call(binary, "resume", source, "--out", out, "--until", until, "--threads", threads, "--quiet", *sets(settings))
    after = json.loads((out / "summary.json").read_text())
    after["mean_liquid_particles"] = after["particles"]["liquid"]
    after["steps"] -= before["steps"]
    return after


def row(name, summary, threads):
    steps, liquid = summary["steps"], summary["mean_liquid_particles"]
    wall = summary["session_wall_seconds"] - summary["time_by_part"]["observe"]["seconds"]
    return {
        "name": name,
        "threads": threads,
        "seconds": wall,
        "steps": steps,
        "milliseconds_per_step": 1e3 * wall / steps,
        "mean_liquid": liquid,
        "microseconds_per_liquid_particle_step": 1e6 * wall / steps / max(liquid, 1),
        "million_particle_steps_per_second": 1e-6 * steps * liquid / wall,
        "peak_memory_mb": summary["peak_memory_bytes"] / 1e6,
        "bytes_per_liquid_particle": summary["peak_memory_bytes"] / max(liquid, 1),
        "shares": {part: round(value["share"], 3) for part, value in summary["time_by_part"].items()
                   if value["share"] > 0.005 and part != "observe"},
    }


def show(title, rows):
    print(f"\n{title}")
    print(f"{'scene':28} {'threads':>7} {'s':>8} {'steps':>6} {'ms/step':>8} {'liquid':>8} {'us/liq':>7} {'MB':>7}")
    for r in rows:
        print(f"{r['name']:28} {r['threads']:7} {r['seconds']:8.2f} {r['steps']:6} {r['milliseconds_per_step']:8.2f} "
              f"{r['mean_liquid']:8.0f} {r['microseconds_per_liquid_particle_step']:7.2f} {r['peak_memory_mb']:7.0f}",
              flush=True)


def features(binary, folder, quick, threads, pool=None):
    base = pool or folder / "developed"
    if not pool:
        run(binary, WELD, base, DEVELOPED, ["output.snapshot_interval_s=0"], threads)
    until = json.loads((base / "summary.json").read_text())["time_s"] + (5e-5 if quick else 3e-4)
    rows = [row(name, fork(binary, base, folder / name.replace(" ", "_"), until, settings, threads), threads)
            for name, (settings, _) in FEATURES.items()]
    show("a developed pool with features taken away", rows)
    whole = rows[0]
    print("shares of the whole weld: " + ", ".join(f"{k} {100 * v:.0f} %" for k, v in whole["shares"].items()))
    for r, (_, part) in zip(rows, FEATURES.values()):
        if part:
            saved = 1 - r["milliseconds_per_step"] / whole["milliseconds_per_step"]
            print(f"{r['name']}: saves {100 * saved:.0f} % of a step; the share of `{part}` is "
                  f"{100 * whole['shares'].get(part, 0):.0f} %")
    return rows


def rows_of_table_1(binary, folder, quick, threads):
    until = 1e-4 if quick else 1e-3
    rows = [row(name, run(binary, case, folder / f"row{k}", until, settings, threads), threads)
            for k, (name, (case, settings)) in enumerate(ROWS.items())]
    show(f"the first {until * 1e3:g} ms of the weld by rows of Table 1", rows)
    return rows


def dam_break(binary, out, size, threads):
    spacing = SIZES[size]
    step = 0.25 * 1.35 * spacing / (20 * 1.03)
    summary = run(binary, DAM_BREAK, out, STEPS * step,
                  [f"domain.spacing_m={spacing}", f"output.interval_s={STEPS * step}"], threads)
    return row(f"dam break, {size}", summary, threads)


def growth(binary, folder, quick, threads):
    rows = [dam_break(binary, folder / f"growth{size}", size, threads) for size in list(SIZES)[:2 if quick else 4]]
    show("growth with particles: a dam break", rows)
    for r in rows:
        print(f"{r['name']}: {r['million_particle_steps_per_second']:.2f} million particle-steps a second, "
              f"{r['bytes_per_liquid_particle']:.0f} bytes a particle of water, its walls included")
    return rows


def one_and_more_threads(binary, folder, quick, threads):
    until = 1e-4 if quick else 1e-3
    rows = [row("weld", run(binary, WELD, folder / f"weld{n}", until, [], n), n) for n in (1, threads)]
    rows += [dam_break(binary, folder / f"dam{n}", "24k", n) for n in (1, threads)]
    show("threads", rows)
    return rows


GROUPS = {"features": features, "rows": rows_of_table_1, "threads": one_and_more_threads, "growth": growth}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binary")
    parser.add_argument("--json")
    parser.add_argument("--quick", action="store_true", help="a tenth of the work")
    parser.add_argument("--only", choices=GROUPS, help="one group of scenes")
    parser.add_argument("--pool", type=pathlib.Path, help="a run with a developed pool")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    results = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, group in GROUPS.items():
            if arguments.only in (None, name):
                more = {"pool": arguments.pool} if name == "features" else {}
                results[name] = group(arguments.binary, pathlib.Path(folder), arguments.quick, arguments.threads, **more)
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
