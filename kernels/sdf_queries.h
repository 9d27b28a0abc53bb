// sdf_queries.h: phi and its gradient for points grouped by network; planes and all other shapes in double.
// Every stage that asks "how deep is this point in that body" goes through here, so they all see the same bits.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "kernels/base/queue.h"
#include "kernels/network_device.h"
#include "kernels/sdf/sdf_batch.h"
#include "kernels/views.h"

namespace scree {

// The networks of a scene with the first-layer biases of the shapes that use them.
struct NetworkSet {
  std::vector<PackedMlp> net;
  std::vector<std::vector<float>> bias_rows;  // of network i, bias_stride() floats a row
  std::shared_ptr<NetworkDevice> device;      // loaded with these; null: the host evaluates them
};

// Useful operations of one phi: two a weight. The code is folded into the first bias and costs nothing.
double flop_per_query(Mlp const& net);

// Groups of queries: one a network, then one for each other kind in the order of SdfKind; planes and formulas come
// last.
SCREE_HD inline int query_groups(int networks) { return networks + 4; }
SCREE_HD inline int query_group(SdfKind kind, int net, int networks) {
  return kind == SdfKind::net ? net : networks + static_cast<int>(kind) - 1;
}

// Points and the body (or -1 - plane) they are tested against; those of one group are contiguous.
struct QueryBatch {
  std::vector<Vec3> point;     // in the partner's body frame [partner's d]; planes: z = height above the plane [m]
  std::vector<int> partner;    // body, or -1 - plane
  std::vector<int> group;      // first item of each group, then the end (query_groups + 1)
  std::vector<double> phi;     // result [partner's d; m for planes]
  std::vector<Vec3> gradient;  // result, in the partner's body frame

  void resize(int n) {
    point.resize(n);
    partner.resize(n);
    phi.resize(n);
  }
  // Of networks evaluated by the host since the start: flop_per_query, and as many again for a gradient.
  double flop = 0;
  // Scratch, float images of the points in their network's frame; within a group those with a gradient come last.
  std::vector<int> net_slot;  // of each query of a network
  std::vector<Vec3f> net_point, net_gradient;
  std::vector<int> net_row;
  std::vector<float> net_phi;
};

// Fill phi, or phi and gradient, of all points. A point outside its partner's bounding sphere is outside by
// definition, phi = -(distance to that sphere): a network grows spurious solid beyond the ball it was trained in, and
// is never evaluated there; grids, meshes and radii follow the same rule, formulas do not need it.
void evaluate_phi(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch);
void evaluate_phi_gradient(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch);

// phi of all points, and in the same pass the gradient of those marked in `graded` (a flag a point): a point whose
// gradient is wanted anyway is then evaluated once. On a device, where both are one launch, the marks of networks'
// points are ignored and set where phi times the partner's diameter exceeds `gradient_from` [m]. The gradients of
// points without a mark mean nothing afterwards.
void evaluate_phi_and_marked_gradients(Queue const& queue, SceneView const& scene, NetworkSet const& networks,
                                       QueryBatch& batch, std::vector<char>& graded, double gradient_from);

}  // namespace scree
