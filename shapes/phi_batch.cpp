// phi_batch.cpp: see phi_batch.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/phi_batch.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "kernels/sdf/sdf_batch.h"

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
    for (int i = 0; i < n; ++i) x[i] = to_float(query.rotation * (point[i] * query.scale) + query.shift);
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

}  // namespace

PhiBatch reference_phi(Library const& library, Shape const& shape) {
  return [&library, &shape](Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient) {
    for (int i = 0; i < point.size(); ++i)
      phi[i] = evaluate_reference(library, shape, point[i], gradient.empty() ? nullptr : &gradient[i]);
  };
}

PhiBatch fast_phi(Library const& library, Shape const& shape, int threads) {
  if (shape.is_net) {
    auto const fast = std::make_shared<FastNet const>(library, shape, threads);
    return [fast](Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient) { (*fast)(point, phi, gradient); };
  }
  return [sdf = shape.analytic](Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient) {
    for (int i = 0; i < point.size(); ++i)
      phi[i] = signed_distance(sdf, point[i], gradient.empty() ? nullptr : &gradient[i]);
  };
}

PhiBatch surface_phi(Library const& library, Shape const& shape, int threads) {
  if (shape.is_net || shape.analytic.kind != AnalyticKind::superellipsoid) return fast_phi(library, shape, threads);
  return [field = GaugeField(shape.analytic)](Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient) {
    for (int i = 0; i < point.size(); ++i) phi[i] = field.at(point[i], gradient.empty() ? nullptr : &gradient[i]);
  };
}

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
