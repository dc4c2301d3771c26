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
from matplotlib.collections import EllipseCollection

PANELS = 6  # sections that are drawn, spread evenly over the snapshots
SOLID, SEAM = "#d9d9d9", "#636363"
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


def draw_budgets(run):
    figure, axes = plt.subplots(2, 2, figsize=(10, 6), sharex=True)
    energy, error, step, counts = axes.ravel()
    for name in ("stored", "laser", "boundary", "evaporation", "radiation", "ejected", "clamped", "undeposited"):
        values = run.column(f"energy_{name}_j")
        if np.nanmax(np.abs(values), initial=0) > 0:
            energy.plot(run.ms, values, label=name)
    energy.set_ylabel("energy since t = 0 [J]")
    if energy.lines:
        energy.legend(fontsize=7)
    values = run.column("energy_relative_error")
    if np.nanmax(values, initial=0) > 0:
        error.semilogy(run.ms, np.maximum(values, 1e-17))
    error.set_ylabel("relative error of the energy")
    if np.nanmax(run.column("dt_s"), initial=0) > 0:
        step.semilogy(run.ms[1:], 1e6 * run.column("dt_s")[1:])
    step.set_ylabel("mean step [us]")
    counts.plot(run.ms, run.column("liquid_particles"), label="liquid")
    counts.plot(run.ms, run.column("active_particles"), label="active")
    counts.set_ylabel("particles")
    counts.legend(fontsize=7)
    for a in (step, counts):
        a.set_xlabel("time [ms]")
    figure.suptitle(run.title())
    run.save(figure, "budgets.png")


def draw_pool(run):
    figure, (pool, state) = plt.subplots(2, 1, figsize=(7, 5), sharex=True)
    for name in ("length", "width", "depth"):
        pool.plot(run.ms, 1e3 * run.column(f"pool_{name}_m"), label=f"pool {name}")
    pool.plot(run.ms, 1e3 * run.column("top_surface_max_m"), "k:", lw=1, label="highest melt")
    pool.set_ylabel("[mm]")
    pool.legend(fontsize=7)
    pool.set_title(run.title())
    state.plot(run.ms, run.column("max_temperature_k"), "C3")
    state.set_ylabel("highest temperature [K]", color="C3")
    speed = state.twinx()
    speed.grid(False)
    speed.plot(run.ms, run.column("max_speed_m_s"), "C0", lw=0.9)
    speed.set_ylabel("highest speed [m/s]", color="C0")
    state.set_xlabel("time [ms]")
    run.save(figure, "pool.png")


def draw_seam(run):
    path = run.folder / "seam.csv"
    seam = read_csv(path) if path.exists() else {}
    if len(seam.get("x_m", [])) < 2:
        return
    figure, axes = plt.subplots(figsize=(7, 3))
    axes.plot(1e3 * seam["x_m"], 1e3 * seam["depth_m"], label="depth")
    if np.any(seam["width_m"] > 0):
        axes.plot(1e3 * seam["x_m"], 1e3 * seam["width_m"], label="width")
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("re-solidified seam [mm]")
    axes.legend(fontsize=7)
    axes.set_title(run.title())
    run.save(figure, "seam.png")


class Section:
    """Particles in a slab of one and a half spacings around the plane of the beam."""

    def __init__(self, path):
        with h5py.File(path, "r") as file:
            self.time = float(file.attrs["time_s"])
            self.spacing = float(file.attrs["spacing_m"])
            position = file["position"][:].astype(float)
            focus = file.attrs.get("beam_focus_m")
            self.focus = None if focus is None else np.array(focus)
            self.axis = None if focus is None else np.array(file.attrs["beam_axis"])
            self.radius = 0.5 * float(file.attrs.get("beam_focal_diameter_m", 0))
            self.rayleigh = float(file.attrs.get("beam_rayleigh_length_m", np.inf))
            self.power = float(file.attrs.get("beam_power_w", 0))
            y0 = 0.0 if focus is None else float(focus[1])
            slab = np.abs(position[:, 1] - y0) < 0.75 * self.spacing
            self.x, self.z = 1e3 * position[slab, 0], 1e3 * position[slab, 2]
            self.temperature = file["temperature"][:][slab]
            self.liquid = file["phase"][:][slab] == 1
            self.seam = (file["resolidified"][:][slab] == 1) & ~self.liquid

    def draw(self, axes, norm, frame, depth_mm):
        size = 1e3 * self.spacing

        def discs(mask, **look):
            # A little larger than the spacing: no background shines through the lattice.
            n = int(mask.sum())
            if n == 0:  # matplotlib draws an empty collection of this kind as one disc in the corner
                return
            axes.add_collection(
                EllipseCollection(np.full(n, 1.35 * size), np.full(n, 1.35 * size), np.zeros(n), units="xy",
                                  offsets=np.column_stack((self.x[mask], self.z[mask])),
                                  transOffset=axes.transData, linewidths=0, rasterized=True, **look))

        discs(~self.liquid & ~self.seam, facecolors=SOLID)
        discs(self.seam, facecolors=SEAM)
        discs(self.liquid, array=self.temperature[self.liquid], cmap="inferno", norm=norm)
        left, right, bottom, top = frame
        axes.set_xlim(left, right)
        axes.set_ylim(bottom, top)
        self.draw_beam(axes, top, -depth_mm)
        axes.set_aspect("equal")
        axes.grid(False)
        axes.set_title(f"t = {1e3 * self.time:.2f} ms", fontsize=9)

    def frame(self):
        """Left, right, bottom and top of the solid and its seam [mm]; spatter does not count."""
        x, z = (self.x[~self.liquid], self.z[~self.liquid]) if np.any(~self.liquid) else (self.x, self.z)
        return np.array([x.min(), x.max(), z.min(), max(z.max(), 0.0)]) if len(x) else None

    def draw_beam(self, axes, top, bottom):
        """Envelope at 1/e^2 from the top of the picture down to what the beam sees."""
        if self.focus is None or self.power <= 0 or self.axis[2] >= 0:
            return
        z = np.linspace(top, min(bottom, 0.0), 60) * 1e-3
        along = (z - self.focus[2]) / self.axis[2]
        x = self.focus[0] + along * self.axis[0]
        w = self.radius * np.sqrt(1 + (along / self.rayleigh) ** 2)
        axes.fill_betweenx(1e3 * z, 1e3 * (x - w), 1e3 * (x + w), color="red", alpha=0.25, linewidth=0)
        axes.plot(1e3 * x, 1e3 * z, "r-", lw=0.5)


def draw_sections(run):
    if not run.snapshots:
        return
    chosen = np.unique(np.linspace(0, len(run.snapshots) - 1, PANELS + 1).round().astype(int))
    if len(chosen) > PANELS:
        chosen = chosen[1:]  # the start shows nothing but solid
    sections = []
    for i in chosen:
        try:
            sections.append(Section(run.snapshots[i]))
        except (OSError, KeyError) as problem:
            print(f"{run.snapshots[i]}: left out: {problem}", file=sys.stderr)
    if not sections:
        return
    melt = [s.temperature[s.liquid] for s in sections if np.any(s.liquid)]
    hot = np.concatenate(melt) if melt else np.array([300.0, 301.0])
    low, high = np.percentile(hot, [1, 99])
    norm = plt.Normalize(low, max(high, low + 1))
    frames = [f for f in (s.frame() for s in sections) if f is not None]
    if not frames:
        return
    # All pictures show the same part: the workpiece at the first of them and a fifth of its height above.
    left, right, bottom, top = frames[0]
    space = max(0.2 * (top - bottom), 4e3 * sections[0].spacing)
    edge = 1e3 * sections[0].spacing
    frame = (left - edge, right + edge, bottom - edge, top + space)

    def depth_at(t):
        if not len(run.ms):
            return 0.0
        return 1e3 * float(np.interp(t, run.history["time_s"], run.column("axis_depth_m")))

    def label(axes):
        axes.set_ylabel("z [mm]")
        axes.set_xlabel("x [mm]")

    def colour_bar(figure, axes):
        colours = plt.cm.ScalarMappable(norm=norm, cmap="inferno")
        figure.colorbar(colours, ax=axes, shrink=0.8).set_label("temperature of the melt [K]")

    for old in run.plots.glob("section_*.png"):
        old.unlink()
    for s in sections:
        figure, axes = plt.subplots(figsize=(6, 4.5))
        s.draw(axes, norm, frame, depth_at(s.time))
        colour_bar(figure, axes)
        label(axes)
        run.save(figure, f"section_{1e3 * s.time:07.3f}ms.png")

    columns = min(3, len(sections))
    rows = -(-len(sections) // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(3.6 * columns + 0.8, 3.2 * rows), squeeze=False,
                                layout="constrained")
    for axes in grid.ravel()[len(sections):]:
        axes.set_visible(False)
    for axes, s in zip(grid.ravel(), sections):
        s.draw(axes, norm, frame, depth_at(s.time))
        label(axes)
    colour_bar(figure, grid)
    figure.suptitle(f"{run.title()}: lengthwise section")
    run.save(figure, "sections.png")


def draw_overlay(runs):
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
    runs[0].save(figure, "depth_overlay.png")


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
    if len(runs) > 1:
        draw_overlay(runs)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except UsageError as error:
        print(f"meltray plot: {error}", file=sys.stderr)
        sys.exit(2)
    except OSError as error:
        print(f"meltray plot: {error}", file=sys.stderr)
        sys.exit(4)
