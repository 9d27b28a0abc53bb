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
#include "kernels/sdf/mlp.h"

namespace scree {

// Where a network is evaluated: x_net = rotation * (x * scale) + shift, phi = phi_net / scale, and
// grad phi = rotation^T grad phi_net. Identity for single networks (folded into their first layer).
struct QueryTransform {
  Mat3 rotation;
  Vec3 shift;
  double scale = 1;
};

// What a shape promises and how far off it is, in units of d; measured by training and `scree-shape inspect`.
// A negative number means: not measured.
struct Certificate {
  double mae = -1, p99 = -1, max = -1;      // |phi - true distance| on the paper's shell
  double band_mae = -1;                     // the same on |phi| <= 0.05 d
  double normal_p50 = -1, normal_p95 = -1;  // [degrees]
  double gradient_p1 = -1, gradient_p5 = -1, gradient_p95 = -1, gradient_p99 = -1;  // |grad phi|
  double volume_error = -1, inertia_error = -1;                                     // relative, before normalisation
  double hausdorff = -1;                                                            // zero set against the source
  int components = -1;                                                              // of the zero set
  std::int64_t seed = -1;                                                           // of the training
  std::string source;                                                               // formula or mesh name
  std::string source_hash;  // of the mesh file, empty for formulas
  std::string made_with;    // library versions
};

struct Shape {
  std::string name;                     // "ballast/0"
  bool is_net = false;                  // else `analytic` defines phi
  AnalyticSdf analytic;                 // kind and sizes in units of d
  int net = -1;                         // index into Library::net
  std::vector<float> code;              // latent code; empty for single networks
  QueryTransform query;                 // networks only
  double volume = 0.52359877559829887;  // [d^3]; pi/6 by construction
  double area = 0;                      // surface area [d^2]
  Vec3 inertia;                         // principal, unit density [d^5]
  double bounding_radius = 0;  // of the zero set about the origin [d]; a network is never evaluated beyond 1.1 of it
  Box box;                     // of the zero set [d]
  double lipschitz = 1;        // upper bound of |grad phi| within 1.1 bounding_radius
  Certificate certificate;
};

struct Library {
  std::vector<Mlp> net;
  std::vector<Shape> shape;
};

// Names of the analytic grains: "sphere", "ellipsoid", "superellipsoid", "box". Both throw std::invalid_argument.
char const* to_string(AnalyticKind kind);
AnalyticKind analytic_kind_from_string(std::string const& name);

// Everything wrong with a library (networks, indices, code sizes, non-finite figures, names), one sentence each that
// names the network or shape; empty = valid.
std::vector<std::string> problems(Library const& library);

// phi and optionally its gradient at x (units of d, body frame), in double: the readable reference for every kind.
double evaluate_reference(Library const& library, Shape const& shape, Vec3 x, Vec3* gradient = nullptr);

}  // namespace scree
