# SPDX-License-Identifier: MIT
"""Sections through the metal along the feed: sections.png of a run, and a picture of each snapshot."""

import sys

import h5py
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

PANELS = 6  # the most sections that are drawn
SOLID, SEAM, BEAM = "#d9d9d9", "#636363", "deepskyblue"
# Without the dark end, hard to tell from the seam, and the palest, hard to tell from the background.
MELT = LinearSegmentedColormap.from_list("melt", plt.cm.inferno(np.linspace(0.3, 0.95, 256)))
SMALLEST_RANGE_K = 100  # of the colours: a melt of one temperature shows no noise


class Section:
    """Particles in a slab of one and a half spacings around a plane along x and z."""

    def __init__(self, path, y=None):
        """Without y the plane is that of the beam or, without a laser, the middle of the bodies."""
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
            if y is None:
                y = (position[:, 1].min() + position[:, 1].max()) / 2 if focus is None else focus[1]
            self.y = float(y)
            slab = np.abs(position[:, 1] - self.y) < 0.75 * self.spacing
            self.x, self.z = 1e3 * position[slab, 0], 1e3 * position[slab, 2]
            self.temperature = file["temperature"][:][slab]
            self.liquid = file["phase"][:][slab] == 1
            self.seam = (file["resolidified"][:][slab] == 1) & ~self.liquid

    @property
    def solid(self):
        return ~self.liquid & ~self.seam

    @property
    def has_beam(self):
        return self.focus is not None and self.power > 0 and self.axis[2] < 0

    def draw(self, axes, norm, frame, depth_mm):
        size = 1e3 * self.spacing

        def discs(mask, **look):
            # As large as the diagonal of the lattice: no background shines through.
            n = int(mask.sum())
            if n == 0:  # matplotlib draws an empty collection of this kind as one disc in the corner
                return
            axes.add_collection(
                EllipseCollection(np.full(n, 1.42 * size), np.full(n, 1.42 * size), np.zeros(n), units="xy",
                                  offsets=np.column_stack((self.x[mask], self.z[mask])),
                                  transOffset=axes.transData, linewidths=0, rasterized=True, **look))

        discs(self.solid, facecolors=SOLID)
        discs(self.seam, facecolors=SEAM)
        discs(self.liquid, array=self.temperature[self.liquid], cmap=MELT, norm=norm)
        left, right, bottom, top = frame
        axes.set_xlim(left, right)
        axes.set_ylim(bottom, top)
        if self.has_beam:
            self.draw_beam(axes, top, -depth_mm)
        axes.set_aspect("equal")
        axes.grid(False)
        axes.set_xlabel("x [mm]")
        axes.set_ylabel("z [mm]")

    def draw_beam(self, axes, top, bottom):
        """Envelope at 1/e^2 from the top of the picture down to what the beam sees."""
        z = np.linspace(top, min(bottom, 0.0), 60) * 1e-3
        along = (z - self.focus[2]) / self.axis[2]
        x = self.focus[0] + along * self.axis[0]
        w = self.radius * np.sqrt(1 + (along / self.rayleigh) ** 2)
        # Behind the particles, whose colours mean temperatures.
        axes.fill_betweenx(1e3 * z, 1e3 * (x - w), 1e3 * (x + w), color=BEAM, alpha=0.25, lw=0, zorder=0)
        axes.plot(1e3 * x, 1e3 * z, BEAM, lw=0.7)


def chosen_snapshots(snapshots):
    """At most PANELS of them, the last one and back from there in equal strides."""
    stride = max(1, -(-(len(snapshots) - 1) // PANELS))
    return snapshots[::-stride][:PANELS][::-1]


def read_sections(run):
    sections = []
    for path in chosen_snapshots(run.snapshots):
        try:
            sections.append(Section(path, sections[0].y if sections else None))
        except (OSError, KeyError) as problem:
            print(f"{path}: left out: {problem}", file=sys.stderr)
    return sections


def common_frame(sections):
    """Left, right, bottom and top of all that is in the sections [mm]: all pictures show the same part."""
    x, z = np.concatenate([s.x for s in sections]), np.concatenate([s.z for s in sections])
    edge = 1e3 * sections[0].spacing
    left, right, bottom, top = x.min() - edge, x.max() + edge, z.min() - edge, z.max() + edge
    if any(s.has_beam for s in sections):  # room for it above the workpiece, whose top is z = 0
        top = max(top, -0.2 * bottom)
    return left, right, bottom, top


def melt_colours(sections):
    """Temperatures of the colours, the same in all pictures and without outliers; None without melt."""
    melt = np.concatenate([s.temperature[s.liquid] for s in sections])
    if not len(melt):
        return None
    low, high = np.percentile(melt, [1, 99])
    half = max(high - low, SMALLEST_RANGE_K) / 2
    return plt.Normalize((low + high) / 2 - half, (low + high) / 2 + half)


def add_colour_bar(figure, axes, norm):
    if norm is not None:
        colours = plt.cm.ScalarMappable(norm=norm, cmap=MELT)
        bar = figure.colorbar(colours, ax=axes, shrink=0.8, aspect=30, extend="both", extendfrac=0.03)
        bar.set_label("temperature of the melt [K]")


def add_legend(figure, sections):
    """Below the figure: what the colours mean that are not in the colour bar."""
    def dot(color, label):
        return Line2D([], [], ls="", marker="o", color=color, label=label)

    handles = []
    if any(s.solid.any() for s in sections):
        handles.append(dot(SOLID, "solid"))
    if any(s.seam.any() for s in sections):
        handles.append(dot(SEAM, "re-solidified seam"))
    if any(s.has_beam for s in sections):
        handles += [Patch(color=BEAM, alpha=0.25, lw=0, label="laser beam"),
                    Line2D([], [], color=BEAM, lw=0.7, label="beam axis")]
    if handles:
        figure.legend(handles=handles, ncols=2 if len(sections) == 1 else len(handles), fontsize=7,
                      loc="upper center", bbox_to_anchor=(0.5, 0))


def panel_size(frame, area):
    """Width and height [inch] of a picture of the frame."""
    left, right, bottom, top = frame
    aspect = np.clip((right - left) / (top - bottom), 0.2, 10)
    return np.sqrt(area * aspect), np.sqrt(area / aspect)


def time_digits(times_ms):
    """Decimals that give the times to a hundredth of the smallest distance between them."""
    distance = np.diff(times_ms).min() if len(times_ms) > 1 else 1.0
    for digits in range(9):
        if np.abs(np.round(times_ms, digits) - times_ms).max() < 0.01 * distance:
            return digits
    return 9


def draw_sections(run):
    sections = read_sections(run)
    if not any(len(s.x) for s in sections):
        if sections:
            print(f"{run.folder}: no particle near y = {sections[0].y:g} m: no sections", file=sys.stderr)
        return
    frame, norm = common_frame(sections), melt_colours(sections)
    digits = time_digits(np.array([1e3 * s.time for s in sections]))
    for old in run.plots.glob("section_*.png"):
        old.unlink()
    for s in sections:
        draw_section(run, s, frame, norm, digits)
    draw_overview(run, sections, frame, norm, digits)


def draw_section(run, section, frame, norm, digits):
    width, height = panel_size(frame, 16)
    figure, axes = plt.subplots(figsize=(width + 1.5, height + 1), layout="constrained")
    section.draw(axes, norm, frame, 1e3 * run.axis_depth(section.time))
    axes.set_title(f"{run.title()}\nt = {1e3 * section.time:.{max(digits, 2)}f} ms", fontsize=9)
    add_colour_bar(figure, axes, norm)
    add_legend(figure, [section])
    name_digits = max(digits, 3)
    run.save(figure, f"section_{1e3 * section.time:0{name_digits + 4}.{name_digits}f}ms.png")


def draw_overview(run, sections, frame, norm, digits):
    width, height = panel_size(frame, 7)
    most = max(1, int(13 / (width + 0.7)))  # columns that a page holds
    rows = -(-len(sections) // most)
    columns = -(-len(sections) // rows)
    figure, grid = plt.subplots(rows, columns, squeeze=False, layout="constrained",
                                figsize=(columns * (width + 0.7) + 1, rows * (height + 0.7) + 0.4))
    for axes in grid.ravel()[len(sections):]:
        axes.set_visible(False)
    for axes, s in zip(grid.ravel(), sections):
        s.draw(axes, norm, frame, 1e3 * run.axis_depth(s.time))
        axes.set_title(f"t = {1e3 * s.time:.{max(digits, 2)}f} ms", fontsize=9)
    add_colour_bar(figure, grid, norm)
    add_legend(figure, sections)
    y_mm = round(1e3 * sections[0].y, 3) + 0.0  # no "-0"
    figure.suptitle(f"{run.title()}: lengthwise section at y = {y_mm:g} mm")
    run.save(figure, "sections.png")
