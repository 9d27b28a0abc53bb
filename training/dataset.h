// dataset.h: bodies to learn and samples of their signed distance.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernels/base/vec.h"
#include "shapes/shape.h"
#include "shapes/triangle_mesh.h"
#include "training/options.h"
#include "training/truth.h"

namespace scree {

// One body with its truth, normalised: d = 1, centroid at the origin, principal axes along x, y, z.
struct Body {
  std::string name;         // "ballast/0"
  std::string source;       // formula or mesh name
  std::string source_hash;  // of the mesh file, empty for formulas
  TriangleMesh mesh;        // closed; a formula's is triangulated, its vertices on the surface
  std::shared_ptr<Truth const> distance;
  bool exact_mesh = true;       // `mesh` is the truth itself, not a triangulation of it
  Vec3 inertia;                 // principal, unit density [d^5]
  double inscribed_radius = 0;  // distance of the centroid from the surface [d]; 0 if the centroid is outside
  double bounding_radius = 0;   // about the centroid [d]
};

// The mesh is the truth. Throws std::invalid_argument naming the defect if it is not closed, or not normalised to 1e-6.
Body make_body(std::string name, TriangleMesh mesh, std::string source, std::string source_hash = {});

// The formula is the truth: true Euclidean distances, exact volume and inertia. Throws std::invalid_argument for a
// shape that is no formula.
Body make_body(std::string name, Shape const& analytic);

struct Samples {
  std::vector<Vec3> point;     // [d]
  std::vector<double> phi;     // signed distance, positive inside [d]
  std::vector<Vec3> gradient;  // of phi, unit length
};

// Training samples as SamplingOptions says, in random order. Deterministic in `seed`, whatever the threads.
Samples training_samples(Body const& body, SamplingOptions const& options, std::uint64_t seed, int threads);

// The paper's region: uniform in volume between 0.9 inscribed and 1.1 bounding radius.
Samples shell_samples(Body const& body, int count, std::uint64_t seed, int threads);

// On the surface, uniform in area; gradient = inward normal, phi = 0.
Samples surface_samples(Body const& body, int count, std::uint64_t seed);

}  // namespace scree
