// box_network.h: a box as a network, written down instead of trained: exact faces, a model file for cases.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "shapes/certify_phi.h"
#include "shapes/model_file.h"
#include "shapes/normalise.h"

namespace scree::book {

// phi = min(hx - |x|, hy - |y|, hz - |z|) from leaky units of slope 0: |x| = relu(x) + relu(-x), and
// min(u, v) = v - relu(v - u), where v goes through a unit that it keeps positive.
inline Mlp box_network(Vec3 half) {
  Mlp net;
  net.activation = Activation::leaky_relu;
  net.parameter = 0;
  net.width = {3, 6, 3, 2, 1};
  float const lift = 8;  // above every value that has to pass
  auto const matrix = [](int in, int out) { return std::vector<float>(static_cast<std::size_t>(in) * out, 0.0f); };
  std::vector<float> first = matrix(3, 6);  // [in * out + out]: x, -x, y, -y, z, -z
  for (int axis = 0; axis < 3; ++axis) first[axis * 6 + 2 * axis] = 1, first[axis * 6 + 2 * axis + 1] = -1;
  // u, v, w: distances to the faces. Second layer: v - u, v + lift, w + lift.
  std::vector<float> second = matrix(6, 3);
  for (int sign = 0; sign < 2; ++sign) {
    second[(0 + sign) * 3 + 0] = 1, second[(2 + sign) * 3 + 0] = -1;
    second[(2 + sign) * 3 + 1] = -1;
    second[(4 + sign) * 3 + 2] = -1;
  }
  float const hx = static_cast<float>(half.x), hy = static_cast<float>(half.y), hz = static_cast<float>(half.z);
  // Third: with m = min(u, v) = (v + lift) - relu(v - u) - lift: w - m, w + lift.
  std::vector<float> third = matrix(3, 2);
  third[0 * 2 + 0] = 1, third[1 * 2 + 0] = -1, third[2 * 2 + 0] = 1;
  third[2 * 2 + 1] = 1;
  net.weight = {first, second, third, {-1, 1}};  // min(m, w) = (w + lift) - relu(w - m) - lift
  net.bias = {std::vector<float>(6, 0.0f), {hy - hx, hy + lift, hz + lift}, {0, 0}, {-lift}};
  return net;
}

// A model file with the box as a single network called "box", normalised and certified by its own phi.
inline void write_box_network(std::filesystem::path const& file, Vec3 half) {
  Library library;
  library.net = {box_network(half)};
  Shape shape;
  shape.name = "box";
  shape.kind = ShapeKind::net;
  shape.net = 0;
  library.shape = {shape};
  normalise_net(library, 0, 1.2 * norm(half));
  certify_phi(library, library.shape[0], {2000, 1000, 1}, library.shape[0].certificate);
  write_model(file, library, true);
}

}  // namespace scree::book
