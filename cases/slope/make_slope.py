# make_slope.py: the seeded slope of this scene as an ESRI ASCII grid: crest, face with benches, run-out.
# /usr/bin/python3 cases/slope/make_slope.py cases/slope/slope.asc
# SPDX-License-Identifier: Apache-2.0
import sys

import numpy as np

COLUMNS, ROWS, CELL, SEED = 161, 71, 1.0, 7

# Height over x [m]: crest, three steep parts with benches between them, scree, run-out and a low bank.
KNEES = [(0, 62), (14, 60), (24, 46), (29, 44.5), (40, 30), (46, 28.5), (56, 16), (66, 10), (80, 5), (105, 2), (140, 2.5), (161, 9)]


def rough(shape, length, random):
    """Smooth noise of unit deviation that varies over `length` cells."""
    rows, columns = (int(np.ceil(n / length)) + 3 for n in shape)
    coarse = random.standard_normal((rows, columns))
    y, x = (np.arange(n) / length for n in shape)
    iy, ix = y.astype(int), x.astype(int)
    ty, tx = (3 * t**2 - 2 * t**3 for t in (y - iy, x - ix))
    low = coarse[np.ix_(iy, ix)] * (1 - tx) + coarse[np.ix_(iy, ix + 1)] * tx
    high = coarse[np.ix_(iy + 1, ix)] * (1 - tx) + coarse[np.ix_(iy + 1, ix + 1)] * tx
    return low * (1 - ty[:, None]) + high * ty[:, None]


def main(file):
    random = np.random.default_rng(SEED)
    shape = (ROWS, COLUMNS)
    x = (np.arange(COLUMNS) + 0.5) * CELL
    y = (np.arange(ROWS) + 0.5) * CELL
    shift = 1.5 * rough(shape, 12, random)  # benches wander
    z = np.interp(x[None, :] + shift, *zip(*KNEES))
    steep = np.clip((z - 3) / 20, 0.1, 1)
    z += steep * (0.5 * rough(shape, 6, random) + 0.18 * rough(shape, 2, random))
    z += 0.012 * (y[:, None] - y.mean()) ** 2 * np.clip(z / 60, 0.1, 1)  # a gully in the middle
    with open(file, "w", encoding="ascii") as out:
        out.write(f"ncols {COLUMNS}\nnrows {ROWS}\nxllcorner 0\nyllcorner 0\ncellsize {CELL:g}\nNODATA_value -9999\n")
        for row in z[::-1]:  # from north to south
            out.write(" ".join(f"{v:.2f}" for v in row) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])
