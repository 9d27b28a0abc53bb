// wall_bodies.h: the walls of a case as planes at rest and as bodies of infinite mass.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene.h"
#include "shapes/mesh_tree.h"

namespace scree {

// One wall body before its place among the bodies is known.
struct WallSolid {
  WallBody body;
  ShapeRecord record;                    // without places in the scene's arrays
  std::shared_ptr<MeshTree const> mesh;  // null: a formula
  std::vector<Vec3> node;                // along sharp edges, body frame [m]
  std::vector<double> area;              // [m^2]
};

// A smooth wall: spheres need no nodes against it.
bool meets_spheres_in_closed_form(ShapeRecord const& wall);

// Index of a material of the case; -1 for an unknown one, which problems(Case) has refused.
int material_index(Case const& c, std::string const& name);

// Planes and boxes at rest go to scene.plane; the others come back as solids. Reads wall files. What is wrong goes to
// `found`, what the user should know to scene.notes.
std::vector<WallSolid> build_walls(Case const& c, Scene& scene, std::vector<std::string>& found);

// Appends shapes, nodes and bodies of the walls: call it when all grains are there.
void add_wall_bodies(Case const& c, std::vector<WallSolid> const& walls, Scene& scene);

}  // namespace scree
