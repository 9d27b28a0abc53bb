// publish.h: from a trained network to a model library: normalisation by phi's own zero set, measured certificates.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "shapes/shape.h"
#include "training/dataset.h"
#include "training/train.h"

namespace scree {

struct PublishOptions {
  int points = 20000;      // of each measurement: shell, band, surface, interior
  int cells = 64;          // grid cells across the ball in which the zero set is sought
  int nodes = 4000;        // surface nodes whose blind gap is measured; 0: none
  std::uint64_t seed = 1;  // of the training: recorded; the test points are others than the training's
  int threads = 2;
};

// One library with one network and a shape a body, in the bodies' order. Each shape is normalised from its own zero
// set; the truth it is then measured against is the body's mesh, moved and scaled by the same transform. Volume and
// inertia errors are those before. Throws std::runtime_error naming the body if its network is
// no solid.
Library publish(TrainedNet const& trained, std::vector<Body> const& bodies, PublishOptions const& options);

// The same for shape `index` of a library: its query takes the body's frame to the network's, and becomes that of the
// normalised shape. The certificate's seed, source and versions are left as they are.
void publish_shape(Library& library, int index, Body const& body, PublishOptions const& options);

}  // namespace scree
