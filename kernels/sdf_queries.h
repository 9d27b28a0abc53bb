// sdf_queries.h: phi and its gradient for points grouped by network; planes and analytic shapes in double.
// Every stage that asks "how deep is this point in that body" goes through here, so they all see the same bits.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/base/queue.h"
#include "kernels/sdf/sdf_batch.h"
#include "kernels/views.h"

namespace scree {

// The networks of a scene with the first-layer biases of the shapes that use them.
struct NetworkSet {
  std::vector<PackedMlp> net;
  std::vector<std::vector<float>> bias_rows;  // of network i, bias_stride() floats a row
};

// Points and the body (or -1 - plane) they are tested against; those of one network are contiguous, analytic
// partners and planes come last.
struct QueryBatch {
  std::vector<Vec3> point;     // in the partner's body frame [partner's d]; planes: z = height above the plane [m]
  std::vector<int> partner;    // body, or -1 - plane
  std::vector<int> group;      // first item of each network, then of the analytic rest, then the end (networks + 2)
  std::vector<double> phi;     // result [partner's d; m for planes]
  std::vector<Vec3> gradient;  // result, in the partner's body frame

  void resize(int n) {
    point.resize(n);
    partner.resize(n);
    phi.resize(n);
  }
  // Scratch, float images of the points in their network's frame.
  std::vector<Vec3f> net_point, net_gradient;
  std::vector<int> net_row;
  std::vector<float> net_phi;
};

// Fill phi, or phi and gradient, of all points. A point outside its partner's bounding sphere is outside by
// definition, phi = -(distance to that sphere): a network grows spurious solid beyond the ball it was trained in, and
// is never evaluated there.
void evaluate_phi(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch);
void evaluate_phi_gradient(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch);

// phi from outside the bounding sphere: a bound, not a distance.
SCREE_HD inline double phi_outside_ball(double distance_to_centre, double radius) {
  return radius - distance_to_centre;
}

}  // namespace scree
