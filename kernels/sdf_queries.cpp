// sdf_queries.cpp: see sdf_queries.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sdf_queries.h"

#include <limits>

#include "kernels/base/parallel.h"
#include "kernels/network_frame.h"
#include "kernels/sdf/harmonics.h"

namespace scree {
namespace {

struct ToNetworkFrame {
  SceneView scene;
  Span<const Vec3> point;
  Span<const int> partner, slot;
  Span<Vec3f> net_point;
  Span<int> net_row;

  SCREE_HD void operator()(int i) const {
    ShapeRecord const& shape = scene.shape_record(partner[i]);
    net_point[slot[i]] = to_network(network_frame(shape), scene.cohesion_reach, point[i]);
    net_row[slot[i]] = shape.bias_row;
  }
};

// Which of the points get a gradient beside their phi.
struct Gradients {
  bool any = false;
  Span<const char> marked;  // a flag a point; empty: all of them, if any

  SCREE_HD bool at(int i) const { return any && (marked.empty() || marked[i]); }
  Gradients of(int first, int count) const { return {any, marked.empty() ? marked : marked.subspan(first, count)}; }
};

struct FromNetwork {
  SceneView scene;
  Span<const Vec3> point;
  Span<const int> partner, slot;
  Span<const float> net_phi;
  Span<const Vec3f> net_gradient;
  Span<double> phi;
  Span<Vec3> gradient;
  Gradients gradients;

  SCREE_HD void operator()(int i) const {
    bool const with_gradient = gradients.at(i);
    from_network(network_frame(scene.shape_record(partner[i])), scene.cohesion_reach, point[i], net_phi[slot[i]],
                 with_gradient ? &net_gradient[slot[i]] : nullptr, phi[i], with_gradient ? &gradient[i] : nullptr);
  }
};

struct EvaluateAnalytic {
  SceneView scene;
  Span<const Vec3> point;
  Span<const int> partner;
  Span<double> phi;
  Span<Vec3> gradient;
  Gradients gradients;

  SCREE_HD void operator()(int i) const {
    Vec3* const g = gradients.at(i) ? &gradient[i] : nullptr;
    if (partner[i] < 0) {
      phi[i] = -point[i].z;
      if (g) *g = {0, 0, -1};
    } else {
      phi[i] = signed_distance(scene.shape_record(partner[i]).analytic, point[i], g);
    }
  }
};

struct HarmonicsOf {
  SCREE_HD double operator()(SceneView const& scene, ShapeRecord const& shape, Vec3 x, Vec3* gradient) const {
    Vec3 const own = shape.query_rotation * (x * shape.query_scale) + shape.query_shift;
    Span<const double> const c = scene.sdf.coefficient.subspan(shape.first_coefficient, shape.coefficients);
    double const phi = radial_distance(c, own, gradient);
    if (gradient) *gradient = transposed_times(shape.query_rotation, *gradient);
    return phi / shape.query_scale;
  }
};
struct GridOf {
  SCREE_HD double operator()(SceneView const& scene, ShapeRecord const& shape, Vec3 x, Vec3* gradient) const {
    Span<const float> const value(scene.sdf.grid_value.data + shape.first_value, static_cast<int>(shape.grid.points()));
    return grid_distance(shape.grid, value, x, gradient);
  }
};
struct MeshOf {
  SCREE_HD double operator()(SceneView const& scene, ShapeRecord const& shape, Vec3 x, Vec3* gradient) const {
    SdfDataView const& all = scene.sdf;
    std::size_t const triangle = shape.first_triangle;
    MeshSdf const mesh{
        all.mesh_node.subspan(shape.first_mesh_node, shape.mesh_nodes),
        {all.mesh_corner.data + 3 * triangle, 3 * shape.triangles},
        {all.mesh_normal.data + normals_per_triangle * triangle, normals_per_triangle * shape.triangles}};
    return shape.half_wall > 0 ? sheet_distance(mesh, shape.half_wall, x, gradient) : mesh_distance(mesh, x, gradient);
  }
};

template <class PhiOf>
struct EvaluateInBall {
  SceneView scene;
  Span<const Vec3> point;
  Span<const int> partner;
  Span<double> phi;
  Span<Vec3> gradient;
  Gradients gradients;

  SCREE_HD void operator()(int i) const {
    ShapeRecord const& shape = scene.shape_record(partner[i]);
    Vec3* const g = gradients.at(i) ? &gradient[i] : nullptr;
    double const r2 = norm2(point[i]);
    if (r2 > shape.bounding_radius * shape.bounding_radius && scene.cohesion_reach > 0) {
      phi[i] = PhiOf()(scene, shape, point_in_ball(point[i], shape.bounding_radius), g);
      continue_outside(point[i], shape.bounding_radius, phi[i], g);
    } else if (r2 > shape.bounding_radius * shape.bounding_radius) {
      phi[i] = phi_outside_ball(std::sqrt(r2), shape.bounding_radius);
      if (g) *g = point[i] * (-1 / std::sqrt(r2));
    } else {
      phi[i] = PhiOf()(scene, shape, point[i], g);
    }
  }
};

// Slots of the queries [first, end) of one network, those without a gradient first; returns where the others begin.
int assign_slots(Gradients const& gradients, int first, int end, Span<int> slot) {
  int begin = first;
  for (int i = first; i < end; ++i) begin += !gradients.at(i);
  int plain = first, graded = begin;
  for (int i = first; i < end; ++i) slot[i] = gradients.at(i) ? graded++ : plain++;
  return begin;
}

// Networks on the host: their frame, the network, and back.
void evaluate_networks(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch,
                       Gradients const& gradients) {
  int const net_items = batch.group[networks.net.size()];
  batch.net_slot.resize(net_items);
  batch.net_point.resize(net_items);
  batch.net_row.resize(net_items);
  batch.net_phi.resize(net_items);
  if (gradients.any) batch.net_gradient.resize(net_items);
  std::vector<int> graded_from(networks.net.size());
  for (std::size_t k = 0; k < networks.net.size(); ++k)
    graded_from[k] = assign_slots(gradients, batch.group[k], batch.group[k + 1], batch.net_slot);
  parallel_for(queue, "sdf_net/to_network", net_items,
               ToNetworkFrame{scene, batch.point, batch.partner, batch.net_slot, batch.net_point, batch.net_row}, 512);
  Span<const Vec3f> const points = batch.net_point;
  Span<const int> const rows = batch.net_row;
  Span<float> const values = batch.net_phi;
  for (std::size_t k = 0; k < networks.net.size(); ++k) {
    int const first = batch.group[k], middle = graded_from[k], end = batch.group[k + 1];
    batch.flop += flop_per_query(networks.net[k].net()) * (static_cast<double>(middle - first) + 2.0 * (end - middle));
    if (middle > first)
      sdf_forward(queue, networks.net[k], networks.bias_rows[k], points.subspan(first, middle - first),
                  rows.subspan(first, middle - first), values.subspan(first, middle - first));
    if (end > middle)
      sdf_forward_gradient(queue, networks.net[k], networks.bias_rows[k], points.subspan(middle, end - middle),
                           rows.subspan(middle, end - middle), values.subspan(middle, end - middle),
                           Span<Vec3f>(batch.net_gradient).subspan(middle, end - middle));
  }
  parallel_for(queue, "sdf_net/from_network", net_items,
               FromNetwork{scene, batch.point, batch.partner, batch.net_slot, batch.net_phi, batch.net_gradient,
                           batch.phi, batch.gradient, gradients},
               512);
}

// Everything that no network answers.
void evaluate_others(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch,
                     Gradients const& gradients) {
  Span<const Vec3> const point = batch.point;
  Span<const int> const partner = batch.partner;
  Span<double> const phi = batch.phi;
  auto const run = [&]<class Functor>(SdfKind kind, char const* name, Functor functor, int grain) {
    int const group = query_group(kind, -1, static_cast<int>(networks.net.size()));
    int const first = batch.group[group], count = batch.group[group + 1] - first;
    functor.scene = scene;
    functor.point = point.subspan(first, count), functor.partner = partner.subspan(first, count);
    functor.phi = phi.subspan(first, count);
    functor.gradients = gradients.of(first, count);
    if (gradients.any) functor.gradient = Span<Vec3>(batch.gradient).subspan(first, count);
    parallel_for(queue, name, count, functor, grain);
  };
  run(SdfKind::harmonics, "sdf_harmonics/evaluate", EvaluateInBall<HarmonicsOf>{}, 128);
  run(SdfKind::grid, "sdf_grid/evaluate", EvaluateInBall<GridOf>{}, 512);
  run(SdfKind::mesh, "sdf_mesh/evaluate", EvaluateInBall<MeshOf>{}, 64);
  run(SdfKind::analytic, "sdf_analytic/evaluate", EvaluateAnalytic{}, 128);
}

// Networks of a device mark those that it gives a gradient.
struct MarkGraded {
  SceneView scene;
  Span<const int> partner;
  Span<const double> phi;
  double gradient_from;
  Span<char> graded;

  SCREE_HD void operator()(int i) const { graded[i] = phi[i] * scene.diameter[partner[i]] > gradient_from; }
};

void evaluate(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch,
              bool with_gradient) {
  if (batch.point.empty()) return;
  double constexpr infinity = std::numeric_limits<double>::infinity();
  Gradients const gradients{with_gradient, {}};
  if (with_gradient) batch.gradient.resize(batch.point.size());
  if (networks.device)
    networks.device->evaluate(queue, batch, with_gradient ? -infinity : infinity);
  else
    evaluate_networks(queue, scene, networks, batch, gradients);
  evaluate_others(queue, scene, networks, batch, gradients);
}

}  // namespace

double flop_per_query(Mlp const& net) {
  double flop = 2.0 * 3 * net.width[1];
  for (int l = 1; l < net.layers(); ++l) flop += 2.0 * net.width[l] * net.width[l + 1];
  return flop;
}

void evaluate_phi(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch) {
  evaluate(queue, scene, networks, batch, false);
}

void evaluate_phi_gradient(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch) {
  evaluate(queue, scene, networks, batch, true);
}

void evaluate_phi_and_marked_gradients(Queue const& queue, SceneView const& scene, NetworkSet const& networks,
                                       QueryBatch& batch, std::vector<char>& graded, double gradient_from) {
  if (batch.point.empty()) return;
  batch.gradient.resize(batch.point.size());
  Gradients const gradients{true, graded};
  if (networks.device) {
    networks.device->evaluate(queue, batch, gradient_from);
    parallel_for(queue, "sdf_net/graded", batch.group[networks.net.size()],
                 MarkGraded{scene, batch.partner, batch.phi, gradient_from, graded}, 512);
  } else {
    evaluate_networks(queue, scene, networks, batch, gradients);
  }
  evaluate_others(queue, scene, networks, batch, gradients);
}

}  // namespace scree
