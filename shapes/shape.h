// shape.h: a grain shape as the engine sees it, normalised so that its equal-volume sphere has diameter 1.
// Centroid at the origin, principal axes along x, y, z, signed distance positive inside, lengths in units of d.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernels/base/vec.h"
#include "kernels/sdf/analytic.h"
#include "kernels/sdf/grid.h"
#include "kernels/sdf/mlp.h"
#include "shapes/mesh_tree.h"

namespace scree {

// Where a network or a radius is evaluated: x_own = rotation * (x * scale) + shift, phi = phi_own / scale, and
// grad phi = rotation^T grad phi_own. Identity for single networks (folded into their first layer).
struct QueryTransform {
  Mat3 rotation;
  Vec3 shift;
  double scale = 1;

  Vec3 operator()(Vec3 x) const { return rotation * (x * scale) + shift; }
};

// What a shape promises and how far off it is, in units of d; measured by training and `scree-shape inspect`.
// A negative number (for `euler`: 1) means: not measured. Shapes without a truth, such as generated ones, have only
// what phi itself tells (shapes/certify_phi.h); the rest comes from the source mesh (shapes/mesh/certify.h).
struct Certificate {
  double mae = -1, p99 = -1, max = -1;                 // |phi - true distance| on the paper's shell
  double band_mae = -1, band_p99 = -1, band_max = -1;  // the same on |phi| <= 0.05 d
  double normal_p50 = -1, normal_p95 = -1;             // on the surface [degrees]
  double flat_normal_p95 = -1;  // the same farther than 0.03 d from edges sharper than 30 degrees [degrees] ...
  double flat_share = -1;       // ... which is true of this share of the surface
  double hausdorff = -1;        // zero set against the source
  double volume_error = -1, inertia_error = -1;  // relative, before normalisation
  // From phi alone:
  double gradient_p1 = -1, gradient_p5 = -1, gradient_p95 = -1, gradient_p99 = -1;  // |grad phi| on |phi| <= 0.05 d
  double falling = -1;      // share of points deeper than 0.05 d at which phi falls away from the nearest surface
  double gap = -1;          // largest blind gap against a plane of ...
  int gap_nodes = -1;       // ... this many surface nodes
  int components = -1;      // of the zero set
  int euler = 1;            // Euler characteristic of the zero set, always even: 2 a component without handles
  std::int64_t seed = -1;   // of the training
  std::string source;       // formula or mesh name
  std::string source_hash;  // of the mesh file, empty for formulas
  std::string made_with;    // library versions
};

// Names every entry of a certificate (const or not) once, for files to write and to read: visit(name, member).
template <class C, class Visit>
void for_each_figure(C& c, Visit const& visit) {
  visit("mae", c.mae);
  visit("p99", c.p99);
  visit("max", c.max);
  visit("band_mae", c.band_mae);
  visit("band_p99", c.band_p99);
  visit("band_max", c.band_max);
  visit("normal_p50", c.normal_p50);
  visit("normal_p95", c.normal_p95);
  visit("flat_normal_p95", c.flat_normal_p95);
  visit("flat_share", c.flat_share);
  visit("hausdorff", c.hausdorff);
  visit("volume_error", c.volume_error);
  visit("inertia_error", c.inertia_error);
  visit("gradient_p1", c.gradient_p1);
  visit("gradient_p5", c.gradient_p5);
  visit("gradient_p95", c.gradient_p95);
  visit("gradient_p99", c.gradient_p99);
  visit("falling", c.falling);
  visit("gap", c.gap);
  visit("gap_nodes", c.gap_nodes);
  visit("components", c.components);
  visit("euler", c.euler);
  visit("seed", c.seed);
  visit("source", c.source);
  visit("source_hash", c.source_hash);
  visit("made_with", c.made_with);
}

// How far from |phi| = 0 contacts are expected; deeper overlaps stop a run by default [d].
double constexpr contact_band = 0.05;

// What defines phi.
enum class ShapeKind {
  analytic,   // Shape::analytic, a true distance
  net,        // a network, with a code where it is shared
  harmonics,  // a star-shaped body by its radius: the distance along the ray
  mesh,       // the true distance to a closed triangle mesh in the body frame
  grid,       // trilinear values in the body frame
};

struct Shape {
  std::string name;  // "ballast/0"
  ShapeKind kind = ShapeKind::analytic;
  AnalyticSdf analytic;                 // analytic: kind and sizes in units of d; else what it was baked from
  int net = -1;                         // net: index into Library::net
  int data = -1;                        // harmonics, mesh, grid: index into the Library's list of that name
  std::vector<float> code;              // net: latent code; empty for single networks
  QueryTransform query;                 // net and harmonics
  double volume = 0.52359877559829887;  // [d^3]; pi/6 by construction
  double area = 0;                      // surface area [d^2]
  Vec3 inertia;                         // principal, unit density [d^5]
  double bounding_radius = 0;  // of the zero set about the origin [d]; a network is never evaluated beyond 1.1 of it
  Box box;                     // of the zero set [d]
  double lipschitz = 1;        // bound of |grad phi| outside the solid, of networks also inside, to 1.1 bounding_radius
  Certificate certificate;

  bool is_net() const { return kind == ShapeKind::net; }
};

// phi on a grid in the body frame [d]; values on the faces of its box are not positive.
struct SdfGrid {
  GridFrame frame;
  std::vector<float> value;  // (frame.points())
};

// What shapes are made of, and the shapes. Large immutable parts are shared between copies of a library.
struct Library {
  std::vector<Mlp> net;
  std::vector<std::vector<double>> harmonics;  // coefficients of r(direction), order of kernels/sdf/harmonics.h
  std::vector<std::shared_ptr<MeshTree const>> mesh;
  std::vector<std::shared_ptr<SdfGrid const>> grid;
  std::vector<Shape> shape;
};

// Names of the analytic grains: "sphere", "ellipsoid", "superellipsoid", "box". Both throw std::invalid_argument.
char const* to_string(AnalyticKind kind);
AnalyticKind analytic_kind_from_string(std::string const& name);

// "analytic", "net", "harmonics", "mesh", "grid".
char const* to_string(ShapeKind kind);

// Everything wrong with a library (networks, indices, code sizes, non-finite figures, names), one sentence each that
// names the network or shape; empty = valid.
std::vector<std::string> problems(Library const& library);

// phi and optionally its gradient at x (units of d, body frame), in double: the readable reference for every kind.
double evaluate_reference(Library const& library, Shape const& shape, Vec3 x, Vec3* gradient = nullptr);

}  // namespace scree
