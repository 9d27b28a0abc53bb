#!/usr/bin/env python3
# yade_witness.py: the same drop of superellipsoids in Yade's level-set DEM (Debian package `yade`) and in Scree, compared.
# SPDX-License-Identifier: Apache-2.0
"""Row 20 of the validation book: an independent code as a witness.

usage: yade_witness.py SCREE [--seeds N] [--first SEED] [--grains N] [--seconds S] [--output DIR]

SCREE is the program. For each seed, grains at random orientations stand on a loose grid above the floor of a square box;
both programs let them fall from these poses and settle. Prints the figures of each run and their means over the seeds as a
Markdown table, +- the standard deviation; the exit code is 1 when a mean differs by more than 5 %.

What is the same: bodies, both as grids of phi with 1,000 surface nodes, poses, box, density, gravity, friction, stiffness of a
contact in both directions [N/m], and what takes the energy: in both, all velocities and spins decay by exp(-rate t), and
nothing else damps. How loose a bed with friction comes to rest depends on that more than on the code: with its own local
damping of 0.3 Yade's bed of seed 1 is half as high again as with 0.05. What is not the same: Yade has one contact point a pair
with F = k_n overlap, here pressure acts on every surface node in the overlap (law "linear").
"""
import argparse
import csv
import math
import os
import random
import statistics
import subprocess
import sys

DIAMETER, WIDTH, DENSITY, FRICTION = 0.02, 0.09, 2650.0, 0.5  # [m], [m], [kg/m3], -
KN, KS = 1e4, 5e3  # [N/m]
RATE = 10.0  # of the global damping [1/s]
GRAVITY = 9.81  # [m/s2]
MASS = DENSITY * math.pi / 6 * DIAMETER**3  # [kg]

CASE = '''[time]
end = {seconds}
step = 5e-5
[damping]
rate = {rate}
[gravity]
acceleration = [0, 0, -{gravity}]
[[material]]
name = "rock"
density = {density}
[[contact]]
pair = ["rock", "rock"]
law = "linear"
normal = {{ stiffness = {kn}, at_overlap = 0.001 }}  # contacts at rest are about so deep: friction is as stiff as Yade's there
tangential_ratio = {ratio}
friction = {friction}
[[grains]]
name = "grains"
material = "rock"
shapes = ["superellipsoid:1:0.8:0.6:0.6"]
evaluator = "grid"
nodes = 1000
count = {grains}
diameter = {diameter}
insert = {{ kind = "file", file = "poses.csv" }}
[[wall]]
name = "container"
material = "rock"
kind = "box"
min = [0, 0, 0]
max = [{width}, {width}, 1]
open = ["+z"]
[[measure]]
name = "contacts"
kind = "coordination"
'''


def write_poses(file, grains, seed):
    """Loose grid, three cells across the box, each grain within 1 mm of its cell's middle and turned at random."""
    draw = random.Random(seed)
    cell = WIDTH / 3
    with open(file, 'w', newline='') as f:
        rows = csv.writer(f)
        rows.writerow(['x', 'y', 'z', 'qw', 'qx', 'qy', 'qz'])
        for i in range(grains):
            q = [draw.gauss(0, 1) for _ in range(4)]
            size = math.sqrt(sum(v * v for v in q))
            at = [(i % 3 + 0.5) * cell + draw.uniform(-1e-3, 1e-3), (i // 3 % 3 + 0.5) * cell + draw.uniform(-1e-3, 1e-3),
                  (i // 9 + 0.6) * cell]
            rows.writerow([repr(v) for v in at + [v / size for v in q]])


def call(command, folder):
    """Runs in the folder, on one thread; what it says goes to a log there."""
    log = os.path.join(folder, os.path.basename(command[0]) + '.log')
    with open(log, 'w') as out:
        done = subprocess.run(command, cwd=folder, stdout=out, stderr=subprocess.STDOUT,
                              env={**os.environ, 'OMP_NUM_THREADS': '1'})
    if done.returncode != 0:
        sys.exit('%s failed, see %s' % (command[0], log))


def figures_of_yade(folder, seconds):
    drop = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'yade_drop.py')
    call(['yade', '-x', '-n', drop, 'poses.csv', 'yade.csv', str(DIAMETER), str(WIDTH), str(DENSITY), str(KN), str(KS),
          str(FRICTION), str(RATE), str(seconds)], folder)
    with open(os.path.join(folder, 'yade.csv')) as f:
        return {name: float(value) for name, value in csv.reader(f)}


def figures_of_scree(program, folder, grains, seconds):
    with open(os.path.join(folder, 'case.toml'), 'w') as f:
        f.write(CASE.format(seconds=seconds, gravity=GRAVITY, density=DENSITY, kn=KN, ratio=KS / KN, friction=FRICTION, rate=RATE,
                            grains=grains, diameter=DIAMETER, width=WIDTH))
    call([program, 'run', 'case.toml', '--output', 'scree', '--force', '--quiet', '--threads', '1'], folder)
    with open(os.path.join(folder, 'scree', 'ledger.csv')) as f:
        last = list(csv.DictReader(f))[-1]
    weight = grains * MASS * GRAVITY
    out = {'mean_height': float(last['potential']) / weight,
           'kinetic_per_grain': float(last['kinetic']) / (weight * DIAMETER)}
    with open(os.path.join(folder, 'scree', 'measures.csv')) as f:
        for row in csv.DictReader(f):  # the last row of a quantity stays
            if row['quantity'] == 'grains':
                out['coordination_grains'] = float(row['value'])
            if row['quantity'] == 'together':
                out['coordination'] = float(row['value'])
    return out


def difference(yade, scree):
    return 100 * (scree / yade - 1) if yade else math.inf  # [%]


JUDGED = {'mean_height': 'mean height of the centroids = potential energy / weight [m]',
          'coordination': 'contacts a grain, with walls', 'coordination_grains': 'contacts a grain, with grains'}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('scree')
    parser.add_argument('--seeds', type=int, default=3)
    parser.add_argument('--first', type=int, default=1)
    parser.add_argument('--grains', type=int, default=40)
    parser.add_argument('--seconds', type=float, default=1.5)
    parser.add_argument('--output', default='yade_witness.out')
    a = parser.parse_args()
    runs = {name: ([], []) for name in JUDGED}  # of Yade, of Scree, a value a seed
    print('| seed | figure | Yade | Scree | difference |\n|---|---|---|---|---|')
    for seed in range(a.first, a.first + a.seeds):
        folder = os.path.join(a.output, str(seed))
        os.makedirs(folder, exist_ok=True)
        write_poses(os.path.join(folder, 'poses.csv'), a.grains, seed)
        yade = figures_of_yade(folder, a.seconds)
        scree = figures_of_scree(os.path.abspath(a.scree), folder, a.grains, a.seconds)
        for name, text in JUDGED.items():
            for values, figures in zip(runs[name], (yade, scree)):
                values.append(figures[name])
            print('| %d | %s | %.4g | %.4g | %+.1f %% |' % (seed, text, yade[name], scree[name],
                                                          difference(yade[name], scree[name])))
        name = 'kinetic_per_grain'
        print('| %d | kinetic energy left a grain [m g d] | %.1e | %.1e | |' % (seed, yade[name], scree[name]))
        print('| %d | mean unbalanced force over the mean contact force | %.1e | | |' % (seed, yade['unbalanced']))
        print('| %d | mass of a grain, Yade\'s over ours | %.4f | 1 | |' % (seed, yade['mass_ratio']), flush=True)
    outside = 0
    for name, text in JUDGED.items():
        y, s = (statistics.fmean(values) for values in runs[name])
        spread = [statistics.stdev(values) if a.seeds > 1 else math.nan for values in runs[name]]
        print('| mean | %s | %.4g +- %.2g | %.4g +- %.2g | %+.1f %% |' % (text, y, spread[0], s, spread[1], difference(y, s)))
        outside += abs(difference(y, s)) > 5
    sys.exit(1 if outside else 0)


if __name__ == '__main__':
    main()
