// sdf_queries.cpp: see sdf_queries.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sdf_queries.h"

#include "kernels/base/parallel.h"

namespace scree {
namespace {

struct ToNetworkFrame {
  SceneView scene;
  Span<const Vec3> point;
  Span<const int> partner;
  Span<Vec3f> net_point;
  Span<int> net_row;

  SCREE_HD void operator()(int i) const {
    ShapeRecord const& shape = scene.shape_record(partner[i]);
    // A point beyond the ball is answered without the network; the ball's centre keeps the evaluator's input tame.
    Vec3 const x = norm2(point[i]) <= shape.bounding_radius * shape.bounding_radius ? point[i] : Vec3{};
    net_point[i] = to_float(shape.query_rotation * (x * shape.query_scale) + shape.query_shift);
    net_row[i] = shape.bias_row;
  }
};

struct FromNetwork {
  SceneView scene;
  Span<const Vec3> point;
  Span<const int> partner;
  Span<const float> net_phi;
  Span<const Vec3f> net_gradient;  // empty: phi only
  Span<double> phi;
  Span<Vec3> gradient;

  SCREE_HD void operator()(int i) const {
    ShapeRecord const& shape = scene.shape_record(partner[i]);
    double const r2 = norm2(point[i]);
    bool const outside = r2 > shape.bounding_radius * shape.bounding_radius;
    phi[i] = outside ? phi_outside_ball(std::sqrt(r2), shape.bounding_radius) : net_phi[i] / shape.query_scale;
    if (!net_gradient.empty()) gradient[i] = transposed_times(shape.query_rotation, to_double(net_gradient[i]));
  }
};

struct EvaluateAnalytic {
  SceneView scene;
  Span<const Vec3> point;
  Span<const int> partner;
  Span<double> phi;
  Span<Vec3> gradient;  // empty: phi only

  SCREE_HD void operator()(int i) const {
    Vec3* const g = gradient.empty() ? nullptr : &gradient[i];
    if (partner[i] < 0) {
      phi[i] = -point[i].z;
      if (g) *g = {0, 0, -1};
    } else {
      phi[i] = signed_distance(scene.shape_record(partner[i]).analytic, point[i], g);
    }
  }
};

void evaluate(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch,
              bool with_gradient) {
  int const n = static_cast<int>(batch.point.size());
  if (n == 0) return;
  Span<const Vec3> const point = batch.point;
  Span<const int> const partner = batch.partner;
  Span<double> const phi = batch.phi;
  if (with_gradient) batch.gradient.resize(n);
  Span<Vec3> const gradient = with_gradient ? Span<Vec3>(batch.gradient) : Span<Vec3>();
  int const net_items = batch.group[networks.net.size()];
  batch.net_point.resize(net_items);
  batch.net_row.resize(net_items);
  batch.net_phi.resize(net_items);
  if (with_gradient) batch.net_gradient.resize(net_items);
  parallel_for(queue, "sdf_net/to_network", net_items,
               ToNetworkFrame{scene, point, partner, batch.net_point, batch.net_row}, 512);
  for (std::size_t k = 0; k < networks.net.size(); ++k) {
    int const first = batch.group[k], count = batch.group[k + 1] - first;
    if (count == 0) continue;
    Span<const Vec3f> const points = Span<const Vec3f>(batch.net_point).subspan(first, count);
    Span<const int> const rows = Span<const int>(batch.net_row).subspan(first, count);
    Span<float> const values = Span<float>(batch.net_phi).subspan(first, count);
    if (with_gradient)
      sdf_forward_gradient(queue, networks.net[k], networks.bias_rows[k], points, rows, values,
                           Span<Vec3f>(batch.net_gradient).subspan(first, count));
    else
      sdf_forward(queue, networks.net[k], networks.bias_rows[k], points, rows, values);
  }
  parallel_for(queue, "sdf_net/from_network", net_items,
               FromNetwork{scene, point, partner, batch.net_phi,
                           with_gradient ? Span<const Vec3f>(batch.net_gradient) : Span<const Vec3f>(), phi, gradient},
               512);
  int const rest = n - net_items;
  parallel_for(
      queue, "sdf_analytic/evaluate", rest,
      EvaluateAnalytic{scene, point.subspan(net_items, rest), partner.subspan(net_items, rest),
                       phi.subspan(net_items, rest), with_gradient ? gradient.subspan(net_items, rest) : Span<Vec3>()},
      128);
}

}  // namespace

void evaluate_phi(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch) {
  evaluate(queue, scene, networks, batch, false);
}

void evaluate_phi_gradient(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch) {
  evaluate(queue, scene, networks, batch, true);
}

}  // namespace scree
