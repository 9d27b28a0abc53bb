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
  Span<const int> partner;
  Span<Vec3f> net_point;
  Span<int> net_row;

  SCREE_HD void operator()(int i) const {
    ShapeRecord const& shape = scene.shape_record(partner[i]);
    net_point[i] = to_network(network_frame(shape), scene.cohesion_reach, point[i]);
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
    bool const with_gradient = !net_gradient.empty();
    from_network(network_frame(scene.shape_record(partner[i])), scene.cohesion_reach, point[i], net_phi[i],
                 with_gradient ? &net_gradient[i] : nullptr, phi[i], with_gradient ? &gradient[i] : nullptr);
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
  Span<Vec3> gradient;  // empty: phi only

  SCREE_HD void operator()(int i) const {
    ShapeRecord const& shape = scene.shape_record(partner[i]);
    Vec3* const g = gradient.empty() ? nullptr : &gradient[i];
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

// Networks on the host: their frame, the network, and back.
void evaluate_networks(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch,
                       bool with_gradient) {
  int const net_items = batch.group[networks.net.size()];
  batch.net_point.resize(net_items);
  batch.net_row.resize(net_items);
  batch.net_phi.resize(net_items);
  if (with_gradient) batch.net_gradient.resize(net_items);
  parallel_for(queue, "sdf_net/to_network", net_items,
               ToNetworkFrame{scene, batch.point, batch.partner, batch.net_point, batch.net_row}, 512);
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
               FromNetwork{scene, batch.point, batch.partner, batch.net_phi,
                           with_gradient ? Span<const Vec3f>(batch.net_gradient) : Span<const Vec3f>(), batch.phi,
                           with_gradient ? Span<Vec3>(batch.gradient) : Span<Vec3>()},
               512);
}

// Everything that no network answers.
void evaluate_others(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch,
                     bool with_gradient) {
  Span<const Vec3> const point = batch.point;
  Span<const int> const partner = batch.partner;
  Span<double> const phi = batch.phi;
  Span<Vec3> const gradient = with_gradient ? Span<Vec3>(batch.gradient) : Span<Vec3>();
  auto const run = [&]<class Functor>(SdfKind kind, char const* name, Functor functor, int grain) {
    int const group = query_group(kind, -1, static_cast<int>(networks.net.size()));
    int const first = batch.group[group], count = batch.group[group + 1] - first;
    functor.scene = scene;
    functor.point = point.subspan(first, count), functor.partner = partner.subspan(first, count);
    functor.phi = phi.subspan(first, count);
    if (with_gradient) functor.gradient = gradient.subspan(first, count);
    parallel_for(queue, name, count, functor, grain);
  };
  run(SdfKind::harmonics, "sdf_harmonics/evaluate", EvaluateInBall<HarmonicsOf>{}, 128);
  run(SdfKind::grid, "sdf_grid/evaluate", EvaluateInBall<GridOf>{}, 512);
  run(SdfKind::mesh, "sdf_mesh/evaluate", EvaluateInBall<MeshOf>{}, 64);
  run(SdfKind::analytic, "sdf_analytic/evaluate", EvaluateAnalytic{}, 128);
}

// `gradient_from` [m]: gradients where phi times diameter is above it.
double constexpr everywhere = -std::numeric_limits<double>::infinity();
double constexpr nowhere = std::numeric_limits<double>::infinity();

void evaluate(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch,
              bool with_gradient) {
  if (batch.point.empty()) return;
  if (with_gradient) batch.gradient.resize(batch.point.size());
  if (networks.device)
    networks.device->evaluate(queue, batch, with_gradient ? everywhere : nowhere);
  else
    evaluate_networks(queue, scene, networks, batch, with_gradient);
  evaluate_others(queue, scene, networks, batch, with_gradient);
}

}  // namespace

void evaluate_phi(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch) {
  evaluate(queue, scene, networks, batch, false);
}

void evaluate_phi_gradient(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch) {
  evaluate(queue, scene, networks, batch, true);
}

bool evaluate_phi_and_some_gradients(Queue const& queue, SceneView const& scene, NetworkSet const& networks,
                                     QueryBatch& batch, double gradient_from) {
  if (!networks.device || batch.point.empty()) {
    evaluate(queue, scene, networks, batch, false);
    return false;
  }
  batch.gradient.resize(batch.point.size());
  networks.device->evaluate(queue, batch, gradient_from);
  evaluate_others(queue, scene, networks, batch, false);
  return true;
}

void evaluate_others_phi_gradient(Queue const& queue, SceneView const& scene, NetworkSet const& networks,
                                  QueryBatch& batch) {
  if (batch.point.empty()) return;
  batch.gradient.resize(batch.point.size());
  evaluate_others(queue, scene, networks, batch, true);
}

}  // namespace scree
