# plot_book.py: the page of plots of `scree validate`, from the validation.csv and curves.csv it wrote.
# Usage: python3 plot_book.py FOLDER   writes FOLDER/validation.html and FOLDER/plots/*.png; needs Matplotlib
# SPDX-License-Identifier: Apache-2.0
import csv
import html
import math
import os
import re
import shutil
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

PASS, FAIL, TREND = "#2a7f3f", "#c1272d", "#888888"
PER_PICTURE = 80  # figures in one picture of margins
LEAST = 1e-6  # shown of a share of the tolerance: below, it is round-off


def read(folder, name):
    with open(os.path.join(folder, name), newline="") as file:
        return list(csv.DictReader(file))


def groups(rows, *columns):
    out = {}
    for row in rows:
        out.setdefault(tuple(row[c] for c in columns), []).append(row)
    return out


def share_of_tolerance(row):
    """Error over what is allowed: 1 is the limit. None: reported only."""
    expected, measured, tolerance = (float(row[c]) for c in ("expected", "measured", "tolerance"))
    if row["bound"] == "trend":
        return None
    if not math.isfinite(measured):
        return math.inf
    if row["bound"] == "at_most":
        error, allowed = measured, expected
    elif row["bound"] == "at_least":
        error, allowed = expected, measured
    else:
        error = abs(measured - expected)
        allowed = tolerance * (abs(expected) if row["bound"] == "relative" else 1)
    if allowed > 0:
        return max(error, 0) / allowed
    return 0 if row["passed"] == "1" else math.inf


def draw_margins(rows, path):
    """Every figure's error as a share of what is allowed."""
    figure, axes = plt.subplots(figsize=(14, 1.2 + 0.17 * len(rows)), layout="constrained")
    for at, row in enumerate(rows):
        share = share_of_tolerance(row)
        colour = TREND if share is None else PASS if row["passed"] == "1" else FAIL
        shown = LEAST if share is None else min(max(share, LEAST), 100)
        axes.plot([LEAST, shown], [at, at], color=colour, linewidth=1.2)
        axes.plot(shown, at, ">" if share is not None and share > 100 else "o", color=colour, markersize=3)
    entry = [(row["part"], row["id"]) for row in rows]
    starts = [i for i in range(len(rows)) if i == 0 or entry[i] != entry[i - 1]]
    for start in starts:
        axes.axhline(start - 0.5, color="black", linewidth=0.3)
    axes.axvline(1, color="black", linewidth=1)
    axes.set_xscale("log")
    axes.set_xlim(LEAST, 200)
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.set_yticks(range(len(rows)), [f"{r['figure'][:95]}   {r['id'][:24]}" for r in rows], fontsize=6)
    axes.tick_params(axis="x", labeltop=True, top=True)
    axes.grid(axis="x", alpha=0.3)
    axes.set_xlabel("error / what is allowed (1: the limit; grey: reported only)")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_curves(curves, path):
    """The curves of one entry, measured on expected."""
    across = min(2, len(curves))
    down = -(-len(curves) // across)
    figure, grid = plt.subplots(down, across, figsize=(5.6 * across, 3.8 * down), squeeze=False, layout="constrained")
    for axes, (title, points) in zip(grid.flat, curves.items()):
        x, expected, measured = ([float(p[c]) for p in points] for c in ("x", "expected", "measured"))
        if any(map(math.isfinite, expected)):
            axes.plot(x, expected, color="black", linewidth=1.2, label="expected")
        axes.plot(x, measured, "o", color="#c1272d", markersize=3, markerfacecolor="none", label="measured")
        y_label, _, rest = title.partition(" against ")
        x_label, _, case = rest.partition(", ")
        if len(case) > 0:
            axes.set_title(case, fontsize=9)
        axes.set_ylabel(y_label)
        axes.set_xlabel(x_label)
        axes.locator_params(axis="x", nbins=6)
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    for axes in list(grid.flat)[len(curves):]:
        axes.set_visible(False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def allowed(row):
    expected, tolerance = float(row["expected"]), float(row["tolerance"])
    return {
        "relative": f"{expected:.6g} &plusmn; {100 * tolerance:.3g} %",
        "absolute": f"{expected:.6g} &plusmn; {tolerance:.3g}",
        "at_most": f"&le; {expected:.6g}",
        "at_least": f"&ge; {expected:.6g}",
        "trend": "reported only",
    }[row["bound"]]


def table(rows):
    lines = ["<table><tr><th>figure</th><th>unit</th><th>expected</th><th>measured</th><th></th></tr>"]
    for row in rows:
        verdict = "" if row["bound"] == "trend" else "pass" if row["passed"] == "1" else "FAIL"
        lines.append(f"<tr><td>{html.escape(row['figure'])}</td><td>{html.escape(row['unit'])}</td>"
                     f"<td>{allowed(row)}</td><td>{float(row['measured']):.6g}</td><td class='{verdict}'>{verdict}</td></tr>")
    return "\n".join(lines + ["</table>"])


def main(folder):
    rows, curves = read(folder, "validation.csv"), groups(read(folder, "curves.csv"), "part", "id")
    plots = os.path.join(folder, "plots")
    shutil.rmtree(plots, ignore_errors=True)
    os.makedirs(plots)
    margins = []
    for start in range(0, len(rows), PER_PICTURE):
        margins.append(f"margins-{start // PER_PICTURE + 1}.png")
        draw_margins(rows[start:start + PER_PICTURE], os.path.join(plots, margins[-1]))
    bad = sum(row["passed"] != "1" for row in rows)
    page = ["<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'><title>Scree: validation book</title><style>",
            "body { font-family: sans-serif; max-width: 72em; margin: 2em auto; padding: 0 1em } img { max-width: 100% }",
            "table { border-collapse: collapse; font-size: 85% } td, th { border-bottom: 1px solid #ddd; padding: 2px 10px;",
            f"text-align: left }} .pass {{ color: {PASS} }} .FAIL {{ color: {FAIL}; font-weight: bold }}</style></head><body>",
            f"<h1>Scree: validation book</h1><p>{len(rows)} figures, {bad} outside.</p>"]
    for (part, id_, title), entry in groups(rows, "part", "id", "title").items():
        page.append(f"<h2>{html.escape(f'{part} {id_}: {title}')}</h2>"
                    f"<p>{html.escape(entry[0]['source'])}; {float(entry[0]['seconds']):.1f} s</p>")
        page.append(table(entry))
        titles = groups(curves.pop((part, id_), []), "curve")
        drawn = {key[0]: points for key, points in titles.items() if len(points) > 1}
        if drawn:
            name = re.sub(r"[^A-Za-z0-9]+", "-", f"{part}-{id_}") + ".png"
            draw_curves(drawn, os.path.join(plots, name))
            page.append(f"<p><img src='plots/{name}' alt='measured and expected curves'></p>")
    page.append("<h2>Every figure against what is allowed</h2>")
    page += [f"<p><img src='plots/{name}' alt='error over what is allowed'></p>" for name in margins]
    page.append("</body></html>")
    with open(os.path.join(folder, "validation.html"), "w") as file:
        file.write("\n".join(page) + "\n")


main(sys.argv[1])
