// normalise.h: bring a trained network or a radius into the frame of shape.h, by the volume, centroid and principal
// axes of its own zero set: what is simulated is phi, not the mesh it was made from.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/phi_batch.h"
#include "shapes/shape.h"

namespace scree {

struct NormaliseOptions {
  int cells = 48;                  // grid cells across the ball's diameter
  int lipschitz_samples = 100000;  // points in 1.1 bounding radii at which |grad phi| is taken
  double lipschitz_factor = 1.1;   // what the bound adds to the largest sample
  int threads = 1;
};

// What the network was before, in the units and frame it came in.
struct RawShape {
  double volume = 0;
  double area = 0;
  double diameter = 0;  // of the equal-volume sphere
  Vec3 centroid;
  Vec3 inertia;  // principal, unit density, ascending
  Mat3 axes;     // rows: the principal axes; x_normalised = axes (x_raw - centroid) / diameter
  int components = 0;
  int euler_characteristic = 0;
};

// Normalise shape `index` (a network or harmonics) of the library, in place, and fill in volume (pi/6), area, inertia,
// bounding radius, box and Lipschitz bound, and the certificate's `components`. x is the axis of least inertia, z of
// the largest; the rotation is proper. On entry the shape's phi (network, code and query transform, usually the
// identity) is meaningful within `raw_radius` of the origin. A network without latent code that no other shape uses
// takes the transform into its first and last layer; else it goes into Shape::query. Bounding radius and box enclose
// the refined extreme points with a margin of 1e-4. Throws std::runtime_error when there is no zero set or its volume
// is not positive. The Lipschitz bound of harmonics is left to add_harmonic_shape: the radial distance has none at its
// centre.
RawShape normalise_shape(Library& library, int index, double raw_radius, NormaliseOptions const& options = {});

// The same, refusing what is not a network with std::invalid_argument.
RawShape normalise_net(Library& library, int index, double raw_radius, NormaliseOptions const& options = {});

// Principal moments in ascending order and a right-handed frame of axes (rows). The first two axes have their largest
// component positive, so that the frame does not depend on the solver.
void principal_axes(Mat3 const& inertia, Vec3& moment, Mat3& axes);

// Largest |grad phi| at `samples` quasi-random points of the ball, times `factor`. Deterministic.
double sampled_lipschitz(PhiBatch const& phi, double radius, int samples, double factor);

}  // namespace scree
