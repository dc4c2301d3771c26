#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Picture of one study of Meltray, beside its data: <kind>.png.

Usage: plot_study.py STUDY.json
"""

import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.colors import ListedColormap

plt.rcParams.update({"figure.dpi": 80, "font.size": 8, "axes.grid": True, "grid.alpha": 0.3})
MARKERS = {"euler": "x", "imex": "o", "explicit": "^", "implicit": "s", "multirate": "D"}
VERDICTS = ["failed", "degraded", "stable"]


def in_order(values):
    return list(dict.fromkeys(values))


def style(method):
    """Colour by order, marker by family, dashes by projection."""
    family, _, rest = method.partition(" ")
    order = int(rest[0]) if rest[:1].isdigit() else 1
    return {"marker": MARKERS.get(family.strip(","), "."), "color": f"C{order - 1}", "markersize": 4, "linewidth": 1,
            "linestyle": "--" if method.endswith("stage") else "-"}


def curve(axes, rows, work, label, looks):
    """One method: a line through the points that the reference is good enough for, hollow marks for the others."""
    points = sorted((r[work], r["error"], r["trusted"]) for r in rows if r["error"] and r[work] > 0)
    good = [(x, y) for x, y, trusted in points if trusted]
    rest = [(x, y) for x, y, trusted in points if not trusted]
    if good:
        axes.loglog(*zip(*good), label=label, **looks)
    if rest:
        axes.loglog(*zip(*rest), **{**looks, "linestyle": "", "markerfacecolor": "none", "alpha": 0.5})


def work_precision(study):
    resolutions = in_order(r["spacing_m"] for r in study["rows"])
    quantities = in_order(r["quantity"] for r in study["rows"])
    works = (("evaluations", "right-hand sides"), ("cpu_seconds", "CPU time [s]"))
    panels = [(q, dx, work) for q in quantities for dx in resolutions for work in works]
    columns = 2 * len(resolutions)
    figure, grid = plt.subplots(len(quantities), columns, figsize=(3.2 * columns, 2.9 * len(quantities)),
                                squeeze=False, sharey="row")
    for axes, (quantity, dx, (work, label)) in zip(grid.flat, panels):
        rows = [r for r in study["rows"] if r["quantity"] == quantity and r["spacing_m"] == dx]
        for method in in_order(r["method"] for r in rows):
            curve(axes, [r for r in rows if r["method"] == method and r["step_s"] > 0], work, method, style(method))
            curve(axes, [r for r in rows if r["method"] == method and r["tolerance_factor"] > 0], work,
                  "_", {**style(method), "linestyle": ":"})
        for r in study["references"]:
            if r["quantity"] == quantity and r["spacing_m"] == dx and r["spread_over_seeds"] > 0:
                axes.axhline(r["spread_over_seeds"], color="0.5", linestyle="-.")
        axes.set_title(f"{quantity}, dx = {dx:.3g} m", fontsize=8)
        axes.set_xlabel(label)
    for axes in grid[:, 0]:
        axes.set_ylabel("relative error")
    handles, labels = max((axes.get_legend_handles_labels() for axes in grid.flat), key=lambda x: len(x[1]))
    figure.legend(handles, labels, loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=7)
    return figure


def splitting(study):
    strengths = in_order(r["strength"] for r in study["rows"])
    bars = in_order((r["projection"], r["assignment"]) for r in study["rows"])
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 0.6 + 0.25 * len(bars) * len(strengths)), sharey=True)
    ticks, labels = [], []
    for k, (projection, assignment) in enumerate(bars):
        for s, strength in enumerate(strengths):
            found = [r for r in study["rows"] if (r["projection"], r["assignment"], r["strength"]) ==
                     (projection, assignment, strength)]
            if not found:
                continue
            at = -(k * len(strengths) + s)
            left.barh(at, found[0]["largest_stable_step_s"], color=f"C{s}")
            right.barh(at, found[0]["passes_per_s"] or 0, color=f"C{s}")
            ticks.append(at)
            labels.append(" ".join(filter(None, (projection, assignment, strength if len(strengths) > 1 else ""))))
    left.set_yticks(ticks, labels, fontsize=6)
    for axes, label in ((left, "largest stable step [s]"), (right, f"passes over pairs per second, error {study['rows'][0]['target_error']:g}")):
        axes.set_xscale("log")
        axes.set_xlabel(label)
    return figure


def stability(study):
    resolutions = in_order(r["spacing_m"] for r in study["rows"])
    factors = in_order(r["factor"] for r in study["rows"])
    steps = in_order(r["step_factor"] for r in study["rows"])
    figure, grid = plt.subplots(1, len(resolutions), figsize=(3.6 * len(resolutions), 2.8), squeeze=False)
    for axes, dx in zip(grid.flat, resolutions):
        image = [[next(VERDICTS.index(r["verdict"]) for r in study["rows"] if
                       (r["spacing_m"], r["factor"], r["step_factor"]) == (dx, factor, step))
                  for factor in factors] for step in steps]
        axes.imshow(image, origin="lower", cmap=ListedColormap(["#d7301f", "#fdcc8a", "#74c476"]), vmin=0, vmax=2,
                    aspect="auto")
        axes.set_xticks(range(len(factors)), [f"{f:g}" for f in factors])
        axes.set_yticks(range(len(steps)), [f"{s:g}" for s in steps])
        axes.set_xlabel(study["rows"][0]["parameter"])
        axes.set_ylabel("step over the usual one")
        axes.set_title(f"dx = {dx:.3g} m", fontsize=8)
        axes.grid(False)
    figure.suptitle("green stable, yellow degraded, red failed", fontsize=8)
    return figure


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    data = Path(sys.argv[1])
    study = json.loads(data.read_text(encoding="utf-8"))
    if not study["rows"]:
        return 0
    draw = {"work-precision": work_precision, "splitting": splitting, "stability": stability}[study["study"]]
    figure = draw(study)
    figure.tight_layout()
    figure.savefig(data.with_suffix(".png"), bbox_inches="tight")
    return 0


if __name__ == "__main__":
    sys.exit(main())
