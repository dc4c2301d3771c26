#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whole scenes at fixed work: what each feature of a weld costs, growth with particles, one thread and two.

usage: scenes.py BINARY [--json FILE] [--quick] [--only GROUP] [--pool RUN...]

  features  a developed pool (the 2 kW weld at 3 ms, or the run --pool) goes on with features taken away, one at a
            time
  rows      the same weld from its start by the rows of Table 1, and in two dimensions
  threads   the weld and a dam break with one thread and two
  cold      the weld in the whole workpiece and in one cut off below, where nothing happens: what cold solid costs
            in time, memory and, where valgrind is installed, instructions a step
  pools     developed pools (--pool, each a finished run) go on with each projection: what a simulated millisecond
            costs by the number of liquid particles; left out without --pool
  growth    a dam break with 24,000 to 2 million particles of water, 82 neighbours, two evaluations a step

Pools of any size are made by a stronger weld, run to later and later times:
`meltray run cases/weld_iron_2kw.toml --set laser.power_w=4000 --until 0.02 --out RUN`.

Every scene runs in a process of its own, for a fixed simulated time; numbers are ratios within one run of this
program. Wall times on a machine that does other work mean little; microseconds per liquid particle and step and
the shares of the parts are steadier.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
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
# Lower end of the workpiece, far below the melt. So early both make the same steps; and the smaller the pool, the
# more a step could show of what lies idle.
WORKPIECES = {"cut off at 3 mm": -3e-3, "whole, 6 mm": -6e-3}
COLD_START, COLD_END = 1e-4, 3e-4  # [s]
COLD_PARTICLES = 80 * 48 * 60  # that the whole workpiece has more


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
    for counter in ("steps", "pressure_solves", "time_s"):
        after[counter] -= before[counter]
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


def features(binary, folder, quick, threads, pool):
    base = pool[0] if pool else folder / "developed"
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


def instructions_per_step(binary, source, until):
    """Instructions of a step by callgrind, on one thread; nothing without valgrind."""
    if not shutil.which("valgrind"):
        return None
    before = json.loads((source / "summary.json").read_text())
    out = source.with_name(source.name + "_counted")
    # The program starts itself anew for its threads' settings unless they are given.
    command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}.callgrind",
               "--toggle-collect=meltray::scene::Simulation::step(double)", str(binary), "resume", str(source),
               "--out", str(out), "--until", str(until), "--threads", "1", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True, check=False,
                          env={**os.environ, "GOMP_SPINCOUNT": "0"})
    collected = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or not collected:
        # Valgrind 3.19 does not know every instruction that compilers write.
        last = done.stderr.strip().splitlines()[-1:]
        print(f"scenes.py: no instructions counted: valgrind ended with {done.returncode}: {' '.join(last)}", file=sys.stderr)
        return None
    after = json.loads((out / "summary.json").read_text())
    return int(collected[1]) / (after["steps"] - before["steps"])


def cold(binary, folder, quick, threads):
    rows = []
    for k, (name, bottom) in enumerate(WORKPIECES.items()):
        settings = [f"{key}=[0.0, -1.2e-3, {bottom}]" for key in ("domain.min_m", "bodies.0.min_m")]
        base = folder / f"cold{k}"
        start = run(binary, WELD, base, COLD_START, ["output.snapshot_interval_s=0", *settings], threads)
        until = COLD_START + 5e-5 if quick else COLD_END
        rows.append(row(name, fork(binary, base, folder / f"cold{k}_on", until, [], threads), threads))
        rows[-1]["peak_memory_mb"] = start["peak_memory_bytes"] / 1e6  # without the checkpoint that is read
        rows[-1]["instructions_per_step"] = instructions_per_step(binary, base, until)
    show("a weld and its cold solid", rows)
    cut, whole = rows
    print(f"a step of the whole workpiece: {whole['milliseconds_per_step'] / cut['milliseconds_per_step']:.3f} times "
          "the time", end="")
    if whole["instructions_per_step"] and cut["instructions_per_step"]:
        print(f", {whole['instructions_per_step'] / cut['instructions_per_step']:.4f} times the instructions", end="")
    print(f"; {1e6 * (whole['peak_memory_mb'] - cut['peak_memory_mb']) / COLD_PARTICLES:.0f} bytes a particle of "
          "cold solid")
    return rows


def pools(binary, folder, quick, threads, pool):
    rows = []
    for k, base in enumerate(pool):
        until = json.loads((base / "summary.json").read_text())["time_s"] + (2e-5 if quick else 1e-4)
        for projection in ("step", "stage"):
            summary = fork(binary, base, folder / f"pool{k}{projection}", until,
                           [f"splitting.projection={projection}", "output.snapshot_interval_s=0"], threads)
            liquid = summary["particles"]["liquid"]
            # Steps alone: reading the checkpoint is as long as some of them.
            wall = sum(part["seconds"] for name, part in summary["time_by_part"].items() if name != "observe")
            rows.append({
                **row(f"{liquid} liquid, {projection}", summary, threads),
                "seconds_per_millisecond": 1e-3 * wall / summary["time_s"],
                "step_us": 1e6 * summary["time_s"] / summary["steps"],
                "microseconds_per_liquid_particle_and_solve":
                    1e6 * summary["time_by_part"]["pressure"]["seconds"] / summary["pressure_solves"] / liquid,
            })
    show("developed pools", rows)
    for r in rows:
        print(f"{r['name']}: {r['seconds_per_millisecond']:.1f} s a simulated ms, steps of {r['step_us']:.2f} us, "
              f"{r['microseconds_per_liquid_particle_and_solve']:.2f} us a liquid particle and pressure solve")
    return rows


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


GROUPS = {"features": features, "rows": rows_of_table_1, "threads": one_and_more_threads, "cold": cold,
          "pools": pools, "growth": growth}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binary")
    parser.add_argument("--json")
    parser.add_argument("--quick", action="store_true", help="a tenth of the work")
    parser.add_argument("--only", choices=GROUPS, help="one group of scenes")
    parser.add_argument("--pool", type=pathlib.Path, nargs="+", default=[], help="runs with a developed pool")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    results = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, group in GROUPS.items():
            if name == "pools" and not arguments.pool:
                continue
            if arguments.only in (None, name):
                more = {"pool": arguments.pool} if name in ("features", "pools") else {}
                results[name] = group(arguments.binary, pathlib.Path(folder), arguments.quick, arguments.threads, **more)
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
