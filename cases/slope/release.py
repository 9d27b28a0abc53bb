# release.py: release points along a straight line over an elevation grid, as a table for `insert = { kind = "file" }`.
# /usr/bin/python3 cases/slope/release.py GRID.asc --from 16,16 --to 16,54 -o cases/slope/release.csv
# SPDX-License-Identifier: Apache-2.0
import argparse

import numpy as np


def place(text):
    return np.array([float(value) for value in text.split(",")])


def arguments():
    parser = argparse.ArgumentParser(description="Release points along a line over an ESRI ASCII grid")
    parser.add_argument("grid", help="elevation grid")
    parser.add_argument("--from", dest="start", type=place, required=True, help="x,y from the grid's lower left corner [m]")
    parser.add_argument("--to", dest="end", type=place, required=True, help="x,y [m]")
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--above", type=float, default=2.0, help="above the highest cell within 1 m [m]")
    parser.add_argument("-o", dest="output", required=True, help="table: x,y,z [m]")
    return parser.parse_args()


def main():
    a = arguments()
    with open(a.grid, encoding="ascii") as file:
        head = dict(file.readline().lower().split() for _ in range(6))
        height = np.loadtxt(file)[::-1]  # rows from south to north
    height[height == float(head["nodata_value"])] = np.nan
    cell = float(head["cellsize"])
    y, x = ((np.arange(n) + 0.5) * cell for n in height.shape)
    with open(a.output, "w", encoding="ascii") as out:
        out.write("x,y,z\n")
        for t in np.linspace(0, 1, a.count):
            at = a.start + t * (a.end - a.start)
            near = (x[None, :] - at[0]) ** 2 + (y[:, None] - at[1]) ** 2 <= max(1, cell) ** 2
            out.write(f"{at[0]:.2f},{at[1]:.2f},{height[near].max() + a.above:.2f}\n")


if __name__ == "__main__":
    main()
