# plot_certificate.py: draws a shape's certificate from the CSV files that scree-shape inspect --plot writes beside it.
# Usage: python3 plot_certificate.py PICTURE TITLE   (PICTURE .png or .svg); needs Matplotlib
# SPDX-License-Identifier: Apache-2.0
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

NAMES = "xyz"
BAR = (0.93, 1.05)  # what |grad phi| is asked to keep to, 5th to 95th percentile


def read(stem, part):
    with open(f"{stem}-{part}.csv", newline="") as file:
        return list(csv.DictReader(file))


def numbers(rows, *columns):
    return np.array([[float(row[c]) for c in columns] for row in rows]).reshape(len(rows), len(columns))


def draw_slice(axes, slices, outline, axis):
    table = numbers([row for row in slices if row["axis"] == str(axis)], "u", "v", "phi")
    side = round(len(table) ** 0.5)
    u, v, phi = (table[:, k].reshape(side, side) for k in range(3))
    limit = np.abs(phi).max()
    image = axes.contourf(u, v, phi, np.linspace(-limit, limit, 25), cmap="RdBu_r")
    axes.contour(u, v, phi, [-0.05, 0.05], colors="black", linewidths=0.4, linestyles="dashed")
    cuts = numbers([row for row in outline if row["axis"] == str(axis)], "u0", "v0", "u1", "v1")
    if len(cuts):
        axes.add_collection(LineCollection(cuts.reshape(-1, 2, 2), colors="#2ca02c", linewidths=2.2))
    axes.contour(u, v, phi, [0], colors="black", linewidths=0.9)
    axes.set_aspect("equal")
    axes.set_xlabel(f"{NAMES[(axis + 1) % 3]} [d]")
    axes.set_ylabel(f"{NAMES[(axis + 2) % 3]} [d]")
    axes.set_title(f"{NAMES[axis]} = 0", fontsize=10)
    return image


def draw_slopes(axes, slope):
    low, high = np.percentile(slope, [5, 95])
    bins = np.linspace(min(slope.min(), 0.5), max(slope.max(), 1.5), 100)
    axes.hist(slope, bins, color="#1f77b4")
    axes.axvspan(*BAR, color="black", alpha=0.08, label=f"bar {BAR[0]} to {BAR[1]}")
    axes.axvline(low, color="#c1272d", linewidth=1, label=f"p5 {low:.3f}")
    axes.axvline(high, color="#c1272d", linewidth=1, linestyle="--", label=f"p95 {high:.3f}")
    axes.set_yscale("log")
    axes.set_xlabel(r"|grad phi| within 0.05 d of the surface")
    axes.set_ylabel("points")
    axes.legend(fontsize=8)


def draw_normals(axes, flat, edge):
    if len(flat) + len(edge) == 0:
        axes.text(0.5, 0.5, "no mesh was given:\nerrors of normals are not known", ha="center", va="center")
        axes.set_axis_off()
        return
    every = np.concatenate([flat, edge])
    axes.hist([flat, edge], np.linspace(0, max(5, every.max()), 60), stacked=True, color=["#1f77b4", "#e5a01a"],
              label=["farther than 0.03 d from sharp edges", "near sharp edges"])
    axes.axvline(np.percentile(every, 95), color="#c1272d", linewidth=1, label=f"p95 {np.percentile(every, 95):.2f}")
    if len(flat):
        axes.axvline(np.percentile(flat, 95), color="#c1272d", linewidth=1, linestyle="--",
                     label=f"p95 without edges {np.percentile(flat, 95):.2f}")
    axes.set_yscale("log")
    axes.set_xlabel("error of normals on the surface [degrees]")
    axes.legend(fontsize=8)


def main():
    picture, title = sys.argv[1:]
    stem = picture.rsplit(".", 1)[0]
    slices, outline, samples = (read(stem, part) for part in ("slices", "outline", "samples"))
    value = {kind: np.array([float(r["value"]) for r in samples if r["kind"] == kind]) for kind in ("slope", "flat", "edge")}
    figure = plt.figure(figsize=(13, 8.2), layout="constrained")
    top, bottom = figure.subfigures(2, 1, height_ratios=[1.25, 1])
    planes = top.subplots(1, 3)
    for axis, axes in zip((2, 1, 0), planes):
        image = draw_slice(axes, slices, outline, axis)
    top.colorbar(image, ax=planes, label="phi [d]", shrink=0.85)
    top.suptitle(title + "\nblack: phi = 0" + (", green: the mesh" if outline else "") + ", dashed: phi = ±0.05 d",
                 fontsize=10)
    left, right = bottom.subplots(1, 2)
    draw_slopes(left, value["slope"])
    draw_normals(right, value["flat"], value["edge"])
    figure.savefig(picture, dpi=100)


main()
