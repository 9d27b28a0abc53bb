// training_bodies.h: a body and options for trainings of a second.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "shapes/mesh/icosphere.h"
#include "shapes/mesh_normalise.h"
#include "training/dataset.h"
#include "training/options.h"

namespace scree {

// An ellipsoid with semi-axes `axes` before normalisation, as a mesh.
inline Body ellipsoid_body(std::string const& name, Vec3 axes, int subdivisions = 3) {
  TriangleMesh mesh = icosphere(subdivisions);
  for (Vec3& v : mesh.vertex) v = multiply(v, axes);
  return make_body(name, normalised(mesh), "ellipsoid");
}

inline TrainOptions tiny_options() {
  TrainOptions options;
  options.layers = 2;
  options.width = 16;
  options.steps = 200;
  options.rows = 256;
  options.test_count = 500;
  options.samples.count = 4000;
  return options;
}

}  // namespace scree
