#!/usr/bin/env python3
# bench_opponents.py: particle-steps per second of Scree and of other DEM programs from the same settled state, in one run.
# SPDX-License-Identifier: Apache-2.0
"""Scree beside Yade, LAMMPS and LIGGGHTS (Debian packages `yade`, `lammps`, `liggghts`), each where it is installed.

usage: bench_opponents.py PROGRAMS [--net model.h5] [--scene spheres|superellipsoids] [--json FILE] ...

PROGRAMS is the folder with `scree` and `bench_step`. Grains settle in an open box in Scree; every program then starts from
these poses, at rest and with random velocities, takes --warm-up steps and is timed over --steps more. Rounds of all programs
are interleaved, figures are medians: of processor time with one thread, where other jobs take the machine for a while, of wall
time with more. Needs h5py (Debian package python3-h5py).

spheres: closed-form spheres in Scree; Yade; LAMMPS gran/hooke/history; LIGGGHTS hooke/stiffness with tangential history.
superellipsoids (axes 1 : 0.8 : 0.6, exponents 0.6): the network --net, that is `scree-train fit superellipsoid:1:0.8:0.6:0.6`,
with --nodes surface nodes, the same network baked to a grid, and the formula, against Yade's level-set DEM with as many nodes.

The same in all: poses, box, density, gravity, friction, normal and tangential stiffness [N/m], time step, number of threads.
Neighbour lists: LAMMPS and LIGGGHTS get a skin of 0.1 d, Yade the faster of 0.1 d and 0 (superellipsoids) or 0.25 d, its default
(spheres), Scree chooses its own. What differs: Yade damps locally, the others by a dashpot; for superellipsoids Yade has one
contact point a pair, Scree pressure on every surface node in the overlap.
"""
import argparse
import csv
import datetime
import json
import math
import os
import random
import re
import resource
import shutil
import statistics
import subprocess
import sys

DIAMETER, DENSITY, FRICTION, KN, KT, RATIO = 0.02, 2650.0, 0.5, 1e4, 5e3, 0.5  # [m] [kg/m3] - [N/m] [N/m], of critical damping
MASS = DENSITY * math.pi / 6 * DIAMETER**3  # [kg]
STEP = 0.05 * math.sqrt(MASS / KN)  # [s]
SHAPE = 'superellipsoid:1:0.8:0.6:0.6'

CASE = '''[time]
end = {seconds}
[time.settle]
after = {after}
kinetic_per_grain = 1e-7
hold = 0.02
[gravity]
acceleration = [0, 0, -9.81]
{library}[[material]]
name = "rock"
density = {density}
[[contact]]
pair = ["rock", "rock"]
law = "linear"
normal = {{ stiffness = {kn} }}
tangential_ratio = {ratio}
friction = {friction}
damping = {{ ratio = {damping} }}
[[grains]]
name = "grains"
material = "rock"
shapes = ["{shape}"]
nodes = {nodes}
count = {grains}
diameter = {diameter}
insert = {{ kind = "{insert}", box = [[0, 0, 0], [{width}, {width}, {height}]] }}
[[wall]]
name = "container"
material = "rock"
kind = "box"
min = [0, 0, 0]
max = [{width}, {width}, 101]
open = ["+z"]
[output]
every = {seconds}
[limits]
overlap = 0.2
'''

LAMMPS = '''atom_style sphere
atom_modify map array sort 1000 0
comm_modify vel yes
newton off
units si
boundary f f f
read_data grains.data
pair_style gran/hooke/history {kn} {kt} {gamma} {half} {friction} 1
pair_coeff * *
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes
timestep {step}
fix move all nve/sphere
fix weight all gravity 9.81 vector 0 0 -1
fix x all wall/gran hooke/history {kn} {kt} {gamma} {half} {friction} 1 xplane 0 {width}
fix y all wall/gran hooke/history {kn} {kt} {gamma} {half} {friction} 1 yplane 0 {width}
fix z all wall/gran hooke/history {kn} {kt} {gamma} {half} {friction} 1 zplane 0 NULL
thermo {steps}
run {warm_up}
run {steps}
'''

LIGGGHTS = '''atom_style granular
atom_modify map array
communicate single vel yes
newton off
units si
boundary f f f
read_data grains.data
fix m1 all property/global kn peratomtypepair 1 {kn}
fix m2 all property/global kt peratomtypepair 1 {kt}
fix m3 all property/global gamman peratomtypepair 1 {gamma}
fix m4 all property/global gammat peratomtypepair 1 {half}
fix m5 all property/global coefficientFriction peratomtypepair 1 {friction}
pair_style gran model hooke/stiffness tangential history
pair_coeff * *
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes
timestep {step}
fix x0 all wall/gran model hooke/stiffness tangential history primitive type 1 xplane 0
fix x1 all wall/gran model hooke/stiffness tangential history primitive type 1 xplane {width}
fix y0 all wall/gran model hooke/stiffness tangential history primitive type 1 yplane 0
fix y1 all wall/gran model hooke/stiffness tangential history primitive type 1 yplane {width}
fix z0 all wall/gran model hooke/stiffness tangential history primitive type 1 zplane 0
fix move all nve/sphere
fix weight all gravity 9.81 vector 0 0 -1
thermo {steps}
run {warm_up}
run {steps}
'''


def call(command, folder, threads):
    """Runs in the folder; what it says. A failure ends the program with its last words."""
    environment = {**os.environ, 'OMP_NUM_THREADS': str(threads), 'OMP_WAIT_POLICY': 'passive'}
    done = subprocess.run(command, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment)
    if done.returncode != 0:
        sys.exit('%s failed:\n%s' % (' '.join(command), '\n'.join(done.stdout.splitlines()[-20:])))
    return done.stdout


def loop_seconds(text):
    """Of the last run in a log of LAMMPS or LIGGGHTS: wall time."""
    found = re.findall(r'Loop time of ([0-9.eE+-]+) on', text)
    if not found:
        raise ValueError('no "Loop time of" in the log')
    return float(found[-1])


def children_seconds():
    """Processor time of all programs that were called so far."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Scene:
    """Poses in the files that each program reads, in a folder of its own."""

    def __init__(self, a, kind):
        self.a, self.kind = a, kind
        self.folder = os.path.join(a.output, kind)
        os.makedirs(self.folder, exist_ok=True)
        self.grains = a.spheres if kind == 'spheres' else a.grains
        self.width = DIAMETER * max(4, round(0.8 * self.grains**(1 / 3)))

    def settle(self):
        a = self.a
        net = self.kind == 'superellipsoids' and a.net
        library = '[[library]]\nname = "net"\nfile = "%s"\n' % os.path.abspath(a.net) if net else ''
        # Spheres of a lattice would fall into straight columns; at random they fill an eighth of their box.
        spheres = self.kind == 'spheres'
        insert, height = ('random', 4 * self.grains * DIAMETER**3 / self.width**2) if spheres else ('lattice', 100)
        with open(os.path.join(self.folder, 'case.toml'), 'w') as f:
            f.write(CASE.format(seconds=a.seconds, after=0.6 * a.seconds, library=library, density=DENSITY, kn=KN,
                                ratio=KT / KN, friction=FRICTION, damping=RATIO, grains=self.grains, diameter=DIAMETER,
                                width=self.width, nodes=a.nodes, insert=insert, height=height,
                                shape='sphere' if spheres else 'net:*' if net else SHAPE))
        state = os.path.join(self.folder, 'settled', 'results.h5')
        if not os.path.exists(state) or not a.keep:
            call([a.scree, 'run', 'case.toml', '--output', 'settled', '--force', '--quiet'], self.folder, a.threads)
        import h5py  # only here: --help and the tests do without
        with h5py.File(state, 'r') as f:
            self.position, self.turn = f['frames/position'][-1].tolist(), f['frames/orientation'][-1].tolist()

    def write(self, speed):
        draw = random.Random(1)
        velocity = [[draw.uniform(-speed, speed) for _ in range(3)] for _ in self.position]
        with open(os.path.join(self.folder, 'poses.csv'), 'w', newline='') as f:
            rows = csv.writer(f)
            rows.writerow('x y z qw qx qy qz vx vy vz'.split())
            rows.writerows([repr(v) for v in p + q + u] for p, q, u in zip(self.position, self.turn, velocity))
        top = 2 * max(p[2] for p in self.position) + self.width
        with open(os.path.join(self.folder, 'grains.data'), 'w') as f:
            f.write('grains\n\n%d atoms\n1 atom types\n\n' % self.grains)
            for axis, high in (('x', self.width), ('y', self.width), ('z', top)):
                f.write('%r %r %slo %shi\n' % (-DIAMETER, high + DIAMETER, axis, axis))
            f.write('\nAtoms\n\n')
            for i, p in enumerate(self.position):
                f.write('%d 1 %r %r %r %r %r\n' % (i + 1, DIAMETER, DENSITY, *p))
            f.write('\nVelocities\n\n')
            for i, u in enumerate(velocity):
                f.write('%d %r %r %r 0 0 0\n' % (i + 1, *u))

    def scree(self, extra):
        """Seconds of the steps, at rest and flowing."""
        a, out = self.a, os.path.join(self.folder, 'scree.json')
        call([a.bench_step, '--state', 'settled/results.h5', '--set', 'time.step=%r' % STEP, '--steps', str(a.steps),
              '--warm-up', str(a.warm_up), '--rounds', '1', '--speed', str(a.speed), '--threads', str(a.threads),
              '--output', 'scree.json'] + extra, self.folder, a.threads)
        with open(out) as f:
            got = {r['scene']: r['figures'] for r in json.load(f)['results']}
        per = 1e-6 * a.steps
        return {name: {'wall': per * got[name]['us_per_step'], 'processor': per * got[name]['cpu_us_per_step']}
                for name in ('rest', 'flowing')}

    def yade(self, skin):
        a, got = self.a, {}
        for name, speed in (('rest', 0), ('flowing', a.speed)):
            self.write(speed)
            with open(os.path.join(self.folder, 'scene.json'), 'w') as f:
                json.dump({'kind': self.kind[:-1], 'poses': 'poses.csv', 'diameter': DIAMETER, 'width': self.width, 'kn': KN,
                           'density': DENSITY, 'ks': KT, 'friction': FRICTION, 'step': STEP, 'warm_up': a.warm_up, 'steps': a.steps,
                           'nodes': a.nodes, 'skin': skin}, f)
            script = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'yade_step.py')
            text = call(['yade', '-x', '-n', '-j%d' % a.threads, script, 'scene.json'], self.folder, a.threads)
            got[name] = json.loads([line for line in text.splitlines() if line.startswith('{')][-1])
        return got

    def lammps(self, program, script):
        a, got = self.a, {}
        gamma = 2 * RATIO * math.sqrt(KN / (MASS / 2))  # [1/s]: the dashpot is gamma m_eff, RATIO of critical
        command = [program, '-log', 'none', '-in']
        if a.threads > 1:
            command = ['mpirun', '--oversubscribe', '-np', str(a.threads)] + command
        files = {steps: '%s_%d.in' % (program, steps) for steps in (1, a.steps)}
        for steps, file in files.items():
            with open(os.path.join(self.folder, file), 'w') as f:
                f.write(script.format(kn=KN, kt=KT, gamma=gamma, half=gamma / 2, friction=FRICTION, skin=0.1 * DIAMETER, step=STEP,
                                      width=self.width, warm_up=a.warm_up, steps=steps))
        for name, speed in (('rest', 0), ('flowing', a.speed)):
            self.write(speed)
            used, text = [], ''
            for steps in files:  # they tell wall time only: processor time is that of a long run less that of a short one
                before = children_seconds()
                text = call(command + [files[steps]], self.folder, 1)
                used.append(children_seconds() - before)
            got[name] = {'wall': loop_seconds(text), 'processor': (used[1] - used[0]) * a.steps / (a.steps - 1)}
        return got

    def subjects(self):
        """Name, needed program, what runs one round; the first is what the others are compared with."""
        if self.kind == 'spheres':
            return [('Scree, closed form', None, lambda: self.scree([])),
                    ('Yade', 'yade', lambda: self.yade(-0.5)),
                    ('Yade, skin 0.1 d', 'yade', lambda: self.yade(0.1 * DIAMETER)),
                    ('LAMMPS', 'lmp', lambda: self.lammps('lmp', LAMMPS)),
                    ('LIGGGHTS', 'liggghts', lambda: self.lammps('liggghts', LIGGGHTS))]
        first = [('Scree, network', None, lambda: self.scree([])),
                 ('Scree, the network as a grid', None, lambda: self.scree(['--set', 'grains.grains.evaluator="grid"']))]
        formula = ['--set', 'grains.grains.shapes=["%s"]' % SHAPE]
        return (first if self.a.net else []) + [
            ('Scree, formula', None, lambda: self.scree(formula if self.a.net else [])),
            ('Yade level set', 'yade', lambda: self.yade(0)),
            ('Yade level set, skin 0.1 d', 'yade', lambda: self.yade(0.1 * DIAMETER))]


def compare(seconds, work):
    """Rows of the table: seconds[subject] are those of its rounds, the first subject is the reference; `work` particle-steps."""
    first = next(iter(seconds))
    rows = []
    for name, rounds in seconds.items():
        ratios = [other / own for own, other in zip(seconds[first], rounds)]
        rows.append({'subject': name, 'particle_steps_per_second': work / statistics.median(rounds),
                     'first_over_this': statistics.median(ratios), 'lowest': min(ratios), 'highest': max(ratios)})
    return rows


def installed(subjects, say=print):
    """Name and round of the subjects whose program is there; of the others it is said that they are not."""
    left = []
    for name, program, run in subjects:
        if program and not shutil.which(program):
            say('%s: %s is not installed' % (name, program))
        else:
            left.append((name, run))
    return left


def measure(scene):
    a = scene.a
    scene.settle()
    subjects = installed(scene.subjects())
    got = {name: [] for name, _ in subjects}
    for _ in range(a.rounds):
        for name, run in subjects:
            got[name].append(run())
    out = []
    clock = 'wall' if a.threads > 1 else 'processor'
    for state in ('rest', 'flowing'):
        rows = compare({name: [r[state][clock] for r in rounds] for name, rounds in got.items()}, scene.grains * a.steps)
        print('\n%d %s, %s, %d thread(s)\n' % (scene.grains, scene.kind, state, a.threads))
        print('| program | particle-steps/s | Scree (first row) over it | of rounds |\n|---|---|---|---|')
        for row in rows:
            print('| %s | %.3g | %.2f | %.2f to %.2f |' % (row['subject'], row['particle_steps_per_second'],
                                                         row['first_over_this'], row['lowest'], row['highest']))
            row.update({k: v for k, v in got[row['subject']][-1][state].items() if k not in ('wall', 'processor')})
        out.append({'scene': scene.kind, 'state': state, 'grains': scene.grains, 'nodes': a.nodes, 'rows': rows})
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('programs')
    parser.add_argument('--scene', choices=['spheres', 'superellipsoids'], action='append', help='default: both')
    parser.add_argument('--net', help='network of the superellipsoid; without it its formula')
    parser.add_argument('--spheres', type=int, default=5000)
    parser.add_argument('--grains', type=int, default=400, help='superellipsoids')
    parser.add_argument('--nodes', type=int, default=400, help='a superellipsoid')
    parser.add_argument('--seconds', type=float, default=1.0, help='that grains may take to settle')
    parser.add_argument('--speed', type=float, default=0.1, help='flowing: velocity components are up to this [m/s]')
    parser.add_argument('--steps', type=int, default=500)
    parser.add_argument('--warm-up', type=int, default=200)
    parser.add_argument('--rounds', type=int, default=5)
    parser.add_argument('--threads', type=int, default=1)
    parser.add_argument('--keep', action='store_true', help='use the settled state of an earlier run in --output')
    parser.add_argument('--output', default='opponents.out')
    parser.add_argument('--json', help='write the figures there')
    a = parser.parse_args()
    a.output = os.path.abspath(a.output)
    a.scree, a.bench_step = (os.path.join(os.path.abspath(a.programs), name) for name in ('scree', 'bench_step'))
    results = []
    for kind in a.scene or ['spheres', 'superellipsoids']:
        results += measure(Scene(a, kind))
    if a.json:
        with open('/proc/cpuinfo') as f:
            machine = next((line.split(':')[1].strip() for line in f if line.startswith('model name')), 'unknown')
        version = subprocess.run([a.bench_step, '--version'], text=True, capture_output=True).stdout.strip()
        with open(a.json, 'w') as f:
            json.dump({'benchmark': 'bench_opponents', 'version': version, 'machine': machine,
                       'clock': 'wall' if a.threads > 1 else 'processor',
                       'date': datetime.datetime.now(datetime.timezone.utc).strftime('%Y-%m-%dT%H:%M:%SZ'), 'threads': a.threads,
                       'steps': a.steps, 'warm_up': a.warm_up, 'rounds': a.rounds, 'results': results}, f, indent=1)
            f.write('\n')


if __name__ == '__main__':
    main()
