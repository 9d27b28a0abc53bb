// views.h: what a kernel sees of Scene and State: spans, owning nothing.
// World frame unless the name says otherwise. Lengths of a shape's own data are in units of its body's diameter d.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/span.h"
#include "kernels/base/vec.h"
#include "kernels/contact_laws.h"
#include "kernels/node_storage.h"
#include "kernels/sdf/analytic.h"
#include "kernels/sdf/grid.h"
#include "kernels/sdf/mesh.h"

namespace scree {

// What answers for phi of a shape. Planes count as analytic.
enum class SdfKind { net, harmonics, grid, mesh, analytic };

// A shape template, shared by every body that has this shape.
struct ShapeRecord {
  bool closed_form_sphere = false;  // contacts with its like and with planes need no nodes
  SdfKind sdf = SdfKind::analytic;
  int net = -1;          // -1: no network defines phi
  int bias_row = 0;      // of its network's first-layer biases
  AnalyticSdf analytic;  // units of d
  Mat3 query_rotation;   // net, harmonics: x_own = query_rotation * (x * query_scale) + query_shift
  Vec3 query_shift;
  double query_scale = 1;
  int first_coefficient = 0, coefficients = 0;  // harmonics
  GridFrame grid;                               // grid [d]
  std::size_t first_value = 0;                  // ... its first value
  int first_mesh_node = 0, mesh_nodes = 0;      // mesh [d]
  int first_triangle = 0, triangles = 0;        // ... of its corners and normals
  double half_wall = 0;                         // > 0: the mesh is a sheet, solid this far on both sides [d]
  double bounding_radius = 0.5;                 // of the zero set about the centroid [d]
  Box box;                                      // of the zero set in the body frame [d]
  double lipschitz = 1;                         // upper bound of |grad phi| outside the solid
  double node_spacing = 0;                      // typical [d]
  double half_thickness = 1e300;                // of its thin parts as phi measures it [d]; 1e300: without a middle
  int compact = -1;                             // of NodesView::compact; -1: nodes are kept as arrays
  int first_node = 0, nodes = 0;                // first_node: of NodesView::position, compact: of NodesView::radius
  int first_block = 0, blocks = 0;
  int first_bound = 0;  // of NodesView::block_first; not used when compact
};

// What the shapes that are neither formula nor network consist of, all shapes one after the other.
struct SdfDataView {
  Span<const double> coefficient;  // of harmonics
  Span<const float> grid_value;    // phi [d]
  Span<const MeshNode> mesh_node;  // indices relative to the shape's first node and triangle
  Span<const Vec3> mesh_corner;    // [d], 3 a triangle
  Span<const Vec3> mesh_normal;    // normals_per_triangle each
};

// A half space: the solid lies behind the plane. A box container is one such record a face.
struct PlaneRecord {
  Vec3 point, normal;  // [m], unit normal into the free space
  int material = 0;
  int wall = 0;  // index of the wall in the case
};

// Walls other than planes at rest are bodies of infinite mass behind the grains in every array of bodies, with a
// diameter of 1 m: their lengths are in m, their pose is prescribed (core/wall_motion.h), their solid may be unbounded.

// Parameters of one material pair.
struct ContactParameters {
  PressureLaw normal;          // hertz: modulus E* / pi [Pa], see law_at_radius; modulus 0: no law was given
  double tangential = 0;       // k_t / k_n, times normal.secant() [-]
  double friction = 0;         // mu [-]; 0: none
  double damping_nodes = 0;    // zeta of node contacts [-]; 0: none
  double damping_sphere = 0;   // zeta of closed-form spheres, whose force clips once a pair [-]
  Cohesion cohesion;           // traction 0: none
  double rolling = 0;          // mu_r [-]; 0: no rolling resistance
  double rolling_ratio = 0;    // k_r / (K (mu_r R_r)^2) [-]
  double rolling_damping = 0;  // eta_r, share of critical [-]
};

struct SceneView {
  Span<const ShapeRecord> shape;
  NodesView nodes;
  SdfDataView sdf;
  Span<const int> shape_of;               // (n_solids)
  Span<const int> material_of;            // (n_solids)
  Span<const double> diameter;            // of the equal-volume sphere [m]; walls: 1 (n_solids)
  Span<const double> mass;                // [kg]; walls: infinite (n_solids)
  Span<const Vec3> inertia;               // principal, body frame [kg m2]; walls: infinite (n_solids)
  Span<const int> world_of;               // >= 0; bodies of different worlds never meet (n_bodies); empty: all meet
  Span<const PlaneRecord> plane;          // (n_planes)
  Span<const ContactParameters> contact;  // [material_a * materials + material_b]
  int materials = 0;
  int walls = 0;          // bodies of infinite mass, the last of the solids
  bool friction = false;  // some pair has friction: history exists
  // Cohesion of any pair: 0 without it. Outside a surface nothing else looks at phi beyond its sign.
  double cohesion_reach = 0;   // largest [m], as phi measures it
  double cohesion_margin = 0;  // ... as the world does: |grad phi| of a shape may be below 1

  SCREE_HD int solids() const { return shape_of.size(); }          // grains, then walls
  SCREE_HD int bodies() const { return shape_of.size() - walls; }  // grains
  SCREE_HD bool is_wall(int body) const { return body >= bodies(); }
  SCREE_HD ShapeRecord const& shape_record(int body) const { return shape[shape_of[body]]; }
};

// Bodies that are inserted or deleted during a run exist from its start to its end; only the active ones take part.
enum class Activity : unsigned char { pending, active, deleted };

struct StateView {
  Span<Vec3> position;            // of the centroid [m] (n_solids)
  Span<Quat> orientation;         // body -> world (n_solids)
  Span<Vec3> velocity;            // [m/s] (n_solids)
  Span<Vec3> angular_momentum;    // about the centroid, world frame [kg m2/s]; walls: spin [rad/s] (n_solids)
  Span<const Activity> activity;  // of the bodies that can come or go, from 0 on; the others are active

  SCREE_HD bool active(int i) const { return i >= activity.size() || activity[i] == Activity::active; }
};

// As a ball's: the inertia is a number, and no rotation is needed to apply it.
SCREE_HD inline bool is_isotropic(Vec3 inertia) { return inertia.x == inertia.y && inertia.y == inertia.z; }

// Spin [rad/s] of a body from its angular momentum.
SCREE_HD inline Vec3 spin_of(Mat3 const& rotation, Vec3 inertia, Vec3 angular_momentum) {
  if (is_isotropic(inertia)) return angular_momentum * (1 / inertia.x);
  return rotation * divide(transposed_times(rotation, angular_momentum), inertia);
}
SCREE_HD inline Vec3 spin_of(Quat orientation, Vec3 inertia, Vec3 angular_momentum) {
  return spin_of(is_isotropic(inertia) ? Mat3{} : to_matrix(orientation), inertia, angular_momentum);
}
// I^-1 torque in the world frame.
SCREE_HD inline Vec3 inverse_inertia_times(Mat3 const& rotation, Vec3 inertia, Vec3 torque) {
  return spin_of(rotation, inertia, torque);
}

}  // namespace scree
