// compact_grain.cpp: see compact_grain.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/compact_grain.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "shapes/compact_nodes.h"
#include "shapes/normalise.h"
#include "shapes/support_points.h"

namespace scree {
namespace {

int constexpr first_look = 200;         // directions of the first search, which only finds the inertia ellipsoid
int constexpr lipschitz_samples = 400;  // enough to notice a decoder that is steeper here than at its trained codes

// Columns: semi-axes of the ellipsoid that has this inertia and volume.
Mat3 inertia_ellipsoid(MeshMass const& mass) {
  Vec3 inertia;
  Mat3 axes;
  principal_axes(mass.inertia, inertia, axes);
  double const sum = inertia.x + inertia.y + inertia.z;
  Mat3 map = transpose(axes);
  for (Vec3& row : map.row)
    for (int k = 0; k < 3; ++k) row[k] *= std::sqrt(2.5 / mass.volume * (sum - 2 * inertia[k]));
  return map;
}

// Surface points to climb from: the highest in a direction, and others nearly as high elsewhere.
void add_starts(std::vector<Vec3> const& surface, std::vector<double> const& height, double apart, int count,
                std::vector<Vec3>& start) {
  std::size_t const before = start.size();
  for (int k = 0; k < count; ++k) {
    int best = -1;
    for (std::size_t i = 0; i < surface.size(); ++i) {
      bool const near = std::any_of(start.begin() + before, start.end(),
                                    [&](Vec3 s) { return norm2(s - surface[i]) < apart * apart; });
      if (!near && (best < 0 || height[i] > height[best])) best = static_cast<int>(i);
    }
    if (best >= 0) start.push_back(surface[best]);
  }
}

// Bounding radius and box from the extreme points, refined by climbing between the nodes.
void set_bounds(PhiBatch const& phi, std::vector<Vec3> const& surface, double spacing, CompactGrain& grain) {
  int constexpr tops = 4, farthest = 8, rounds = 24;  // sharp corners hide between nodes
  double constexpr margin = 1e-3;  // climbing stops at a fiftieth of the spacing, of which the height errs by less
  std::vector<Vec3> start, direction;
  std::vector<double> height(surface.size());
  for (int axis = 0; axis < 3; ++axis)
    for (int sign : {-1, 1}) {
      for (std::size_t i = 0; i < surface.size(); ++i) height[i] = sign * surface[i][axis];
      add_starts(surface, height, 4 * spacing, tops, start);
      Vec3 d;
      d[axis] = sign;
      direction.resize(start.size(), d);
    }
  for (std::size_t i = 0; i < surface.size(); ++i) height[i] = norm2(surface[i]);
  add_starts(surface, height, 4 * spacing, farthest, start);
  for (std::size_t k = direction.size(); k < start.size(); ++k) direction.push_back(normalized(start[k]));
  std::vector<Vec3> extreme = climb(phi, start, direction, 0.5 * spacing, rounds);
  extreme.insert(extreme.end(), surface.begin(), surface.end());
  grain.box = {extreme[0], extreme[0]};
  grain.bounding_radius = 0;
  for (Vec3 p : extreme) {
    grain.bounding_radius = std::max(grain.bounding_radius, norm(p) + margin);
    for (int i = 0; i < 3; ++i) {
      grain.box.min[i] = std::min(grain.box.min[i], p[i] - margin);
      grain.box.max[i] = std::max(grain.box.max[i], p[i] + margin);
    }
  }
}

// phi of a decoder with one code's bias row, in the network's frame.
PhiBatch decoder_phi(PackedMlp const& net, Span<const float> code) {
  std::vector<float> bias;
  net.append_bias(fold_code(net.net(), code), bias);
  return [&net, bias](Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient) {
    int const n = point.size();
    std::vector<Vec3f> x(n), slope(gradient.empty() ? 0 : n);
    std::vector<float> value(n);
    for (int i = 0; i < n; ++i) x[i] = to_float(point[i]);
    if (gradient.empty())
      sdf_forward({}, net, bias, x, {}, value);
    else
      sdf_forward_gradient({}, net, bias, x, {}, value, slope);
    for (int i = 0; i < n; ++i) phi[i] = value[i];
    for (int i = 0; i < gradient.size(); ++i) gradient[i] = to_double(slope[i]);
  };
}

// phi in the frame and unit that `query` makes.
PhiBatch in_body_frame(PhiBatch const& phi, QueryTransform const& query) {
  return [&phi, query](Span<const Vec3> point, Span<double> value, Span<Vec3> gradient) {
    std::vector<Vec3> x(point.size());
    for (int i = 0; i < point.size(); ++i) x[i] = query.rotation * (point[i] * query.scale) + query.shift;
    phi(x, value, gradient);
    for (int i = 0; i < point.size(); ++i) value[i] /= query.scale;
    for (Vec3& g : gradient) g = transposed_times(query.rotation, g);
  };
}

DirectionSet const& first_directions() {
  static DirectionSet const set = make_direction_set(first_look);
  return set;
}

}  // namespace

GrainFault make_compact_grain(PhiBatch const& phi, double ball, double lipschitz, DirectionSet const& set,
                              CompactGrain& grain) {
  Mat3 identity;
  std::vector<double> radius;
  Rays rays{{}, identity};
  DirectionSet const& coarse = first_directions();
  GrainFault fault = find_radii(phi, rays, coarse.direction, 0.5 * ball, ball, radius);
  if (fault != GrainFault::none) return fault;
  MeshMass mass = star_mass(rays, coarse, radius);
  rays = {mass.centroid, inertia_ellipsoid(mass)};
  fault = find_radii(phi, rays, set.direction, 1, ball, radius);
  if (fault != GrainFault::none) return fault;

  mass = star_mass(rays, set, radius);
  mass.area = star_area(phi, rays, set, radius);
  if (!(mass.area > 0)) return GrainFault::not_star_shaped;

  double const d = std::cbrt(6 * mass.volume / std::numbers::pi);
  Mat3 axes;
  principal_axes(mass.inertia, grain.inertia, axes);
  grain.query = {transpose(axes), mass.centroid, d};
  grain.inertia = grain.inertia / (d * d * d * d * d);
  grain.area = mass.area / (d * d);
  // x = axes (x_net - centroid) / d
  Rays in_body{axes * (rays.origin - mass.centroid) / d, axes * rays.map};
  for (Vec3& row : in_body.map.row) row = row / d;
  std::vector<Vec3> surface(set.count());
  for (int i = 0; i < set.count(); ++i) surface[i] = in_body.at(set.direction[i], radius[i]);
  PhiBatch const body_phi = in_body_frame(phi, grain.query);
  double const spacing = std::sqrt(grain.area / set.count());
  set_bounds(body_phi, surface, spacing, grain);
  if (!looks_star_shaped(body_phi, in_body, set, radius, grain.bounding_radius)) return GrainFault::not_star_shaped;
  grain.lipschitz = std::max(
      lipschitz, sampled_lipschitz(body_phi, std::min(1.1 * grain.bounding_radius, ball / d), lipschitz_samples, 1.1));
  encode_nodes(in_body, set, radius, grain);
  return GrainFault::none;
}

CompactGrainMaker::CompactGrainMaker(Library const& library, int net, int nodes)
    : net_(library.net.at(static_cast<std::size_t>(net))), set_(make_direction_set(nodes)) {
  for (Shape const& s : library.shape) {
    if (!s.is_net() || s.net != net) continue;
    ball_ = std::max(ball_, norm(s.query.shift) + 1.1 * s.bounding_radius * s.query.scale);
    lipschitz_ = std::max(lipschitz_, s.lipschitz);
  }
  if (!(ball_ > 0))
    throw std::invalid_argument("CompactGrainMaker: no shape of the library uses network " + std::to_string(net));
}

GrainFault CompactGrainMaker::make(Span<const float> code, CompactGrain& grain) const {
  if (code.size() != net_.net().code_size())
    throw std::invalid_argument("CompactGrainMaker: the code has " + std::to_string(code.size()) +
                                " numbers, the decoder takes " + std::to_string(net_.net().code_size()));
  return make_compact_grain(decoder_phi(net_, code), ball_, lipschitz_, set_, grain);
}

void adopt(CompactGrain const& grain, Shape& shape) {
  shape.query = grain.query;
  shape.volume = std::numbers::pi / 6;
  shape.area = grain.area;
  shape.inertia = grain.inertia;
  shape.bounding_radius = grain.bounding_radius;
  shape.box = grain.box;
  shape.lipschitz = grain.lipschitz;
}

Shape to_shape(CompactGrain const& grain, int net, Span<const float> code, std::string name) {
  Shape s;
  s.name = std::move(name);
  s.kind = ShapeKind::net;
  s.net = net;
  s.code.assign(code.begin(), code.end());
  adopt(grain, s);
  return s;
}

}  // namespace scree
