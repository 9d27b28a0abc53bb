// contact_errors.cpp: see contact_errors.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/contact_errors.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shapes/random.h"
#include "shapes/surface_nodes.h"

namespace scree {
namespace {

int constexpr block_size = 32;
double constexpr rounding = 1e-4;  // of fast_phi, and ten times more [d]
int constexpr coarse_points = 400;

// Points of a cover that are inside a body, and how deep.
struct Inside {
  std::vector<int> point;
  std::vector<Vec3> at;  // in the body's frame [d]
};

// Which points of the cover may be inside: `place` takes them into the body's frame. As the engine culls: a block whose
// centre is further out than its radius cannot reach the body, and nothing outside its bounding ball is inside.
template <class Place>
Inside near_points(PhiBatch const& phi, Shape const& shape, SurfaceCover const& cover, Place const& place) {
  Inside out;
  std::vector<Vec3> centre;
  std::vector<int> block;
  double const ball = shape.bounding_radius, slope = std::max(1.0, shape.lipschitz);
  auto const keep = [&](int b) {
    for (int i = cover.blocks.first[b]; i < cover.blocks.first[b + 1]; ++i) {
      Vec3 const x = place(cover.position[cover.blocks.order[i]]);
      if (norm2(x) < ball * ball) out.point.push_back(cover.blocks.order[i]), out.at.push_back(x);
    }
  };
  for (std::size_t b = 0; b < cover.blocks.centre.size(); ++b) {
    Vec3 const c = place(cover.blocks.centre[b]);
    if (norm(c) - ball > cover.blocks.radius[b]) continue;
    if (norm2(c) < ball * ball)
      centre.push_back(c), block.push_back(static_cast<int>(b));
    else
      keep(static_cast<int>(b));
  }
  std::vector<double> depth(centre.size());
  phi(centre, depth, {});
  for (std::size_t k = 0; k < block.size(); ++k)
    if (depth[k] > -slope * cover.blocks.radius[block[k]]) keep(block[k]);
  return out;
}

// Integral of p grad phi over the part of the cover that is inside.
template <class Place>
Vec3 one_side(ContactPhi const& phi, Shape const& shape, SurfaceCover const& cover, PressureLaw const& law,
              double diameter, Place const& place) {
  Inside const near = near_points(phi.fast, shape, cover, place);
  std::vector<double> depth(near.at.size());
  phi.fast(near.at, depth, {});
  std::vector<Vec3> inside;
  std::vector<double> area;
  for (std::size_t i = 0; i < depth.size(); ++i)
    if (depth[i] > -rounding) inside.push_back(near.at[i]), area.push_back(cover.area[near.point[i]]);
  std::vector<Vec3> gradient(inside.size());
  depth.resize(inside.size());
  phi.exact(inside, depth, gradient);
  Vec3 sum;
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (depth[i] > 0) sum += gradient[i] * (area[i] * law.pressure(depth[i] * diameter));
  return sum;
}

SurfaceCover with_blocks(SurfaceCover cover) {
  cover.blocks = make_point_blocks(cover.position, block_size);
  return cover;
}

// The most advanced of b's points: phi of a there; outside a's ball minus the distance to it.
double furthest_in(PhiBatch const& phi, Shape const& shape, std::vector<Vec3> const& points, Mat3 const& turn,
                   Vec3 shift) {
  double largest = -1e300;
  std::vector<Vec3> within;
  for (Vec3 const& p : points) {
    Vec3 const x = turn * p + shift;
    double const out = norm(x) - shape.bounding_radius;
    if (out < 0)
      within.push_back(x);
    else
      largest = std::max(largest, -out);
  }
  std::vector<double> depth(within.size());
  phi(within, depth, {});
  for (double const d : depth) largest = std::max(largest, d);
  return largest;
}

}  // namespace

SurfaceCover node_cover(Library const& library, Shape const& shape, int nodes) {
  SurfaceNodes const made = make_surface_nodes(library, shape, nodes, {.measure_gap = false});
  auto const n = made.n_surface;
  return with_blocks(
      {{made.position.begin(), made.position.begin() + n}, {made.area.begin(), made.area.begin() + n}, {}});
}

SurfaceCover dense_cover(Library const& library, Shape const& shape, int points) {
  DenseSurface dense = make_dense_surface(surface_phi(library, shape), shape, points);
  return with_blocks({std::move(dense.position), std::move(dense.area), {}});
}

std::vector<ContactPose> draw_contacts(PhiBatch const& phi, Shape const& shape, SurfaceCover const& dense, int count,
                                       double overlap, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> coarse;
  std::size_t const every = std::max<std::size_t>(1, dense.position.size() / coarse_points);
  for (std::size_t i = 0; i < dense.position.size(); i += every)
    coarse.push_back(dense.position[dense.blocks.order[i]]);
  std::vector<ContactPose> out;
  for (int tries = 0; static_cast<int>(out.size()) < count; ++tries) {
    if (tries > 100 * count) throw std::runtime_error("'" + shape.name + "': two of it do not find a contact");
    ContactPose pose{normalized(Quat{random.normal(), random.normal(), random.normal(), random.normal()}), {}};
    Vec3 const along = random.direction();
    Mat3 const turn = to_matrix(pose.turn);
    // Sphere tracing of a whole body: no point can come deeper than the way left to the deepest one allows.
    double way = 2 * shape.bounding_radius, depth = 0;
    double const slope = std::max(1.0, shape.lipschitz);
    for (int k = 0; k < 100; ++k) {
      depth = furthest_in(phi, shape, coarse, turn, along * way);
      if (depth > 0.9 * overlap || way <= 0) break;
      way -= std::max(0.01 * overlap, (overlap - depth) / slope);
    }
    // The coarse points, 0.09 d apart, miss the deepest place by up to 1 % d, at corners by more.
    for (int k = 0; k < 20 && way > 0; ++k) {
      Vec3 const shift = along * way;
      Inside const near = near_points(phi, shape, dense, [&](Vec3 x) { return turn * x + shift; });
      std::vector<double> phis(near.at.size());
      phi(near.at, phis, {});
      depth = phis.empty() ? 0 : *std::max_element(phis.begin(), phis.end());
      if (std::abs(depth - overlap) < 0.01 * overlap) break;
      way += std::max(depth - overlap, -overlap);
    }
    if (way <= 0 || std::abs(depth - overlap) > 0.05 * overlap) continue;  // b slipped into a hollow of a
    pose.shift = along * way;
    out.push_back(pose);
  }
  return out;
}

Vec3 contact_force(ContactPhi const& phi, Shape const& shape, SurfaceCover const& cover, ContactPose const& pose,
                   PressureLaw const& law, double diameter) {
  Mat3 const turn = to_matrix(pose.turn);
  Vec3 const from_b = one_side(phi, shape, cover, law, diameter, [&](Vec3 x) { return turn * x + pose.shift; });
  Vec3 const from_a =
      one_side(phi, shape, cover, law, diameter, [&](Vec3 x) { return transposed_times(turn, x - pose.shift); });
  return (turn * from_a - from_b) * 0.5;
}

ContactErrors::ContactErrors(Library const& library, Shape const& shape, PressureLaw const& law, double diameter,
                             double overlap, int points)
    : library_(library), shape_(shape), law_(law), diameter_(diameter), overlap_(overlap), points_(points) {}

void ContactErrors::prepare() {
  if (!contact_.empty()) return;
  phi_ = fast_phi(library_, shape_);
  SurfaceCover const dense = dense_cover(library_, shape_, points_);
  contact_ = draw_contacts(phi_, shape_, dense, wilks_contacts, overlap_, 1);
  for (ContactPose const& pose : contact_)
    exact_.push_back(contact_force({phi_, phi_}, shape_, dense, pose, law_, diameter_));
}

double ContactErrors::at(int nodes) {
  prepare();
  SurfaceCover const cover = node_cover(library_, shape_, nodes);
  double largest = 0;
  for (std::size_t k = 0; k < contact_.size(); ++k)
    largest =
        std::max(largest, norm(contact_force({phi_, phi_}, shape_, cover, contact_[k], law_, diameter_) - exact_[k]) /
                              norm(exact_[k]));
  return largest;
}

}  // namespace scree
