# plot_energy.py: draws an energy ledger over time: what is stored, every source and sink, the residual below.
# Usage: python3 plot_energy.py LEDGER.csv PICTURE TITLE   (PICTURE .png or .svg); needs Matplotlib
# SPDX-License-Identifier: Apache-2.0
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# column of the ledger: name, colour; a ledger has the columns of the effects its case has
STORES = {
    "kinetic": ("kinetic", "#1f77b4"),
    "potential": ("potential, less its start", "#8c564b"),
    "elastic_normal": ("elastic, normal", "#2ca02c"),
    "elastic_tangential": ("elastic, tangential", "#98df8a"),
    "elastic_rolling": ("elastic, rolling", "#bcbd22"),
}
SOURCES = {
    "wall_work": ("work of moving walls", "#1f77b4"),
    "applied": ("applied forces", "#17becf"),
    "inserted": ("inserted grains", "#2ca02c"),
}
SINKS = {
    "damping": ("contact damping", "#d62728"),
    "friction": ("friction", "#ff7f0e"),
    "rolling": ("rolling resistance", "#bcbd22"),
    "global_damping": ("global damping", "#9467bd"),
    "drag": ("drag", "#e377c2"),
    "deleted": ("deleted grains", "#7f7f7f"),
    "removed": ("numerical removals", "#000000"),
}


def read(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def draw(axes, ledger, entries, style, prefix=""):
    time = ledger["time"]
    for column, (name, colour) in entries.items():
        if column not in ledger:
            continue
        value = ledger[column] - (ledger[column][0] if column == "potential" else 0)
        axes.plot(time, value, style, color=colour, linewidth=1.4, label=f"{prefix}{name} {value[-1]:.3g}")


def decorate(axes, label, title=None):
    axes.set_ylabel(label)
    axes.axhline(0, color="black", linewidth=0.5)
    axes.grid(alpha=0.25)
    axes.ticklabel_format(axis="y", scilimits=(-3, 4))
    if title:
        axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.005, 0.5), title=title, title_fontsize=8)


def main():
    table, picture, title = sys.argv[1:]
    ledger = read(table)
    time, moved = ledger["time"], ledger["moved"]
    figure, (stored, moving, residual) = plt.subplots(
        3, 1, sharex=True, figsize=(11, 9), height_ratios=[1, 1, 0.55], layout="constrained"
    )
    draw(stored, ledger, STORES, "-")
    decorate(stored, "stored [J]", "stored, at the end [J]")
    draw(moving, ledger, SOURCES, "--", "in: ")
    draw(moving, ledger, SINKS, "-", "out: ")
    decorate(moving, "since the start [J]", "sources and sinks, at the end [J]")
    residual.plot(time, ledger["residual"], color="#c1272d", linewidth=1.4)
    share = np.abs(ledger["residual"][moved > 0] / moved[moved > 0])
    decorate(residual, "residual [J]")
    residual.set_xlabel("time [s]")
    residual.set_title(
        f"what the ledger cannot account for: at most {share.max() if len(share) else 0:.1e} of the energy moved so far",
        fontsize=9,
    )
    residual.set_xlim(time[0], time[-1])
    figure.suptitle(f"energy ledger of {title}", fontsize=11)
    figure.savefig(picture, dpi=100)


main()
