// shape_kinds.h: one shape of every kind, small, made without files.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "kernels/sdf/harmonics.h"
#include "shapes/analytic_shapes.h"
#include "shapes/bake.h"
#include "shapes/harmonic_shape.h"
#include "shapes/mesh_shape.h"
#include "shapes/normalise.h"
#include "tests/support/l_prism.h"

namespace scree::testing {

// A convex network: phi(x, code) = c - sum of a_i softplus(n_i . x + code_i - h), n_i spread over the sphere. The first
// codes shift single faces. |grad phi| runs from about 0.7 to 1.3.
inline Mlp softplus_body(int code_size) {
  int const width = 24;
  Mlp net;
  net.activation = Activation::softplus;
  net.parameter = 12;
  net.width = {3 + code_size, width, 1};
  net.weight = {std::vector<float>(std::size_t(3 + code_size) * width), std::vector<float>(width)};
  net.bias = {std::vector<float>(width, -0.15f), {0.55f}};
  for (int i = 0; i < width; ++i) {
    double const z = 1 - 2 * (i + 0.5) / width, r = std::sqrt(1 - z * z), turn = 2.399963 * i;
    double const n[3] = {r * std::cos(turn), r * std::sin(turn), z};
    for (int k = 0; k < 3; ++k) net.weight[0][k * width + i] = static_cast<float>(n[k]);
    if (i < code_size) net.weight[0][(3 + i) * width + i] = 1;
    net.weight[1][i] = static_cast<float>(-0.25 - 0.08 * n[0] - 0.05 * n[2]);
  }
  return net;
}

// A smooth lobed star-shaped body of degree 4, about 0.4 to 0.6 in radius.
inline std::vector<double> lobed_radius() {
  std::vector<double> c(harmonic_count(4), 0.0);
  c[0] = 0.5 * std::sqrt(4 * 3.141592653589793);
  c[harmonic_index(2, 0)] = -0.09;
  c[harmonic_index(2, 2)] = 0.06;
  c[harmonic_index(3, -2)] = 0.05;
  c[harmonic_index(4, 3)] = 0.03;
  c[harmonic_index(1, 0)] = 0.02;
  return c;
}

inline char const* const all_kinds[] = {"sphere",    "ellipsoid", "superellipsoid", "box", "single_net",
                                        "coded_net", "harmonics", "mesh",           "grid"};

// A library with one shape, normalised, of the kind so called.
inline Library library_of_kind(std::string const& kind) {
  Library library;
  if (kind == "sphere") library.shape = {builtin_shape("sphere")};
  if (kind == "ellipsoid") library.shape = {builtin_shape("ellipsoid:1:0.8:0.6")};
  if (kind == "superellipsoid") library.shape = {builtin_shape("superellipsoid:1:0.8:0.7:0.8")};
  if (kind == "box") library.shape = {builtin_shape("box:1:0.8:0.6")};
  if (kind == "single_net" || kind == "coded_net") {
    library.net = {softplus_body(kind == "coded_net" ? 2 : 0)};
    Shape shape;
    shape.kind = ShapeKind::net;
    shape.net = 0;
    if (kind == "coded_net") shape.code = {0.1f, -0.05f};
    library.shape = {shape};
    normalise_net(library, 0, 1.5);
    Certificate& c = library.shape[0].certificate;  // the gate wants figures; the tests measure the gradient again
    c.gradient_p1 = 0.7, c.gradient_p99 = 1.4, c.falling = 0, c.euler = 2;
  }
  if (kind == "harmonics") add_harmonic_shape(library, kind, lobed_radius());
  if (kind == "mesh") add_mesh_shape(library, kind, l_prism());
  if (kind == "grid") {
    library.shape = {builtin_shape("ellipsoid:1:0.8:0.6")};
    library = bake_grid(library, library.shape[0], 24);
  }
  library.shape.at(0).name = kind;
  return library;
}

}  // namespace scree::testing
