# morph.py: packing fraction and pile angle along the line between two latent codes: one command, one curve.
# /usr/bin/python3 cases/morph/morph.py build/cpu/bin/scree OUT [--steps N] [--seeds N] [--from SHAPE] [--to SHAPE]
# SPDX-License-Identifier: Apache-2.0
import argparse
import csv
import pathlib
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
CASES = {"packing.toml": [("bed", "fraction"), ("contacts", "together")], "pile.toml": [("heap", "angle")]}


def arguments():
    parser = argparse.ArgumentParser(description="Packing fraction and pile angle along the line between two codes")
    parser.add_argument("scree", type=pathlib.Path, help="the program")
    parser.add_argument("output", type=pathlib.Path, help="folder for runs, morph.csv and morph.png")
    parser.add_argument("--steps", type=int, default=5, help="points on the line, both ends included")
    parser.add_argument("--seeds", type=int, default=3, help="runs a point")
    parser.add_argument("--from", dest="start", default="ballast/0", help="shape at t = 0")
    parser.add_argument("--to", dest="end", default="ellipsoid/0", help="shape at t = 1")
    parser.add_argument("--threads", type=int, help="of each run (default: all cores)")
    return parser.parse_args()


def last_values(folder, wanted):
    """Last sample of each wanted (measure, quantity)."""
    found = {}
    with open(folder / "measures.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            found[row["name"], row["quantity"]] = float(row["value"])
    return [found[key] for key in wanted]


def run(options, case, t, seed):
    folder = options.output / f"{case.removesuffix('.toml')}_t{t:.3f}_s{seed}"
    command = [options.scree, "run", HERE / case, "--output", folder, "--force", "--quiet"]
    if options.threads:
        command += ["--threads", str(options.threads)]
    for key, value in (("interpolate.t", t), ("interpolate.from", options.start), ("interpolate.to", options.end)):
        command += ["--set", f"grains.grain.{key}={value}"]
    subprocess.run([str(c) for c in command + ["--set", f"case.seed={seed}"]], check=True)
    return last_values(folder, CASES[case])


def draw(rows, names, options):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), constrained_layout=True)
    for axis, name, label in zip(axes, ("bed fraction", "heap angle"), ("packing fraction", "pile angle [deg]")):
        i = 1 + 2 * names.index(name)
        axis.errorbar([r[0] for r in rows], [r[i] for r in rows], [r[i + 1] for r in rows], marker="o", capsize=3)
        axis.set_xlabel(f"t: {options.start} to {options.end}")
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    figure.savefig(options.output / "morph.png", dpi=130)


def main():
    options = arguments()
    options.output.mkdir(parents=True, exist_ok=True)
    names = [f"{name} {quantity}" for wanted in CASES.values() for name, quantity in wanted]
    rows = []
    for k in range(options.steps):
        t = k / max(1, options.steps - 1)
        samples = [[v for case in CASES for v in run(options, case, t, s)] for s in range(1, options.seeds + 1)]
        columns = list(zip(*samples))
        spread = [statistics.stdev(c) if len(c) > 1 else 0 for c in columns]
        rows.append([t] + [x for pair in zip(map(statistics.mean, columns), spread) for x in pair])
        print(" ".join(f"{v:8.4f}" for v in rows[-1]), flush=True)
    with open(options.output / "morph.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["t"] + [x for n in names for x in (n, f"{n} spread")])
        writer.writerows([[f"{v:.6g}" for v in row] for row in rows])
    draw(rows, names, options)


if __name__ == "__main__":
    sys.exit(main())
