#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Figures 3 to 5 of the paper from the runs of `meltray study paper`.

Usage: plot_paper.py FOLDER    (with paper.csv and a run folder for each of its rows)

depth.png: capillary depth over time, a panel for each metal and frequency, a line for each model; period.png: depth
and absorbed power averaged over the periods after the first; ratio.png: amplitude of the depth over that of the power
against the frequency, by both definitions of the amplitude, for the depth of the void and along the beam axis: a void
that closes at its mouth keeps its depth while the beam no longer reaches its bottom.
"""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

plt.rcParams.update({"figure.dpi": 90, "font.size": 8, "axes.grid": True, "grid.alpha": 0.3})


def history(folder):
    with open(folder / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(r[name]) for r in rows])
            for name in ("time_s", "capillary_depth_m", "axis_depth_m", "absorbed_power_w", "laser_power_w")}


def numbers(rows, name):
    return [float(r[name]) if r[name] else np.nan for r in rows]


def panels(keys):
    figure, axes = plt.subplots(1, len(keys), figsize=(4 * len(keys), 3), squeeze=False, layout="constrained")
    return figure, dict(zip(keys, axes[0]))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    with open(folder / "paper.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        sys.exit(f"{folder}/paper.csv: no run")
    models = list(dict.fromkeys(r["model"] for r in rows))
    colours = {m: f"C{k}" for k, m in enumerate(models)}
    keys = sorted({(r["metal"], int(r["f_hz"])) for r in rows})
    runs = {id(r): history(folder / f"{r['metal']}-{r['f_hz']}hz-{r['model']}-seed{r['seed']}") for r in rows}

    figure, axes = panels(keys)
    for r in rows:
        h, ax = runs[id(r)], axes[(r["metal"], int(r["f_hz"]))]
        ax.plot(1e3 * h["time_s"], 1e3 * h["capillary_depth_m"], color=colours[r["model"]], lw=1, label=r["model"])
        ax.plot(1e3 * h["time_s"], 1e3 * h["axis_depth_m"], color=colours[r["model"]], lw=0.5, ls=":")
    for (metal, f), ax in axes.items():
        ax.set(title=f"{metal}, {f} Hz (dots: along the beam axis)", xlabel="time [ms]", ylabel="depth [mm]")
        ax.legend()
    figure.savefig(folder / "depth.png")

    whole = [r for r in rows if runs[id(r)]["time_s"][-1] * int(r["f_hz"]) >= 2]  # those with a period after the first
    keys = sorted({(r["metal"], int(r["f_hz"])) for r in whole}) or keys
    figure, axes = panels(keys)
    for r in whole:
        h, f = runs[id(r)], int(r["f_hz"])
        phase = h["time_s"] * f
        late = phase >= 1
        bins = np.linspace(0, 1, 26)
        place = np.digitize(phase[late] % 1, bins) - 1
        for name, scale, look in (("capillary_depth_m", 1e3, "-"), ("axis_depth_m", 1e3, ":"),
                                  ("absorbed_power_w", 1e-3, "--")):
            mean = [scale * h[name][late][place == k].mean() if (place == k).any() else np.nan for k in range(25)]
            axes[(r["metal"], f)].plot((bins[1:] + bins[:-1]) / 2, mean, look, color=colours[r["model"]], lw=1,
                                       label=r["model"] if look == "-" else None)
    for (metal, f), ax in axes.items():
        ax.set(title=f"{metal}, {f} Hz", xlabel="phase of the power")
        if ax.lines:
            ax.legend()
    axes[keys[0]].set_ylabel("depth of void, along axis (dots) [mm],\nabsorbed power (dashes) [kW]")
    figure.savefig(folder / "period.png")

    figure, both = plt.subplots(1, 2, figsize=(8, 3.5), sharey=True, layout="constrained")
    for ax, prefix, title in ((both[0], "", "depth of the void"), (both[1], "axis_", "depth along the beam axis")):
        draw_ratios(ax, rows, models, colours, prefix)
        ax.set(title=title, xlabel="frequency [Hz]", xscale="log", yscale="log")
        ax.xaxis.set_major_formatter("{x:.0f}")
        ax.xaxis.set_minor_formatter("")
        if ax.has_data():
            ax.legend(fontsize=6)
            ax.set_xticks(sorted({int(r["f_hz"]) for r in rows}))
    both[0].set_ylabel("amplitude of depth / power [mm/kW]")
    figure.savefig(folder / "ratio.png")
    for name in ("depth.png", "period.png", "ratio.png"):
        print(folder / name)


def draw_ratios(ax, rows, models, colours, prefix):
    """Half ranges with their intervals and first harmonics over the frequency, of one of the two depths."""
    for metal in sorted({r["metal"] for r in rows}):
        for model in models:
            some = [r for r in rows if (r["metal"], r["model"]) == (metal, model) and r[prefix + "periods"] != "0"]
            if not some:
                continue
            some.sort(key=lambda r: int(r["f_hz"]))
            f = [int(r["f_hz"]) for r in some]
            half, interval = numbers(some, prefix + "half_range_mm_per_kw"), numbers(some, prefix + "half_range_95")
            interval = [0 if i != i else i for i in interval]  # a single period has none
            ax.errorbar(f, half, yerr=interval, fmt="o-", color=colours[model], capsize=2, lw=1, ms=4,
                        mfc="none" if metal == "aluminium" else None, label=f"{metal}, {model}: half range")
            ax.plot(f, numbers(some, prefix + "harmonic_mm_per_kw"), "s--", color=colours[model], lw=1, ms=3,
                    mfc="none" if metal == "aluminium" else None, label=f"{metal}, {model}: first harmonic")


if __name__ == "__main__":
    main()
