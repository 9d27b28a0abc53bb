# plot_envelopes.py: draws the tables of scree envelopes: run-out, energies at screens, speeds; and the map of each group.
# Usage: python3 plot_envelopes.py FOLDER   writes FOLDER/envelopes.png and FOLDER/plan.png; needs Matplotlib
# SPDX-License-Identifier: Apache-2.0
import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

COLOURS = ["#2ca02c", "#1f77b4", "#c1272d", "#e5a01a", "#8c564b", "#7f5fa8"]


def read(folder, name):
    with open(os.path.join(folder, name + ".csv"), newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def column(rows, name):
    return np.array([float(row[name]) for row in rows])


def of_group(rows, group):
    return [row for row in rows if row["group"] == group]


def draw_run_out(axes, rows, groups):
    share = axes.twinx()
    for i, group in enumerate(groups):
        part = of_group(rows, group)
        colour = COLOURS[i % len(COLOURS)]
        start, end = column(part, "from"), column(part, "to")
        width = (end - start) / len(groups)
        stopped, left = column(part, "stopped"), column(part, "left")
        axes.bar(start + (i + 0.5) * width, stopped, width, color=colour, label=group)
        axes.bar(start + (i + 0.5) * width, left, width, bottom=stopped, color="none", edgecolor=colour, hatch="/////")
        share.plot(np.append(start, end[-1]), np.append(column(part, "beyond"), 0), color=colour, linewidth=1)
    share.set_ylim(0, 1.4)
    share.set_yticks(np.linspace(0, 1, 6))
    share.set_ylabel("share that came farther (lines)")
    axes.set_ylim(0, 1.4 * axes.get_ylim()[1])
    axes.set_xlabel("run-out [m]")
    axes.set_ylabel("grains (bars)")
    axes.legend(fontsize=8, title="full: stopped, hatched: left", title_fontsize=8, loc="upper left")


def draw_spreads(axes, rows, groups, across, with_low):
    for i, group in enumerate(groups):
        part = of_group(rows, group)
        if not part:  # no screen was reached
            continue
        colour = COLOURS[i % len(COLOURS)]
        x = column(part, across)
        axes.plot(x, column(part, "mean"), color=colour, linewidth=2, label=group)
        axes.plot(x, column(part, "p95"), color=colour, linewidth=0.8, linestyle="--")
        axes.plot(x, column(part, "max"), color=colour, linewidth=0.8, linestyle=":")
        if with_low:
            axes.fill_between(x, column(part, "p5"), column(part, "p95"), color=colour, alpha=0.08, linewidth=0)
    axes.set_ylim(bottom=0)
    axes.grid(alpha=0.3)
    title = "mean; dashed: 95 %, dotted: largest" + (", shade: from 5 %" if with_low else "")
    axes.legend(fontsize=8, title=title, title_fontsize=8, loc="upper right")


def draw_envelopes(folder, summary):
    groups = [row["group"] for row in summary]
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(17, 5), layout="constrained")
    draw_run_out(left, read(folder, "run_out"), groups)
    draw_spreads(middle, read(folder, "screens"), groups, "along", False)
    middle.set_xlabel("position of the screen along the direction [m]")
    middle.set_ylabel("kinetic energy per mass at first passage [J/kg]")
    draw_spreads(right, read(folder, "velocity"), groups, "time", True)
    right.set_xlabel("time since release [s]")
    right.set_ylabel("speed [m/s]")
    figure.suptitle("; ".join("{group}: {grains} grains in {replicas} replicas".format(**row) for row in summary))
    figure.savefig(os.path.join(folder, "envelopes.png"), dpi=80)
    plt.close(figure)


def draw_plan(folder, summary):
    rows = read(folder, "plan")
    along, across, passed = (column(rows, name) for name in ("along", "across", "passed"))
    steps = [np.diff(np.unique(values)) for values in (along, across)]
    cell = min((step.min() for step in steps if len(step)), default=1.0)
    x, y = (np.arange(values.min() - cell / 2, values.max() + cell, cell) for values in (along, across))
    columns = min(3, len(summary))
    lines = -(-len(summary) // columns)
    width = 5.5  # of a panel
    height = np.clip(width * (y[-1] - y[0]) / (x[-1] - x[0]), 1.5, 12)
    figure, grid = plt.subplots(lines, columns, figsize=(width * columns + 1, (height + 1) * lines), sharex=True,
                                sharey=True, squeeze=False, layout="constrained")
    for axes in grid.flat[len(summary):]:
        axes.set_axis_off()
    for axes, row in zip(grid.flat, summary):
        part = of_group(rows, row["group"])
        u, v = column(part, "along"), column(part, "across")
        table = np.full((len(y) - 1, len(x) - 1), np.nan)
        i, j = (np.rint((values - start[0]) / cell - 0.5).astype(int) for values, start in ((u, x), (v, y)))
        table[j, i] = column(part, "passed")
        image = axes.pcolormesh(x, y, table, cmap="YlOrRd", vmin=0, vmax=passed.max())
        for name, marker, colour in (("stopped", "o", "black"), ("left", ">", "#1f4fa0")):
            count = column(part, name)
            axes.scatter(u[count > 0], v[count > 0], s=8 * count[count > 0], marker=marker, color=colour, label=name)
        axes.set_aspect("equal")
        axes.set_title("{group}: {stopped} stopped, {moving} moving, {left} left\nsideways spread ".format(**row) +
                       f"{float(row['sideways_spread']):.3g} m", fontsize=10)
        axes.set_xlabel("position along the direction [m]")
    grid[0, 0].legend(fontsize=8, loc="upper left", title="marks by number", title_fontsize=8)
    for axes in grid[:, 0]:
        axes.set_ylabel("position to the left [m]")
    figure.colorbar(image, ax=grid, label="grains that passed the cell")
    figure.savefig(os.path.join(folder, "plan.png"), dpi=80)
    plt.close(figure)


def main():
    (folder,) = sys.argv[1:]
    summary = [row for row in read(folder, "groups") if int(row["grains"]) > 0]
    draw_envelopes(folder, summary)
    draw_plan(folder, summary)


main()
