// dataset.h: bodies to learn and samples of their signed distance.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernels/base/vec.h"
#include "shapes/mesh/mesh_distance.h"
#include "shapes/triangle_mesh.h"
#include "training/options.h"

namespace scree {

// One body with its truth: the signed distance to a closed, normalised mesh (d = 1).
struct Body {
  std::string name;         // "ballast/0"
  std::string source;       // formula or mesh name
  std::string source_hash;  // of the mesh file, empty for formulas
  TriangleMesh mesh;        // volume pi/6, centroid at the origin, principal axes along x, y, z
  std::shared_ptr<MeshDistance const> distance;
  double inscribed_radius = 0;  // distance of the centroid from the surface [d]; 0 if the centroid is outside
  double bounding_radius = 0;   // of the mesh about the centroid [d]
};

// Throws std::invalid_argument naming the defect if the mesh is not closed, or not normalised to 1e-6.
Body make_body(std::string name, TriangleMesh mesh, std::string source, std::string source_hash = {});

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
