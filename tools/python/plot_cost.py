# plot_cost.py: draws what `scree cost` measured: error against time, and error against the time step.
# Usage: python3 plot_cost.py FOLDER   writes FOLDER/cost.png and .svg; needs Matplotlib
# SPDX-License-Identifier: Apache-2.0
import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

COLOUR = {"formula": "#000000", "mesh": "#8c564b", "grid": "#1f77b4"}
NETS = ["#c1272d", "#ff7f0e", "#9467bd", "#2ca02c"]  # the shipped one, others
MARKER = {"22": "v", "43": "s", "86": "^"}


NET_COLOUR = {}


def read(folder, name):
    with open(os.path.join(folder, name), newline="") as file:
        return list(csv.DictReader(file))


def style(evaluator):
    kind, _, size = evaluator.partition(" ")
    if kind == "net":
        NET_COLOUR.setdefault(evaluator, NETS[len(NET_COLOUR) % len(NETS)])
    return dict(color=NET_COLOUR.get(evaluator) or COLOUR[kind], marker=MARKER.get(size, "o"), markersize=5)


def front(points):
    """Of (time, error) those that no other one beats, by time."""
    best, kept = float("inf"), []
    for time, error in sorted(points):
        if error < best:
            best = error
            kept.append((time, error))
    return kept


def price(axes, rows):
    points = []
    for name in dict.fromkeys(row["evaluator"] for row in rows):
        part = [row for row in rows if row["evaluator"] == name]
        time, error = [float(r["rest_us"]) for r in part], [float(r["force_error"]) for r in part]
        axes.loglog(time, error, label=name, linewidth=0.8, **style(name))
        points += zip(time, error)
    kept = front(points)
    axes.loglog(*zip(*kept), color="#7fbf3f", linewidth=6, alpha=0.4, zorder=0, label="nothing beats these")
    for row in rows:
        if (float(row["rest_us"]), float(row["force_error"])) in kept or row["evaluator"] == rows[-1]["evaluator"]:
            axes.annotate(row["nodes"], (float(row["rest_us"]), float(row["force_error"])), (4, 4),
                          textcoords="offset points", fontsize=7)
    axes.set_xlabel("µs a particle and step, heap at rest, one thread")
    axes.set_ylabel("error of contact forces")
    axes.set_title("whole step; numbers: nodes a grain", fontsize=9)


def single(axes, rows):
    for row in rows:
        if float(row["normal_mean_deg"]) > 1e-4:  # the formula has none
            axes.loglog(float(row["phi_ns"]), float(row["normal_mean_deg"]), label=row["evaluator"], linestyle="",
                        **style(row["evaluator"]))
    formula = [float(row["phi_ns"]) for row in rows if row["evaluator"] == "formula"]
    if formula:
        axes.axvline(formula[0], color=COLOUR["formula"], linewidth=0.8, label="formula: exact")
    axes.set_xlabel("ns a query, one thread")
    axes.set_ylabel("mean error of normals [degrees]")
    axes.set_title("single queries", fontsize=9)


def steps(axes, rows):
    last = [row for row in rows if row["evaluator"] == rows[-1]["evaluator"]]
    for nodes in dict.fromkeys(row["nodes"] for row in last):
        part = [r for r in last if r["nodes"] == nodes and r["energy_drift"] != "stopped"]
        step = [float(r["step_auto"]) for r in part]
        line = axes.loglog(step, [float(r["energy_drift"]) for r in part], "o-", markersize=4, linewidth=0.8,
                           label=f"{nodes} nodes: energy")[0]
        way = [(s, float(r["trajectory_d"])) for s, r in zip(step, part) if float(r["trajectory_d"]) > 0]
        if way:
            axes.loglog(*zip(*way), "x--", markersize=4, linewidth=0.8, color=line.get_color(),
                        label=f"{nodes} nodes: way [d]")
    axes.set_xlabel("time step, in automatic ones")
    axes.set_ylabel("change of energy, error of the way")
    axes.set_title(f"collisions of pairs, {rows[-1]['evaluator']}", fontsize=9)


def main():
    folder = sys.argv[1]
    style(read(folder, "cost.csv")[-1]["evaluator"])  # the shipped network comes last and has the first colour
    figure, axes = plt.subplots(1, 3, figsize=(15, 5), width_ratios=[1.5, 1, 1], layout="constrained")
    price(axes[0], read(folder, "cost.csv"))
    single(axes[1], read(folder, "queries.csv"))
    steps(axes[2], read(folder, "collisions.csv"))
    for a in axes:
        a.grid(alpha=0.3, which="both")
        a.legend(fontsize=7)
    for end in ("png", "svg"):
        figure.savefig(os.path.join(folder, "cost." + end), dpi=100)


main()
