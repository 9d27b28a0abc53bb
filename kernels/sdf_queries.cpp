// sdf_queries.cpp: see sdf_queries.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sdf_queries.h"

#include "kernels/base/parallel.h"
#include "kernels/sdf/harmonics.h"

namespace scree {
namespace {

// The point of the ball on the same ray, or the point itself inside.
SCREE_HD Vec3 point_in_ball(Vec3 x, double radius) {
  double const r2 = norm2(x);
  return r2 > radius * radius ? x * (radius / std::sqrt(r2)) : x;
}

struct ToNetworkFrame {
  SceneView scene;
  Span<const Vec3> point;
  Span<const int> partner;
  Span<Vec3f> net_point;
  Span<int> net_row;

  SCREE_HD void operator()(int i) const {
    ShapeRecord const& shape = scene.shape_record(partner[i]);
    // A point beyond the ball is answered without the network; the ball's centre keeps the evaluator's input tame.
    Vec3 x = norm2(point[i]) <= shape.bounding_radius * shape.bounding_radius ? point[i] : Vec3{};
    if (scene.cohesion_reach > 0) x = point_in_ball(point[i], shape.bounding_radius);
    net_point[i] = to_float(shape.query_rotation * (x * shape.query_scale) + shape.query_shift);
    net_row[i] = shape.bias_row;
  }
};

// Continues phi beyond the ball, from its value and gradient at the point on the ball.
SCREE_HD void continue_outside(Vec3 x, double radius, double& phi, Vec3* gradient) {
  double const r = norm(x);
  Vec3 const along = x / r;
  phi += phi_outside_ball(r, radius);
  if (gradient) *gradient = (*gradient - along * dot(along, *gradient)) * (radius / r) - along;
}

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
    if (!(outside && scene.cohesion_reach > 0)) return;
    phi[i] = net_phi[i] / shape.query_scale;
    continue_outside(point[i], shape.bounding_radius, phi[i], net_gradient.empty() ? nullptr : &gradient[i]);
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

}  // namespace

void evaluate_phi(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch) {
  evaluate(queue, scene, networks, batch, false);
}

void evaluate_phi_gradient(Queue const& queue, SceneView const& scene, NetworkSet const& networks, QueryBatch& batch) {
  evaluate(queue, scene, networks, batch, true);
}

}  // namespace scree
