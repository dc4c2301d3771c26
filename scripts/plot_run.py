#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Pictures of one Meltray run or several, finished or not: RUNDIR/plots/*.png.

Usage: plot_run.py RUNDIR...
With several runs their depths are laid over each other in plots/depth_overlay.png of the first one.
"""

import csv
import json
import os
import sys
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import LogLocator

sys.dont_write_bytecode = True  # no folder of compiled code beside the scripts
from sections import draw_sections  # noqa: E402

ENERGIES = ("stored", "laser", "boundary", "evaporation", "radiation", "ejected", "cropped", "undeposited")
plt.rcParams.update({"figure.dpi": 130, "font.size": 9, "axes.grid": True, "grid.alpha": 0.3})


class UsageError(Exception):
    pass


def read_csv(path):
    """Columns by name; words become NaN. The last line of a run that is being written may be incomplete."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    if not rows:
        return {}
    names = rows[0]
    data = [r for r in rows[1:] if len(r) == len(names)]

    def number(text):
        try:
            return float(text)
        except ValueError:
            return float("nan")

    return {name: np.array([number(r[i]) for r in data]) for i, name in enumerate(names)}


def has_content(values):
    return np.nanmax(np.abs(values), initial=0) > 0


class Run:
    def __init__(self, folder):
        self.folder = Path(folder)
        if not (self.folder / "history.csv").exists():
            raise UsageError(f"{folder}: no history.csv: nothing to draw yet")
        self.history = read_csv(self.folder / "history.csv")
        if "time_s" not in self.history:
            raise UsageError(f"{folder}/history.csv: no column time_s")
        try:
            self.summary = json.loads((self.folder / "summary.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            self.summary = {}
        self.name = self.folder.resolve().name
        self.snapshots = sorted((self.folder / "particles").glob("*.h5"))
        self.plots = self.folder / "plots"
        self.plots.mkdir(exist_ok=True)

    @property
    def ms(self):
        return 1e3 * self.history["time_s"]

    def column(self, name):
        return self.history.get(name, np.full_like(self.history["time_s"], np.nan))

    def has_laser(self):
        return has_content(self.column("laser_power_w"))

    def axis_depth(self, time):
        """At a time [s]; [m]."""
        if not len(self.ms):
            return 0.0
        return float(np.interp(time, self.history["time_s"], self.column("axis_depth_m")))

    def title(self):
        outcome = self.summary.get("outcome", "")
        return self.name if outcome in ("", "finished") else f"{self.name} ({outcome})"

    def save(self, figure, name):
        """Written beside and renamed, so that a viewer never sees half a picture."""
        part = self.plots / f".{name}.part"
        figure.savefig(part, format="png", bbox_inches="tight",
                       metadata={"Software": "meltray plot", "Description": f"schema 1; run {self.name}"})
        os.replace(part, self.plots / name)
        plt.close(figure)
        print(self.plots / name)


def shade_closed(axes, run):
    closed = run.column("closed") > 0.5
    axes.fill_between(run.ms, 0, 1, where=closed, transform=axes.get_xaxis_transform(), color="k", alpha=0.08,
                      linewidth=0, label="closed" if closed.any() else None)


def draw_depth(run):
    if not run.has_laser():
        return
    figure, axes = plt.subplots(figsize=(7, 3.6))
    shade_closed(axes, run)
    axes.plot(run.ms, 1e3 * run.column("capillary_depth_m"), "C0", label="void (flood from above)")
    axes.plot(run.ms, 1e3 * run.column("axis_depth_m"), "C0:", lw=1, label="along the beam axis")
    axes.set_xlabel("time [ms]")
    axes.set_ylabel("capillary depth [mm]")
    axes.set_ylim(bottom=0)
    power = axes.twinx()
    power.grid(False)
    power.plot(run.ms, 1e-3 * run.column("laser_power_w"), "C3", lw=0.9, alpha=0.8, label="laser power")
    power.set_ylabel("laser power [kW]", color="C3")
    power.set_ylim(bottom=0)
    lines = axes.get_legend_handles_labels()
    more = power.get_legend_handles_labels()
    axes.legend(lines[0] + more[0], lines[1] + more[1], loc="lower right", fontsize=7)
    axes.set_title(run.title())
    run.save(figure, "depth.png")


def draw_power(run):
    if not run.has_laser():
        return
    figure, (top, bottom) = plt.subplots(2, 1, figsize=(7, 5), sharex=True)
    laser = run.column("laser_power_w")
    top.plot(run.ms, 1e-3 * laser, "C3", label="laser")
    for name, color in (("absorbed", "C0"), ("escaped", "C1"), ("residual", "C2")):
        top.plot(run.ms, 1e-3 * run.column(f"{name}_power_w"), color, lw=1, label=name)
    top.set_ylabel("power [kW]")
    top.legend(fontsize=7)
    top.set_title(run.title())
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(laser > 0, run.column("absorbed_power_w") / laser, np.nan)
    bottom.plot(run.ms, 100 * share, "C0")
    bottom.set_ylim(0, 105)
    bottom.set_ylabel("absorbed [%]")
    bottom.set_xlabel("time [ms]")
    run.save(figure, "power.png")


def plot_energies(axes, run):
    for name in ENERGIES:
        values = run.column(f"energy_{name}_j")
        if has_content(values):
            axes.plot(run.ms, values, label=name)
    axes.set_ylabel("energy since t = 0 [J]")
    axes.legend(fontsize=7)


def plot_energy_error(axes, run):
    axes.semilogy(run.ms, np.maximum(run.column("energy_relative_error"), 1e-17))
    axes.set_ylabel("relative error of the energy")


def plot_steps(axes, run):
    steps = 1e6 * run.column("dt_s")
    steps[~(steps > 0)] = np.nan  # the first row has no step
    axes.plot(run.ms, steps)
    if np.nanmax(steps) > 10 * np.nanmin(steps):
        axes.set_yscale("log")
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter("")
    else:  # a logarithmic axis has too few labels here
        axes.set_ylim(0, 1.1 * np.nanmax(steps))
    axes.set_ylabel("mean step [us]")


def plot_counts(axes, run):
    axes.plot(run.ms, run.column("liquid_particles"), label="liquid")
    axes.plot(run.ms, run.column("active_particles"), label="active")
    axes.set_ylabel("particles")
    axes.legend(fontsize=7)


def draw_budgets(run):
    columns = {plot_energies: [f"energy_{name}_j" for name in ENERGIES],
               plot_energy_error: ["energy_relative_error"],
               plot_steps: ["dt_s"],
               plot_counts: ["liquid_particles", "active_particles"]}
    plots = [plot for plot, names in columns.items() if any(has_content(run.column(n)) for n in names)]
    if not plots:
        return
    rows = -(-len(plots) // 2)
    figure, grid = plt.subplots(rows, 2, figsize=(10, 3 * rows), squeeze=False, layout="constrained")
    for axes in grid.ravel()[len(plots):]:
        axes.set_visible(False)
    for axes, plot in zip(grid.ravel(), plots):
        plot(axes, run)
        axes.set_xlabel("time [ms]")
    figure.suptitle(run.title())
    run.save(figure, "budgets.png")


def plot_pool(axes, run):
    for name in ("length", "width", "depth"):
        values = run.column(f"pool_{name}_m")
        if has_content(values):
            axes.plot(run.ms, 1e3 * values, label=f"pool {name}")
    axes.plot(run.ms, 1e3 * run.column("top_surface_max_m"), "k:", lw=1, label="highest melt")
    axes.set_ylabel("[mm]")
    axes.legend(fontsize=7)


def plot_extremes(axes, run):
    axes.plot(run.ms, run.column("max_temperature_k"), "C3")
    axes.set_ylabel("highest temperature [K]", color="C3")
    axes.set_xlabel("time [ms]")
    if not has_content(run.column("max_speed_m_s")):
        return
    speed = axes.twinx()
    speed.grid(False)
    speed.plot(run.ms, run.column("max_speed_m_s"), "C0", lw=0.9)
    speed.set_ylabel("highest speed [m/s]", color="C0")


def draw_pool(run):
    if not has_content(run.column("max_temperature_k")):
        return
    rows = 2 if has_content(run.column("pool_length_m")) else 1
    figure, grid = plt.subplots(rows, 1, figsize=(7, 2.5 * rows), sharex=True, squeeze=False)
    if rows == 2:
        plot_pool(grid[0, 0], run)
    plot_extremes(grid[-1, 0], run)
    grid[0, 0].set_title(run.title())
    run.save(figure, "pool.png")


def melt_along_x(run):
    """Where the last snapshot has melt below the top of the workpiece, as the middles of spacings (the
    sections of seam.csv), and the spacing [m]; nowhere if it cannot be read."""
    try:
        with h5py.File(run.snapshots[-1], "r") as file:
            spacing = float(file.attrs["spacing_m"])
            position = file["position"][:].astype(float)
            melt = (file["phase"][:] == 1) & (position[:, 2] < 0)
    except (IndexError, OSError, KeyError):
        return np.array([]), 0.0
    return (np.unique(np.floor(position[melt, 0] / spacing)) + 0.5) * spacing, spacing


def draw_seam(run):
    path = run.folder / "seam.csv"
    seam = read_csv(path) if path.exists() else {}
    if len(seam.get("x_m", [])) < 2:
        return
    figure, axes = plt.subplots(figsize=(7, 3))
    x = seam["x_m"]
    melt, spacing = melt_along_x(run)
    settled = np.array([not np.any(np.abs(melt - here) < 0.5 * spacing) for here in x])
    if len(melt):
        axes.bar(1e3 * melt, 1, 1e3 * spacing, transform=axes.get_xaxis_transform(), color="k", alpha=0.08,
                 label="still holds melt: not final")
    for name, color in (("depth", "C0"), ("width", "C1")):
        values = 1e3 * seam[f"{name}_m"]
        if has_content(values):
            # Where melt is left, only its rim has frozen: no depth or width of a seam yet.
            axes.plot(1e3 * x, values, color, ls=":", lw=1)
            axes.plot(1e3 * x, np.where(settled, values, np.nan), color, label=name)
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("re-solidified seam [mm]")
    axes.set_ylim(bottom=0)
    axes.legend(fontsize=7)
    axes.set_title(run.title())
    run.save(figure, "seam.png")


def draw_overlay(folder, runs):
    figure, (depth, power) = plt.subplots(2, 1, figsize=(7.5, 6), sharex=True, height_ratios=(2, 1))
    for i, run in enumerate(runs):
        color = f"C{i % 10}"
        depth.plot(run.ms, 1e3 * run.column("capillary_depth_m"), color, label=run.title())
        depth.plot(run.ms, 1e3 * run.column("axis_depth_m"), color, ls=":", lw=0.8)
        power.plot(run.ms, 1e-3 * run.column("absorbed_power_w"), color)
        power.plot(run.ms, 1e-3 * run.column("laser_power_w"), color, ls="--", lw=0.8, alpha=0.7)
    depth.set_ylabel("capillary depth [mm]\n(dotted: beam axis)")
    depth.set_ylim(bottom=0)
    depth.legend(fontsize=7)
    power.set_ylabel("absorbed power [kW]\n(dashed: laser)")
    power.set_xlabel("time [ms]")
    folder.save(figure, "depth_overlay.png")


def main(folders):
    if not folders:
        raise UsageError(__doc__.strip())
    runs = [Run(folder) for folder in folders]
    for run in runs:
        draw_depth(run)
        draw_power(run)
        draw_pool(run)
        draw_budgets(run)
        draw_seam(run)
        draw_sections(run)
    welds = [run for run in runs if run.has_laser()]
    if len(runs) > 1 and welds:
        draw_overlay(runs[0], welds)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except UsageError as error:
        print(f"meltray plot: {error}", file=sys.stderr)
        sys.exit(2)
    except OSError as error:
        print(f"meltray plot: {error}", file=sys.stderr)
        sys.exit(4)
