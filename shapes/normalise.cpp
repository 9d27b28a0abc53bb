// normalise.cpp: see normalise.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/normalise.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "shapes/support_points.h"
#include "shapes/zero_set.h"

namespace scree {
namespace {

double constexpr margin = 1e-4;  // of bounding radius and box beyond the refined extreme points [d]

// x_net = R (x s) + t and phi = phi_net / s, absorbed by the first and the last layer.
void fold_into_layers(Mlp& net, QueryTransform const& q) {
  int const out = net.width[1];
  for (int j = 0; j < out; ++j) {
    Vec3 const w{net.weight[0][j], net.weight[0][std::size_t(out) + j], net.weight[0][2 * std::size_t(out) + j]};
    Vec3 const turned = transposed_times(q.rotation, w) * q.scale;
    for (int i = 0; i < 3; ++i) net.weight[0][std::size_t(i) * out + j] = static_cast<float>(turned[i]);
    net.bias[0][j] = static_cast<float>(net.bias[0][j] + dot(w, q.shift));
  }
  for (float& w : net.weight.back()) w = static_cast<float>(w / q.scale);
  for (float& b : net.bias.back()) b = static_cast<float>(b / q.scale);
}

bool uses_net_alone(Library const& library, int index) {
  Shape const& s = library.shape[index];
  auto const users = std::count_if(library.shape.begin(), library.shape.end(),
                                   [&](Shape const& o) { return o.is_net() && o.net == s.net; });
  return s.code.empty() && users == 1;
}

// Bounding radius and box of the zero set from the refined extreme points of its vertices.
void set_bounds(PhiBatch const& phi, ZeroSet const& set, Shape& shape) {
  std::vector<Vec3> const& vertex = set.mesh.vertex;
  std::vector<Vec3> direction = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  std::vector<Vec3> start;
  for (int i : extreme_points(vertex, direction)) start.push_back(vertex[i]);
  // The farthest vertices and where they climb along their own direction.
  std::vector<int> order(vertex.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::size_t const far = std::min<std::size_t>(16, order.size());
  std::partial_sort(order.begin(), order.begin() + far, order.end(), [&](int a, int b) {
    return norm2(vertex[a]) != norm2(vertex[b]) ? norm2(vertex[a]) > norm2(vertex[b]) : a < b;
  });
  for (std::size_t i = 0; i < far; ++i) {
    start.push_back(vertex[order[i]]);
    direction.push_back(normalized(vertex[order[i]]));
  }
  std::vector<Vec3> const top = climb(phi, start, direction, set.cell);
  shape.box = {top[0], top[0]};
  shape.bounding_radius = 0;
  for (Vec3 p : top) {
    shape.bounding_radius = std::max(shape.bounding_radius, norm(p) + margin);
    for (int i = 0; i < 3; ++i) {
      shape.box.min[i] = std::min(shape.box.min[i], p[i] - margin);
      shape.box.max[i] = std::max(shape.box.max[i], p[i] + margin);
    }
  }
}

}  // namespace

void principal_axes(Mat3 const& inertia, Vec3& moment, Mat3& axes) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = 0.5 * (inertia.row[i][j] + inertia.row[j][i]);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> const solver(m);
  for (int a = 0; a < 2; ++a) {
    Eigen::Vector3d v = solver.eigenvectors().col(a);
    int largest = 0;
    v.cwiseAbs().maxCoeff(&largest);
    if (v(largest) < 0) v = -v;
    axes.row[a] = {v(0), v(1), v(2)};
  }
  axes.row[2] = cross(axes.row[0], axes.row[1]);
  moment = {solver.eigenvalues()(0), solver.eigenvalues()(1), solver.eigenvalues()(2)};
}

double sampled_lipschitz(PhiBatch const& phi, double radius, int samples, double factor) {
  // Additive recurrence of Roberts (2018): alpha_i = phi_3^-i, phi_3^4 = phi_3 + 1; points outside the ball are
  // skipped.
  double constexpr a[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  int constexpr batch = 4096;
  double steepest = 0;
  long n = 0;
  for (int done = 0; done < samples;) {
    std::vector<Vec3> x;
    while (static_cast<int>(x.size()) < std::min(batch, samples - done)) {
      ++n;
      Vec3 p;
      for (int i = 0; i < 3; ++i) p[i] = radius * (2 * (n * a[i] - std::floor(n * a[i])) - 1);
      if (norm(p) <= radius) x.push_back(p);
    }
    std::vector<double> value(x.size());
    std::vector<Vec3> gradient(x.size());
    phi(x, value, gradient);
    for (Vec3 g : gradient) steepest = std::max(steepest, norm(g));
    done += static_cast<int>(x.size());
  }
  return factor * steepest;
}

RawShape normalise_net(Library& library, int index, double raw_radius, NormaliseOptions const& options) {
  Shape const& shape = library.shape.at(static_cast<std::size_t>(index));
  if (!shape.is_net()) throw std::invalid_argument("normalise_net: shape '" + shape.name + "' is not a network");
  return normalise_shape(library, index, raw_radius, options);
}

RawShape normalise_shape(Library& library, int index, double raw_radius, NormaliseOptions const& options) {
  Shape& shape = library.shape.at(static_cast<std::size_t>(index));
  if (!shape.is_net() && shape.kind != ShapeKind::harmonics)
    throw std::invalid_argument("normalise_shape: shape '" + shape.name + "' has no query transform");
  RawShape raw;
  PhiBatch const phi_before = fast_phi(library, shape, options.threads);
  ZeroSet set = find_zero_set(phi_before, {raw_radius, options.cells, 0});
  MeshMass const mass = zero_set_mass(phi_before, set);
  if (!(mass.volume > 0)) throw std::runtime_error("shape '" + shape.name + "': its zero set encloses no volume");
  raw.volume = mass.volume;
  raw.area = mass.area;
  raw.diameter = std::cbrt(6 * mass.volume / std::numbers::pi);
  raw.centroid = mass.centroid;
  raw.components = set.components;
  raw.euler_characteristic = set.euler_characteristic;
  principal_axes(mass.inertia, raw.inertia, raw.axes);
  // x_raw = axes^T (x d) + c, then what the shape had before.
  QueryTransform const before = shape.query;
  shape.query.rotation = before.rotation * transpose(raw.axes);
  shape.query.shift = before.rotation * (raw.centroid * before.scale) + before.shift;
  shape.query.scale = before.scale * raw.diameter;
  if (shape.is_net() && uses_net_alone(library, index)) {
    fold_into_layers(library.net[shape.net], shape.query);
    shape.query = {};
  }
  double const d = raw.diameter;
  shape.volume = std::numbers::pi / 6;
  shape.area = raw.area / (d * d);
  shape.inertia = raw.inertia / (d * d * d * d * d);
  shape.certificate.components = raw.components;
  PhiBatch const phi = fast_phi(library, shape, options.threads);
  // The same surface in the new frame: a second search could leave the ball the network was trained in.
  for (Vec3& v : set.mesh.vertex) v = raw.axes * (v - raw.centroid) / d;
  set.cell /= d;
  set_bounds(phi, set, shape);
  if (shape.is_net())
    shape.lipschitz =
        sampled_lipschitz(phi, 1.1 * shape.bounding_radius, options.lipschitz_samples, options.lipschitz_factor);
  return raw;
}

}  // namespace scree
