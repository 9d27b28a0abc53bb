// scene.h: everything of a run that never changes: shapes with their nodes, materials, walls, masses.
// Built once from a Case; kernels see it through view().
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "core/case.h"
#include "kernels/sdf_queries.h"
#include "kernels/views.h"
#include "shapes/compact_nodes.h"
#include "shapes/shape.h"
#include "shapes/surface_nodes.h"

namespace scree {

// Generated grains of shared decoders: what Scene::shape and Scene::compact do not hold of them already. A Shape with
// its name and certificate would cost more than a fifth of the whole grain.
struct UniqueGrains {
  struct Group {
    std::string name;  // of the grains: name + "0", name + "1", ...
    int net;           // of Scene::networks
    int first, count;  // among the unique grains
    std::size_t first_code;
  };
  std::vector<Group> group;
  std::vector<float> code;
  std::vector<float> area;    // [d^2] (n_unique)
  std::vector<Vec3> inertia;  // principal, unit density [d^5] (n_unique)
};

// A wall as a body of infinite mass: body bodies() + i of the scene is wall body i. A box or a cylinder that moves has
// one for each face.
struct WallBody {
  int wall = 0;      // of the case
  Vec3 position;     // at time 0 [m]
  Quat orientation;  // at time 0
  std::optional<MotionCase> motion;
  double reach = 0;  // of its solid about `position`, as far as grains come [m]
};

struct Scene {
  // Shapes in use, one template each (a shape with another node count is another template).
  Library library;  // library.shape[i] is template i; unique grains follow after its last shape
  UniqueGrains unique;
  std::vector<ShapeRecord> shape;  // (n_templates)
  std::vector<int> nodes_wanted;   // (n_templates)
  NetworkSet networks;
  // Radii, grids and meshes of the templates, see SdfDataView.
  std::vector<double> coefficient;
  std::vector<float> grid_value;
  std::vector<MeshNode> mesh_node;
  std::vector<Vec3> mesh_corner, mesh_normal;
  std::vector<Vec3> node_position;  // [d]
  std::vector<double> node_area;    // [d^2]
  std::vector<Vec3> block_centre;
  std::vector<double> block_radius;
  std::vector<int> block_first;  // with an end entry a template
  CompactStore compact;          // nodes of templates that keep 16-bit radii

  // Bodies: grains (n_bodies), then walls.
  std::vector<int> shape_of, material_of;  // (n_solids)
  std::vector<int> group_of;               // index of the [[grains]] entry (n_bodies)
  std::vector<int> world_of;               // see SceneView; empty: all meet (n_bodies)
  std::vector<double> diameter, mass;      // [m], [kg] (n_solids)
  std::vector<Vec3> inertia;               // principal [kg m2] (n_solids)
  std::vector<WallBody> wall;              // (n_walls)

  std::vector<std::string> material;
  std::vector<PlaneRecord> plane;                  // walls at rest that are planes or faces of a box
  std::vector<ContactParameters> contact;          // [a * materials + b]
  bool friction = false, rolling = false;          // some pair has it: history exists
  double cohesion_reach = 0, cohesion_margin = 0;  // see SceneView

  std::vector<std::string> notes;  // what the user should know about the making of the scene

  SceneView view() const;
  // Template as a shape of its own: unique grains are unpacked.
  Shape template_shape(int index) const;
  int world(int body) const { return world_of.empty() ? 0 : world_of[body]; }
  int worlds() const { return world_of.empty() ? 1 : 1 + *std::max_element(world_of.begin(), world_of.end()); }
  int bodies() const { return static_cast<int>(group_of.size()); }
  int solids() const { return static_cast<int>(shape_of.size()); }
  int templates() const { return static_cast<int>(shape.size() - wall.size()); }  // of grains; walls follow
};

// Poses and velocities a case starts from (n_bodies).
struct Placement {
  std::vector<Vec3> position, velocity, spin;  // [m], [m/s], world [rad/s]
  std::vector<Quat> orientation;
};

// Reads model files, resolves shapes, builds nodes, places grains. Throws InputError with all problems.
Scene build_scene(Case const& c, int threads, Placement& placement);

}  // namespace scree
