# yade_drop.py: drops superellipsoids with Yade's level-set DEM from the poses of a file; yade_witness.py runs it in Yade.
# SPDX-License-Identifier: Apache-2.0
"""Settle superellipsoids in a square box of infinite planes and write what has become of them.

Arguments: poses.csv out.csv diameter [m] width [m] density [kg/m3] kn [N/m] ks [N/m] friction [-] damping rate [1/s]
seconds [s].
poses.csv: x,y,z,qw,qx,qy,qz (body to world), one grain a line below a header. Semi-axis ratios 1 : 0.8 : 0.6, both exponents
0.6, equal-volume sphere of the diameter. out.csv: name,value lines.

Contacts are those of Duriez & Bonnet (2021): one point a pair, the deepest of the surface nodes, F = kn overlap, Coulomb
friction. Yade offers no viscous damping for them, and its local damping has no like elsewhere: velocities and spins decay by
exp(-rate t) instead.
"""
import csv
import math
import sys

from yade import config
from yade.utils import levelSetBody, unbalancedForce, wall

poses, out = sys.argv[1:3]
diameter, width, density, kn, ks, friction, rate, seconds = (float(v) for v in sys.argv[3:11])
if 'LS_DEM' not in config.features:
    sys.exit('this Yade has no LS_DEM')

RATIO, EXPONENT, GRAVITY = (1.0, 0.8, 0.6), 0.6, 9.81
# Volume of a superellipsoid, Jaklic, Leonardis, Solina (2000), eq. 2.60: 2 a b c e1 e2 B(e1/2 + 1, e1) B(e2/2, e2/2).
beta = lambda x, y: math.gamma(x) * math.gamma(y) / math.gamma(x + y)
unit = 2 * RATIO[0] * RATIO[1] * RATIO[2] * EXPONENT**2 * beta(EXPONENT / 2 + 1, EXPONENT) * beta(EXPONENT / 2, EXPONENT / 2)
scale = diameter * (math.pi / 6 / unit)**(1 / 3)
extents = tuple(r * scale for r in RATIO)

O.materials.append(FrictMat(density=density, frictionAngle=math.atan(friction)))
template = levelSetBody('superellipsoid', extents=extents, epsilons=(EXPONENT, EXPONENT), spacing=2 * extents[2] / 20,
                        nSurfNodes=2, nodesPath=2)
with open(poses) as f:
    for row in csv.DictReader(f):
        x, y, z, qw, qx, qy, qz = (float(row[k]) for k in ('x', 'y', 'z', 'qw', 'qx', 'qy', 'qz'))
        O.bodies.append(levelSetBody(center=(x, y, z), grid=template.shape.lsGrid, distField=template.shape.distField,
                                     nSurfNodes=1000, nodesPath=2, dynamic=True,
                                     orientation=Quaternion(qw, qx, qy, qz)))
grains = list(range(len(O.bodies)))
O.bodies.append(wall((0, 0, 0), 2))
for axis in (0, 1):
    for side in (0, width):
        at = [0, 0, 0]
        at[axis] = side
        O.bodies.append(wall(at, axis))

O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_LevelSet_Aabb(), Bo1_Wall_Aabb()], verletDist=0),
    InteractionLoop([Ig2_LevelSet_LevelSet_ScGeom(), Ig2_Wall_LevelSet_ScGeom()],
                    [Ip2_FrictMat_FrictMat_FrictPhys(kn=MatchMaker(algo='val', val=kn), ks=MatchMaker(algo='val', val=ks))],
                    [Law2_ScGeom_FrictPhys_CundallStrack(sphericalBodies=False)]),
    NewtonIntegrator(damping=0, gravity=(0, 0, -GRAVITY)),
    PyRunner(command='decay()', iterPeriod=1),
]


def decay():
    keep = math.exp(-rate * O.dt)
    for i in grains:
        state = O.bodies[i].state
        state.vel *= keep
        state.angVel *= keep
        state.angMom *= keep


mass = density * math.pi / 6 * diameter**3
O.dt = 0.1 * math.sqrt(mass / kn)
O.run(int(seconds / O.dt), True)

bodies = [O.bodies[i] for i in grains]
between = walls = 0
overlap = 0.0
for i in O.interactions:
    if not i.isReal or i.phys.normalForce.norm() <= 0:
        continue
    overlap = max(overlap, i.geom.penetrationDepth)
    if i.id1 in grains and i.id2 in grains:
        between += 1
    else:
        walls += 1
kinetic = sum(0.5 * b.state.mass * b.state.vel.squaredNorm() for b in bodies)
kinetic += sum(0.5 * b.state.inertia[k] * (b.state.ori.conjugate() * b.state.angVel)[k]**2 for b in bodies for k in range(3))
figures = {
    'mean_height': sum(b.state.pos[2] for b in bodies) / len(bodies),
    'top_height': max(b.state.pos[2] for b in bodies),
    'coordination_grains': 2 * between / len(bodies),
    'coordination': (2 * between + walls) / len(bodies),
    'overlap': overlap / diameter,
    'unbalanced': unbalancedForce(),
    'kinetic_per_grain': kinetic / len(bodies) / (mass * GRAVITY * diameter),
    'mass_ratio': bodies[0].state.mass / mass,
    'steps': O.iter,
}
with open(out, 'w') as f:
    for name, value in figures.items():
        f.write('%s,%.9g\n' % (name, value))
