// phi_batch.cpp: see phi_batch.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/phi_batch.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "kernels/sdf/harmonics.h"
#include "kernels/sdf/sdf_batch.h"
#include "shapes/harmonic_shape.h"

namespace scree {
namespace {

// A network with its bias row, and the transform of one shape.
struct FastNet {
  PackedMlp net;
  std::vector<float> bias;
  QueryTransform query;
  Queue queue;

  FastNet(Library const& library, Shape const& shape, int threads)
      : net(library.net.at(static_cast<std::size_t>(shape.net))), query(shape.query) {
    net.append_bias(fold_code(net.net(), shape.code), bias);
    queue.threads = threads;
  }

  void operator()(Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient) const {
    int const n = point.size();
    std::vector<Vec3f> x(n);
    std::vector<float> value(n);
    for (int i = 0; i < n; ++i) x[i] = to_float(query(point[i]));
    if (gradient.empty()) {
      sdf_forward(queue, net, bias, x, {}, value);
    } else {
      std::vector<Vec3f> g(n);
      sdf_forward_gradient(queue, net, bias, x, {}, value, g);
      for (int i = 0; i < n; ++i) gradient[i] = transposed_times(query.rotation, to_double(g[i]));
    }
    for (int i = 0; i < n; ++i) phi[i] = value[i] / query.scale;
  }
};

// r_in (1 - rho): rho is homogeneous of degree 1, so grad rho . x = rho gives the length of its gradient.
struct GaugeField {
  detail::Superellipsoid shape;
  double inner_radius;  // of the largest centred ball that fits; 1 / inner_radius bounds |grad rho|

  explicit GaugeField(AnalyticSdf const& s) : shape{s.half_size, 2 / s.exponent_ew, 2 / s.exponent_ns} {
    // Convex body: the ball of the polar radius min over the surface of n . x; the octahedron on the semi-axes is
    // inside.
    Vec3 const a = s.half_size;
    inner_radius = 1 / norm(Vec3{1 / a.x, 1 / a.y, 1 / a.z});
  }
  double at(Vec3 x, Vec3* gradient) const {
    // Off the symmetry planes by 1e-12: powers of zero have no slope there.
    Vec3 y;
    for (int i = 0; i < 3; ++i) y[i] = std::max(std::abs(x[i]), 1e-12 * shape.a[i]);
    double const rho = shape.gauge(y);
    if (gradient) {
      Vec3 const n = shape.normal(y);
      Vec3 const g = n * (-inner_radius * rho / dot(n, y));
      *gradient = {x.x < 0 ? -g.x : g.x, x.y < 0 ? -g.y : g.y, x.z < 0 ? -g.z : g.z};
    }
    return inner_radius * (1 - rho);
  }
};

// The fields below are evaluated point by point in double: at(x, gradient or null).
struct AnalyticField {
  AnalyticSdf sdf;
  double at(Vec3 x, Vec3* gradient) const { return signed_distance(sdf, x, gradient); }
};
struct MeshField {
  std::shared_ptr<MeshTree const> tree;
  double at(Vec3 x, Vec3* gradient) const { return mesh_distance(tree->sdf(), x, gradient); }
};
struct GridField {
  std::shared_ptr<SdfGrid const> grid;
  double at(Vec3 x, Vec3* gradient) const { return grid_distance(grid->frame, grid->value, x, gradient); }
};
struct RadialField {
  std::vector<double> coefficient;
  QueryTransform query;
  double at(Vec3 x, Vec3* gradient) const {
    double const phi = radial_distance(coefficient, query(x), gradient);
    if (gradient) *gradient = transposed_times(query.rotation, *gradient);
    return phi / query.scale;
  }
};

// r_min (1 - |x| / r): the gauge of a star-shaped body. Unlike the radial distance it is smooth up to the centre.
struct RadialGauge {
  std::vector<double> coefficient;
  QueryTransform query;
  double inner_radius;

  double at(Vec3 x, Vec3* gradient) const {
    Vec3 const own = query(x);
    double const length = norm(own);
    Vec3 const n = length > 0 ? own / length : Vec3{0, 0, 1};
    Vec3 slope;
    double const r = harmonic_radius(coefficient, n, gradient ? &slope : nullptr);
    if (gradient) *gradient = transposed_times(query.rotation, (slope / r - n) * (inner_radius / r));
    return inner_radius * (1 - length / r) / query.scale;
  }
};

template <class Field>
PhiBatch pointwise(Field const& field, int threads) {
  return [field, threads](Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient) {
    int const n = point.size();
#pragma omp parallel for schedule(dynamic, 64) num_threads(threads) if (threads > 1 && n > 256)
    for (int i = 0; i < n; ++i) phi[i] = field.at(point[i], gradient.empty() ? nullptr : &gradient[i]);
  };
}

}  // namespace

PhiBatch reference_phi(Library const& library, Shape const& shape) {
  return [&library, &shape](Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient) {
    for (int i = 0; i < point.size(); ++i)
      phi[i] = evaluate_reference(library, shape, point[i], gradient.empty() ? nullptr : &gradient[i]);
  };
}

PhiBatch fast_phi(Library const& library, Shape const& shape, int threads) {
  auto const data = static_cast<std::size_t>(shape.data);
  switch (shape.kind) {
    case ShapeKind::analytic:
      return pointwise(AnalyticField{shape.analytic}, threads);
    case ShapeKind::harmonics:
      return pointwise(RadialField{library.harmonics.at(data), shape.query}, threads);
    case ShapeKind::mesh:
      return pointwise(MeshField{library.mesh.at(data)}, threads);
    case ShapeKind::grid:
      return pointwise(GridField{library.grid.at(data)}, threads);
    case ShapeKind::net:
      break;
  }
  auto const fast = std::make_shared<FastNet const>(library, shape, threads);
  return [fast](Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient) { (*fast)(point, phi, gradient); };
}

PhiBatch surface_phi(Library const& library, Shape const& shape, int threads) {
  if (shape.kind == ShapeKind::analytic && shape.analytic.kind == AnalyticKind::superellipsoid)
    return pointwise(GaugeField(shape.analytic), threads);
  if (shape.kind == ShapeKind::harmonics) {
    std::vector<double> const& c = library.harmonics.at(static_cast<std::size_t>(shape.data));
    return pointwise(RadialGauge{c, shape.query, radius_range(c).least}, threads);
  }
  return fast_phi(library, shape, threads);
}

double surface_lipschitz(Shape const& shape) { return shape.kind == ShapeKind::grid ? 0 : shape.lipschitz; }

void project_to_surface(PhiBatch const& phi, Span<Vec3> point, Span<Vec3> gradient, double reach, int steps,
                        Span<double> remaining) {
  int const n = point.size();
  std::vector<Vec3> const start(point.begin(), point.end());
  std::vector<double> value(n);
  for (int step = 0;; ++step) {
    phi(point, value, gradient);
    if (step == steps) break;
    for (int i = 0; i < n; ++i) {
      double const slope2 = norm2(gradient[i]);
      if (!(slope2 > 1e-6)) continue;  // no direction to go: a point of the medial axis
      Vec3 const moved = point[i] - gradient[i] * (value[i] / slope2) - start[i];
      double const length = norm(moved);
      point[i] = start[i] + (length > reach ? moved * (reach / length) : moved);
    }
  }
  if (!remaining.empty()) std::copy(value.begin(), value.end(), remaining.begin());
}

}  // namespace scree
