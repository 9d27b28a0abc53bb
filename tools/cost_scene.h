// cost_scene.h: what `scree cost` compares: one body, answered for by several evaluators at several node counts.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/simulation_impl.h"

namespace scree {

// One evaluator of the body.
struct CostSubject {
  std::string name;   // "grid 43"
  std::string shape;  // as a case file names it
  Evaluator evaluator = Evaluator::analytic;
  int cells = 0;                  // of a grid or a mesh, across the bounding diameter
  std::filesystem::path library;  // that the shape calls "grains"; empty: none
};

struct CostOptions {
  std::filesystem::path library;                   // with ellipsoid/2
  std::vector<std::filesystem::path> nets;         // more networks of the body: model files of one shape each
  std::vector<int> nodes{250, 1000, 4000, 16000};  // a grain, ascending
  int reference_nodes = 64000;                     // what forces are compared with
  std::vector<double> steps{4, 2, 1, 0.5, 0.125};  // of collisions, in automatic ones; the last is the reference
  int queries = 20000;                             // points of single queries
  bool few = false;                                // evaluators, see cost_subjects
  int grains = 60;                                 // of the heap, even: two and two of them are the pairs
  double fall = 1.2;                               // the time the heap may take to come to rest [s]
  int warm_up = 50, round_steps = 100, rounds = 5;
  double overlap = 0.01;  // of the pairs [d]
  double speed = 1;       // at which they collide, and largest component in the heap [m/s]
};

// The body whose exact distance is known: the triaxial ellipsoid that ellipsoid/2 of the shipped library was learned
// from (shapes/mesh/procedural_grains.cpp).
extern char const cost_truth[];
// The first is the formula itself, the last the shipped network.
std::vector<CostSubject> cost_subjects(CostOptions const& options);

// The heap with the grains of one subject.
Case cost_case(CostOptions const& options, CostSubject const& subject, int nodes);

// Two grains in contact: the centroid of b stands at `distance` from that of a.
struct PairPose {
  Quat a, b;
  Vec3 direction;       // from a to b
  double distance = 0;  // [d]
};
// Drawn with a fixed seed. The deepest of 500 points of b's surface is `overlap` inside a [d]; the deepest point of all
// lies a little deeper.
std::vector<PairPose> draw_pairs(int count, double overlap);

// Makes pairs of the simulation's grains, pair k of bodies 2k and 2k + 1, far from walls and other pairs, `gap` further
// apart than the poses say [d] and approaching each other at `speed` [m/s]; evaluates their forces. Nodes are most of
// the making of a scene, hence one Simulation for heap and pairs: it has no weight, no friction and no damping from
// here on, and the automatic time step of this collision.
void set_up_pairs(Simulation& simulation, std::vector<PairPose> const& pairs, double gap, double speed);

}  // namespace scree
