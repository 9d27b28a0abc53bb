# yade_step.py: time of steps of Yade from poses of a file; bench_opponents.py runs it in Yade.
# SPDX-License-Identifier: Apache-2.0
"""Step grains in an open box of infinite planes from given poses, and print what a step took.

Arguments: scene.json. Its keys: kind ("sphere", "superellipsoid"), poses (csv: x,y,z,qw,qx,qy,qz,vx,vy,vz, SI, body to world),
diameter [m], width [m], density [kg/m3], kn, ks [N/m], friction, step [s], warm_up, steps, nodes, skin [m]. Prints one line of
JSON: wall and processor time [s] of `steps` steps behind `warm_up` others, contacts with grains and walls, mean and largest
overlap [d] at the end.

Superellipsoids are those of yade_drop.py with `nodes` surface nodes: semi-axis ratios 1 : 0.8 : 0.6, both exponents 0.6.
"""
import csv
import json
import math
import sys
import time

from yade import config
from yade.utils import levelSetBody, sphere, wall

with open(sys.argv[1]) as f:
    scene = json.load(f)
diameter, skin = scene['diameter'], scene['skin']

RATIO, EXPONENT = (1.0, 0.8, 0.6), 0.6
O.materials.append(FrictMat(density=scene['density'], frictionAngle=math.atan(scene['friction'])))
if scene['kind'] == 'superellipsoid':
    if 'LS_DEM' not in config.features:
        sys.exit('this Yade has no LS_DEM')
    # Volume of a superellipsoid, Jaklic, Leonardis, Solina (2000), eq. 2.60: 2 a b c e1 e2 B(e1/2 + 1, e1) B(e2/2, e2/2).
    beta = lambda x, y: math.gamma(x) * math.gamma(y) / math.gamma(x + y)
    unit = 2 * RATIO[0] * RATIO[1] * RATIO[2] * EXPONENT**2 * beta(EXPONENT / 2 + 1, EXPONENT) * beta(EXPONENT / 2, EXPONENT / 2)
    scale = diameter * (math.pi / 6 / unit)**(1 / 3)
    extents = tuple(r * scale for r in RATIO)
    template = levelSetBody('superellipsoid', extents=extents, epsilons=(EXPONENT, EXPONENT), spacing=2 * extents[2] / 20,
                            nSurfNodes=2, nodesPath=2)
    bounds, contacts = [Bo1_LevelSet_Aabb(), Bo1_Wall_Aabb()], [Ig2_LevelSet_LevelSet_ScGeom(), Ig2_Wall_LevelSet_ScGeom()]
    law = Law2_ScGeom_FrictPhys_CundallStrack(sphericalBodies=False)
else:
    bounds, contacts = [Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()]
    law = Law2_ScGeom_FrictPhys_CundallStrack()
with open(scene['poses']) as f:
    for row in csv.DictReader(f):
        x, y, z, qw, qx, qy, qz, vx, vy, vz = (float(v) for v in row.values())
        if scene['kind'] == 'superellipsoid':
            body = levelSetBody(center=(x, y, z), grid=template.shape.lsGrid, distField=template.shape.distField,
                                nSurfNodes=scene['nodes'], nodesPath=2, dynamic=True, orientation=Quaternion(qw, qx, qy, qz))
        else:
            body = sphere((x, y, z), diameter / 2)
        body.state.vel = (vx, vy, vz)
        O.bodies.append(body)
O.bodies.append(wall((0, 0, 0), 2))
for axis in (0, 1):
    for side in (0, scene['width']):
        at = [0, 0, 0]
        at[axis] = side
        O.bodies.append(wall(at, axis))
O.engines = [
    ForceResetter(),
    InsertionSortCollider(bounds, verletDist=skin),
    InteractionLoop(contacts, [Ip2_FrictMat_FrictMat_FrictPhys(kn=MatchMaker(algo='val', val=scene['kn']),
                                                               ks=MatchMaker(algo='val', val=scene['ks']))], [law]),
    NewtonIntegrator(damping=0.3, gravity=(0, 0, -9.81)),
]
O.dt = scene['step']
O.run(scene['warm_up'], True)
begin, used = time.perf_counter(), time.process_time()
O.run(scene['steps'], True)
wall_time, processor = time.perf_counter() - begin, time.process_time() - used
depth = [i.geom.penetrationDepth for i in O.interactions if i.isReal and i.phys.normalForce.norm() > 0]
print('\n' + json.dumps({'wall': wall_time, 'processor': processor, 'contacts': len(depth),
                         'overlap_mean': sum(depth) / max(1, len(depth)) / diameter,
                         'overlap_max': max(depth, default=0) / diameter}))
