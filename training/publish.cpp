// publish.cpp: from a trained network to a model library.
// SPDX-License-Identifier: Apache-2.0
#include "training/publish.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "shapes/certify_phi.h"
#include "shapes/mesh/certify.h"
#include "shapes/normalise.h"

namespace scree {
namespace {

double largest_relative_error(Vec3 value, Vec3 truth) {
  double error = 0;
  for (int k = 0; k < 3; ++k) error = std::max(error, std::abs(value[k] / truth[k] - 1));
  return error;
}

}  // namespace

void publish_shape(Library& library, int index, Body const& body, PublishOptions const& options) {
  NormaliseOptions normalise;
  normalise.cells = options.cells;
  normalise.threads = options.threads;
  RawShape const raw = normalise_net(library, index, 1.1 * body.bounding_radius, normalise);
  Shape& shape = library.shape[index];
  Certificate& certificate = shape.certificate;
  certificate.volume_error = std::abs(raw.volume * 6 / std::numbers::pi - 1);
  certificate.inertia_error = largest_relative_error(raw.inertia, body.inertia);
  auto const distance = [&](Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient) {
    body.distance->evaluate(point, phi, gradient, options.threads);
  };
  CertifyTruth truth{distance, &body.mesh, body.exact_mesh};
  truth.inscribed_radius = body.inscribed_radius;
  truth.bounding_radius = body.bounding_radius;
  certify(fast_phi(library, shape, options.threads), truth, {raw.axes, raw.centroid, raw.diameter}, options.points,
          options.seed + 7919 * (index + 1), certificate);
  certify_phi(library, shape, {options.points, options.nodes, options.threads}, certificate);
}

Library publish(TrainedNet const& trained, std::vector<Body> const& bodies, PublishOptions const& options) {
  if (trained.code.size() != bodies.size()) throw std::invalid_argument("publish: a code a body is needed");
  Library library;
  library.net.push_back(trained.net);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    Shape shape;
    shape.name = bodies[b].name;
    shape.kind = ShapeKind::net;
    shape.net = 0;
    shape.code = trained.code[b];
    shape.certificate.seed = static_cast<std::int64_t>(options.seed);
    shape.certificate.source = bodies[b].source;
    shape.certificate.source_hash = bodies[b].source_hash;
    shape.certificate.made_with = trained.libraries;
    library.shape.push_back(shape);
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) publish_shape(library, static_cast<int>(b), bodies[b], options);
  return library;
}

}  // namespace scree
