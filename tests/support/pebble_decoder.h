// pebble_decoder.h: a decoder with codes that needs no training, for tests: convex bodies of known kind.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "shapes/normalise.h"
#include "shapes/support_points.h"

namespace scree::test {

// phi = level - weight * sum_i softplus(n_i . x + z_0 n_ix^2 + z_1 n_iz^2) over 64 directions n_i: minus a convex
// function, so every body is convex, whatever the code: in one piece, without holes, phi rising inwards. z_0 > 0
// shortens it along x, z_1 > 0 along z. Radius about 0.5 and |grad phi| about 1 on the surface for z = 0.
inline Mlp pebble_net() {
  std::vector<Vec3> const n = quasi_uniform_directions(64);
  double constexpr level = 1.55, weight = 0.08;
  Mlp net;
  net.activation = Activation::softplus;
  net.parameter = 8;
  net.width = {5, 64, 1};
  net.weight.resize(2);
  for (int input = 0; input < 5; ++input)
    for (Vec3 const& d : n)
      net.weight[0].push_back(static_cast<float>(input < 3 ? d[input] : input == 3 ? d.x * d.x : d.z * d.z));
  net.weight[1].assign(64, static_cast<float>(-weight));
  net.bias = {std::vector<float>(64, 0), {static_cast<float>(level)}};
  return net;
}

inline Shape pebble(std::string const& name, float z0, float z1) {
  Shape s;
  s.name = name;
  s.kind = ShapeKind::net;
  s.net = 0;
  s.code = {z0, z1};
  s.certificate.gradient_p1 = 0.8;  // not measured: tests of the gate do that
  s.certificate.gradient_p99 = 1.2;
  return s;
}

// "flat/0..3" and "long/0..2", normalised.
inline Library pebble_library() {
  Library library;
  library.net.push_back(pebble_net());
  library.shape = {pebble("flat/0", 0.00f, 0.10f), pebble("flat/1", 0.03f, 0.20f),  pebble("flat/2", -0.03f, 0.16f),
                   pebble("flat/3", 0.02f, 0.12f), pebble("long/0", -0.15f, 0.05f), pebble("long/1", -0.20f, 0.02f),
                   pebble("long/2", -0.12f, 0.03f)};
  for (int i = 0; i < static_cast<int>(library.shape.size()); ++i) normalise_net(library, i, 1.0, {.cells = 24});
  return library;
}

}  // namespace scree::test
