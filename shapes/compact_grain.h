// compact_grain.h: a unique grain of a shared decoder in under 3 kB, made from its latent code in milliseconds.
// Star-shaped bodies only; others get make_surface_nodes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/node_storage.h"
#include "kernels/sdf/sdf_batch.h"
#include "shapes/direction_set.h"
#include "shapes/shape.h"
#include "shapes/star_rays.h"
#include "shapes/surface_nodes.h"

namespace scree {

// What the frame of shape.h needs (volume pi/6, centroid at 0, principal axes), and the nodes. Lengths in units of d.
struct CompactGrain {
  QueryTransform query;
  double area = 0;
  Vec3 inertia;
  double bounding_radius = 0;
  Box box;
  double lipschitz = 1;
  CompactRecord nodes;                                // of a scene that holds this grain's directions as set 0
  std::vector<std::uint16_t> radius;                  // (directions)
  std::vector<std::uint8_t> block_reach, block_ball;  // (surface and core blocks)
};

// phi in the frame and unit it comes in, meaningful within `ball` of the origin, near which the body's centre lies.
// Rays run from the centroid along `set`, stretched to the body's inertia ellipsoid; query, mass, bounds and nodes
// follow from where they leave the body: volume to about 3e-4, see shapes/README.md. `lipschitz`: a known bound of
// |grad phi|; 400 gradients are sampled to raise it where it is too small. Cost: about 11,000 evaluations of phi for
// 1,000 directions. `grain` is complete when the result is GrainFault::none. Deterministic and serial.
GrainFault make_compact_grain(PhiBatch const& phi, double ball, double lipschitz, DirectionSet const& set,
                              CompactGrain& grain);

// Grains of one decoder of a library. The ball is 1.1 times the bounding sphere of the library's own shapes of this
// network, the Lipschitz bound the largest of theirs. Thread-safe once made.
class CompactGrainMaker {
 public:
  // Throws std::invalid_argument when no shape of the library uses network `net`, or for a bad number of nodes.
  CompactGrainMaker(Library const& library, int net, int nodes);

  // Throws std::invalid_argument for a code of the wrong length.
  GrainFault make(Span<const float> code, CompactGrain& grain) const;
  DirectionSet const& directions() const { return set_; }
  double ball() const { return ball_; }

 private:
  PackedMlp net_;
  DirectionSet set_;
  double ball_ = 0, lipschitz_ = 1;
};

// The frame, mass and bounds of the grain into a shape of the same phi.
void adopt(CompactGrain const& grain, Shape& shape);

// The grain as any other shape of the library whose network `net` made it.
Shape to_shape(CompactGrain const& grain, int net, Span<const float> code, std::string name);

// The same nodes as arrays, read through the kernels' accessors: for meters and tests.
SurfaceNodes explicit_nodes(CompactGrain const& grain, DirectionSet const& set);

}  // namespace scree
