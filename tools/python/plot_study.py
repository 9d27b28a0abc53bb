# plot_study.py: draws a study of scree-train from its CSV files; what the reference paper's text gives is marked "paper".
# Usage: python3 plot_study.py STUDY FOLDER   writes FOLDER/STUDY.png and .svg; needs Matplotlib, t-SNE also scikit-learn
# SPDX-License-Identifier: Apache-2.0
import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import LogNorm

CATEGORY_COLOUR = {"ballast": "#8c564b", "cobble": "#1f77b4", "ellipsoid": "#2ca02c", "sand": "#e5a01a"}
RECIPE_STYLE = {"paper": dict(color="#888888", linestyle="--"), "ours": dict(color="#c1272d", linestyle="-")}
RECIPE_LABEL = {"paper": "paper's recipe, run here", "ours": "ours"}
PAPER = dict(color="black", linestyle=":", linewidth=1.2)


def read(folder, name):
    with open(os.path.join(folder, name + ".csv"), newline="") as file:
        return list(csv.DictReader(file))


def unique(rows, column):
    return list(dict.fromkeys(row[column] for row in rows))


def numbers(rows, column):
    return np.array([float(row[column]) for row in rows])


def select(rows, **wanted):
    return [row for row in rows if all(row[k] == v for k, v in wanted.items())]


def category(shape):
    return shape.split("/")[0]


def read_stl(path):
    with open(path, "rb") as file:
        file.seek(80)
        count = int(np.frombuffer(file.read(4), "<u4")[0])
        facet = np.dtype([("normal", "<f4", 3), ("vertex", "<f4", (3, 3)), ("attribute", "<u2")])
        return np.frombuffer(file.read(), facet, count)["vertex"].astype(float)


def draw_mesh(axes, folder, name, colour="#b8a88a", half=0.85):
    """A mesh in parallel projection from a fixed side, shaded, nearest triangles last."""
    axes.set_aspect("equal")
    axes.set_xlim(-half, half)
    axes.set_ylim(-half, half)
    axes.set_xticks([])
    axes.set_yticks([])
    for side in axes.spines.values():
        side.set_visible(False)
    corners = read_stl(os.path.join(folder, name))
    if len(corners) == 0:
        axes.text(0, 0, "no solid", ha="center", va="center")
        return
    towards = np.array([0.45, -0.75, 0.48]) / np.linalg.norm([0.45, -0.75, 0.48])
    right = np.cross([0, 0, 1], towards)
    right /= np.linalg.norm(right)
    up = np.cross(towards, right)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    front = normal @ towards > 0
    corners, normal = corners[front], normal[front]
    order = np.argsort(corners.mean(axis=1) @ towards)
    light = 0.35 + 0.65 * np.clip(normal @ (towards + 0.5 * up - 0.4 * right) / 1.19, 0, 1)
    flat = np.stack([corners @ right, corners @ up], axis=2)[order]
    half = max(half, 1.05 * np.abs(flat).max())  # long bodies are drawn smaller
    axes.set_xlim(-half, half)
    axes.set_ylim(-half, half)
    shade = np.clip(light[order, None] * np.array(matplotlib.colors.to_rgb(colour)), 0, 1)
    axes.add_collection(PolyCollection(flat, facecolors=shade, edgecolors=shade, linewidths=0.3, rasterized=True))


def convergence(folder, study):
    rows = read(folder, study)
    shapes = unique(rows, "shape")
    published = {"convergence": {"ballast": 74, "sand": 92}, "coded-convergence": dict.fromkeys(CATEGORY_COLOUR, 200)}
    figure, grid = plt.subplots(1, len(shapes), figsize=(4 * len(shapes), 3.6), sharey=True, squeeze=False,
                                layout="constrained")
    for axes, shape in zip(grid[0], shapes):
        for recipe in unique(rows, "recipe"):
            part = select(rows, shape=shape, recipe=recipe)
            style = RECIPE_STYLE[recipe]
            epoch = numbers(part, "epoch")
            axes.semilogy(epoch, numbers(part, "test_mae"), label="test, " + RECIPE_LABEL[recipe], **style)
            axes.semilogy(epoch, numbers(part, "train_mae"), color=style["color"], linewidth=0.6, alpha=0.8,
                          label="training, " + RECIPE_LABEL[recipe])
            kept = [row for row in part if row["kept"] == "1"]
            axes.plot(numbers(kept, "epoch"), numbers(kept, "test_mae"), "o", color=style["color"])
            axes.annotate(kept[0]["epoch"], (float(kept[0]["epoch"]), float(kept[0]["test_mae"])), (0, -14),
                          textcoords="offset points", ha="center", fontsize=8)
        if category(shape) in published[study]:
            best = published[study][category(shape)]
            what = "plateau near" if study == "coded-convergence" else "best epoch"
            axes.axvline(best, label=f"paper: {what} {best}", **PAPER)
        axes.set_title(shape)
        axes.set_xlabel("epoch")
        axes.grid(alpha=0.3)
        axes.legend(fontsize=7)
    grid[0][0].set_ylabel("mean absolute error [d]")
    figure.suptitle("Error by epoch; dots: the state that is kept")
    return figure


def heat_map(axes, table, x_labels, y_labels, norm, origin="lower"):
    image = axes.imshow(table, origin=origin, cmap="YlOrRd", norm=norm)
    axes.set_xticks(range(len(x_labels)), x_labels)
    axes.set_yticks(range(len(y_labels)), y_labels)
    for (i, j), value in np.ndenumerate(table):
        if np.isfinite(value):
            dark = norm(value) > 0.6
            axes.text(j, i, f"{1e3 * value:.2f}", ha="center", va="center", fontsize=7, color="white" if dark else "black")
    return image


def superellipsoids(folder, study):
    rows = read(folder, study)
    recipes, exponents = unique(rows, "recipe"), unique(rows, "exponent")
    ratios = sorted(set(unique(rows, "elongation")), key=float)
    mae = numbers(rows, "mae")
    norm = LogNorm(mae.min(), mae.max())
    figure, grid = plt.subplots(len(recipes), len(exponents), figsize=(16, 3.5 * len(recipes)), squeeze=False,
                                layout="constrained")
    for line, recipe in zip(grid, recipes):
        part = numbers(select(rows, recipe=recipe), "mae")
        for axes, exponent in zip(line, exponents):
            table = np.full((len(ratios), len(ratios)), np.nan)
            for row in select(rows, recipe=recipe, exponent=exponent):
                table[ratios.index(row["elongation"]), ratios.index(row["flatness"])] = float(row["mae"])
            image = heat_map(axes, table, ratios, ratios, norm)
            axes.set_title(f"{RECIPE_LABEL[recipe]}, exponent {exponent}", fontsize=9)
            axes.set_xlabel("flatness FI = c/b")
        line[0].set_ylabel(f"elongation EI = b/a\n(all: mean {part.mean():.1e}, worst {part.max():.1e} d)")
    figure.colorbar(image, ax=grid, label="mean absolute error [d]; cells: [1e-3 d]", shrink=0.8)
    figure.suptitle("One network for each superellipsoid; paper: of order 1e-3 d")
    return figure


def scatter(folder, study):
    rows, points = read(folder, study), read(folder, study + "-points")
    shapes, recipes = unique(rows, "shape"), unique(rows, "recipe")
    figure, grid = plt.subplots(len(recipes) + 2, len(shapes), figsize=(3.4 * len(shapes), 3 * (len(recipes) + 2)),
                                squeeze=False, layout="constrained")
    for column, shape in zip(grid.T, shapes):
        colour = CATEGORY_COLOUR.get(category(shape), "#b8a88a")
        first = select(rows, shape=shape)
        draw_mesh(column[0], folder, first[0]["true_mesh"], colour)
        column[0].set_title(shape + "\ntruth")
        for axes, row in zip(column[1:], first):
            draw_mesh(axes, folder, row["net_mesh"], colour)
            axes.set_title(f"{RECIPE_LABEL[row['recipe']]}\nMAE {float(row['mae']):.1e}, max {float(row['max']):.1e} d", fontsize=9)
        axes = column[-1]
        for recipe in recipes:
            part = select(points, shape=shape, recipe=recipe)
            axes.plot(numbers(part, "true_phi"), numbers(part, "net_phi"), ".", markersize=3,
                      color=RECIPE_STYLE[recipe]["color"], label=RECIPE_LABEL[recipe])
        ends = [numbers(part, "true_phi").min(), numbers(part, "true_phi").max()]
        axes.plot(ends, ends, color="black", linewidth=0.6)
        axes.set_xlabel("true distance [d]")
        axes.grid(alpha=0.3)
        axes.legend(fontsize=7)
    grid[-1][0].set_ylabel("network [d]")
    figure.suptitle("Surfaces, and predicted against true signed distance; paper: MAE of order 1e-3 d")
    return figure


def coded_grains(folder, study):
    rows = read(folder, study)
    recipes = unique(rows, "recipe")
    kinds = list(CATEGORY_COLOUR)
    mae = numbers(rows, "mae")
    norm = LogNorm(min(mae.min(), 1e-4), max(mae.max(), 0.05))
    figure, grid = plt.subplots(1, len(recipes), figsize=(6 * len(recipes), 4), squeeze=False, layout="constrained")
    for axes, recipe in zip(grid[0], recipes):
        table = np.full((4, 5), np.nan)
        for row in select(rows, recipe=recipe):
            kind, index = row["shape"].split("/")
            table[kinds.index(kind), int(index)] = float(row["mae"])
        image = heat_map(axes, table, range(5), kinds, norm, "upper")
        axes.set_title(f"{RECIPE_LABEL[recipe]}: mean {np.nanmean(table):.1e}, worst {np.nanmax(table):.1e} d")
        axes.set_xlabel("shape")
    bar = figure.colorbar(image, ax=grid, label="mean absolute error [d]; cells: [1e-3 d]")
    for level in (0.01, 0.05):
        bar.ax.axhline(level, color="blue", linewidth=2)
    figure.suptitle("20 grains in one decoder; paper: mostly 0.01 to 0.05 d (blue on the bar), angular ones above 0.04 d")
    return figure


def templates(folder, study):
    rows = read(folder, study)
    super_rows = [row for row in rows if category(row["shape"]) == "superellipsoid"]
    grains = [row for row in rows if category(row["shape"]) != "superellipsoid"]
    figure, grid = plt.subplots(7, 5, figsize=(11, 15.5), layout="constrained")
    for i, row in enumerate(super_rows):
        draw_mesh(grid[i % 3][i // 3], folder, row["mesh"], "#9ab0c4")
        exponent, ei, fi = row["shape"].split("/")[1].split("-")
        grid[i % 3][i // 3].set_title(f"exponent {exponent[1:]}, EI {ei[2:]}, FI {fi[2:]}", fontsize=8)
    for i, row in enumerate(grains):
        draw_mesh(grid[3 + i // 5][i % 5], folder, row["mesh"], CATEGORY_COLOUR[category(row["shape"])])
        text = "\nsphericity {sphericity:.2f}, convexity {convexity:.2f}"
        text = text.format(sphericity=float(row["sphericity"]), convexity=float(row["convexity"]))
        grid[3 + i // 5][i % 5].set_title(row["shape"] + text, fontsize=8)
    figure.suptitle("Benchmark shapes, equal volumes: superellipsoids (15 of 125) and grains")
    return figure


def interpolation(folder, study):
    rows = read(folder, study)
    pairs = list(dict.fromkeys((row["from"], row["to"]) for row in rows))
    positions = unique(rows, "position")
    figure, grid = plt.subplots(len(pairs), len(positions), figsize=(2 * len(positions), 2.3 * len(pairs)), squeeze=False,
                                layout="constrained")
    for line, (start, end) in zip(grid, pairs):
        a, b = (np.array(matplotlib.colors.to_rgb(CATEGORY_COLOUR[category(s)])) for s in (start, end))
        for axes, row in zip(line, select(rows, **{"from": start, "to": end})):
            t = float(row["position"])
            draw_mesh(axes, folder, row["mesh"], (1 - t) * a + t * b)
            text = {0: start, 1: end}.get(t, f"{t:.2f}")
            axes.set_title(f"{text}\nS {float(row['sphericity']):.2f}, C {float(row['convexity']):.2f}", fontsize=8)
    figure.suptitle("Shapes on the line between two codes; S: sphericity, C: convexity")
    return figure


def plane_of(codes):
    """Codes in two dimensions, and by what."""
    try:
        from sklearn.manifold import TSNE
    except ImportError:
        centred = codes - codes.mean(axis=0)
        return centred @ np.linalg.svd(centred, full_matrices=False)[2][:2].T, "principal components (no scikit-learn)"
    perplexity = min(15, (len(codes) - 1) / 3)
    return TSNE(2, perplexity=perplexity, init="pca", learning_rate="auto", random_state=1).fit_transform(codes), "t-SNE"


def latent(folder, study):
    rows = read(folder, study)
    codes = np.stack([numbers(rows, name) for name in rows[0] if name.startswith("z") and name[1:].isdigit()], axis=1)
    place, method = plane_of(codes)
    figure = plt.figure(figsize=(15, 7), layout="constrained")
    left, right = figure.subfigures(1, 2)
    axes = left.subplots()
    for name, colour in CATEGORY_COLOUR.items():
        for kind, marker, size in (("trained", "o", 60), ("drawn", "x", 20)):
            at = [i for i, row in enumerate(rows) if row["category"] == name and row["kind"] == kind]
            axes.scatter(place[at, 0], place[at, 1], s=size, marker=marker, color=colour, label=f"{name}, {kind}")
    axes.set_title(f"{codes.shape[1]} latent numbers in two dimensions: {method}")
    axes.set_xlabel("first coordinate [-]")
    axes.set_ylabel("second coordinate [-]")
    axes.legend(fontsize=8)
    grid = right.subplots(4, 4)
    for line, name in zip(grid, CATEGORY_COLOUR):
        drawn = [row for row in rows if row["category"] == name and row["kind"] == "drawn" and row["mesh"]]
        for cell, row in zip(line, drawn):
            draw_mesh(cell, folder, row["mesh"], CATEGORY_COLOUR[name])
            cell.set_title(f"{row['name']}: S {float(row['sphericity']):.2f}", fontsize=8)
    right.suptitle("Drawn from each category's Gaussian, within 2 standard deviations; S: sphericity")
    return figure


SWEEPS = {  # axis label; the range that the paper's text finds enough, by model
    "samples": ("training samples a shape", {"single": (5000, 10000)}),
    "layers": ("hidden layers", {"single": (5, 6), "coded": (4, 5)}),
    "nodes": ("neurons a layer", {"single": (30, 50), "coded": (30, 50)}),
    "latent-size": ("latent numbers", {"coded": (8, 12)}),
}


def sweep(folder, study):
    rows = read(folder, study)
    column = study.replace("-", "_")
    label, enough = SWEEPS[study]
    models = unique(rows, "model")
    figure, grid = plt.subplots(1, len(models), figsize=(7 * len(models), 4.5), sharey=True, squeeze=False,
                                layout="constrained")
    for axes, model in zip(grid[0], models):
        for shape in unique(rows, "shape"):
            for recipe in unique(rows, "recipe"):
                part = select(rows, model=model, shape=shape, recipe=recipe)
                axes.plot(numbers(part, column), numbers(part, "mae"), marker="o", markersize=3,
                          color=CATEGORY_COLOUR[category(shape)], linestyle=RECIPE_STYLE[recipe]["linestyle"],
                          label=f"{shape}, {RECIPE_LABEL[recipe]}")
        low, high = enough[model]
        axes.axvspan(low, high, color="black", alpha=0.08, label=f"paper: {low} to {high} are enough")
        if study == "latent-size":
            axes.fill_between([8, 12], 3e-3, 4e-3, color=CATEGORY_COLOUR["ballast"], alpha=0.5, label="paper: ballast")
        axes.set_yscale("log")
        if study == "samples":
            axes.set_xscale("log")
        axes.set_xlabel(label)
        axes.set_title({"single": "SingleNetSDF: a network a shape", "coded": "CodedNetSDF: one decoder, four shapes"}[model])
        axes.grid(alpha=0.3, which="both")
    grid[0][0].set_ylabel("mean absolute error [d]")
    grid[0][-1].legend(fontsize=7, loc="center left", bbox_to_anchor=(1.01, 0.5))
    return figure


def bars(folder, study):
    rows = read(folder, study)
    value, label = {"query-time": ("seconds_per_million", "time of a million distances, one thread [s]"),
                    "memory": ("kilobytes", "memory a grain [kB]")}[study]
    ours = numbers(rows, value)
    paper = np.array([float(row["paper"] or "nan") for row in rows]) * (ours[0] if study == "query-time" else 1)
    figure, axes = plt.subplots(figsize=(9, 0.6 * len(rows) + 1.5), layout="constrained")
    place = np.arange(len(rows))
    axes.barh(place, ours, height=0.6, color="#c1272d", label="here")
    text = "paper's ratio to Trimesh (of our Trimesh)" if study == "query-time" else "paper"
    axes.plot(paper, place, linestyle="none", marker="|", markersize=22, markeredgewidth=2, color="black", label=text)
    for y, number in zip(place, ours):
        axes.text(number, y, f" {number:.3g}", va="center", fontsize=8)
    axes.set_yticks(place, [f"{row['method']}\n{row['detail']}" for row in rows], fontsize=8)
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.set_xlabel(label)
    axes.margins(x=0.15)
    axes.legend(fontsize=8, ncols=2, loc="lower right", bbox_to_anchor=(1, 1))
    axes.grid(alpha=0.3, axis="x")
    return figure


DRAW = {"templates": templates, "convergence": convergence, "superellipsoids": superellipsoids,
        "single-scatter": scatter, "coded-convergence": convergence, "extremes": scatter, "coded-scatter": scatter,
        "coded-grains": coded_grains, "interpolation": interpolation, "latent": latent, "samples": sweep,
        "layers": sweep, "nodes": sweep, "latent-size": sweep, "query-time": bars, "memory": bars}


def main():
    study, folder = sys.argv[1:]
    figure = DRAW[study](folder, study)
    figure.savefig(os.path.join(folder, study + ".png"), dpi=80)
    figure.savefig(os.path.join(folder, study + ".svg"))
    plt.close(figure)


main()
