// align.cpp: see align.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/align.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "shapes/certify_phi.h"
#include "shapes/mesh_normalise.h"

namespace scree {
namespace {

int constexpr coarse_points = 400, fine_points = 4000;
int constexpr starts = 6;     // that are followed
int constexpr steps = 12;     // of Gauss and Newton
int constexpr turns = 8;      // tried in a quarter of a turn about the axis of two like moments ...
double constexpr like = 0.1;  // ... which differ by less than this, relative

// The 24 rotations of a cube.
std::vector<Mat3> cube_rotations() {
  std::vector<Mat3> out;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Mat3 m{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
      for (int k = 0; k < 3; ++k) m.row[k][order[static_cast<std::size_t>(k)]] = signs >> k & 1 ? -1 : 1;
      if (dot(cross(m.row[0], m.row[1]), m.row[2]) > 0) out.push_back(m);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return out;
}

std::vector<Mat3> start_rotations(TriangleMesh const& mesh, Normalisation const& n) {
  Mat3 const inertia = n.rotation * mesh_mass(mesh).inertia * transpose(n.rotation);
  std::vector<Mat3> turned{Mat3{}};
  for (int axis = 0; axis < 3; ++axis) {
    int const j = (axis + 1) % 3, k = (axis + 2) % 3;
    if (std::abs(inertia.row[j][j] / inertia.row[k][k] - 1) > like) continue;
    for (int i = 1; i < turns; ++i) {
      Vec3 angle;
      angle[axis] = i * std::numbers::pi / 2 / turns;
      turned.push_back(to_matrix(quat_from_rotation_vector(angle)));
    }
  }
  std::vector<Mat3> out;
  for (Mat3 const& cube : cube_rotations())
    for (Mat3 const& turn : turned) out.push_back(cube * turn * n.rotation);
  return out;
}

double rms_of(PhiBatch const& phi, BodyFrame const& frame, std::vector<Vec3> const& point_body) {
  std::vector<Vec3> point;
  for (Vec3 const& x : point_body) point.push_back(frame.to_shape(x));
  std::vector<double> value(point.size());
  phi(point, value, {});
  double sum = 0;
  for (double v : value) sum += v * v;
  return std::sqrt(sum / static_cast<double>(value.size()));
}

// x -> exp(turn) x (1 - grow) + move in the shape's frame, to first order the step that makes phi vanish.
BodyFrame stepped(PhiBatch const& phi, BodyFrame const& frame, std::vector<Vec3> const& point_body) {
  std::vector<Vec3> point;
  for (Vec3 const& x : point_body) point.push_back(frame.to_shape(x));
  std::vector<double> value(point.size());
  std::vector<Vec3> gradient(point.size());
  phi(point, value, gradient);
  Eigen::Matrix<double, 7, 7> normal = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Matrix<double, 7, 1> right = Eigen::Matrix<double, 7, 1>::Zero();
  for (std::size_t i = 0; i < point.size(); ++i) {
    Vec3 const g = gradient[i], by_turn = cross(point[i], g);
    Eigen::Matrix<double, 7, 1> row;
    row << by_turn.x, by_turn.y, by_turn.z, g.x, g.y, g.z, -dot(g, point[i]);
    normal += row * row.transpose();
    right -= row * value[i];
  }
  // A body of revolution leaves a turn open: the damping lets it rest.
  normal.diagonal().array() += 1e-6 * normal.trace() / 7;
  Eigen::Matrix<double, 7, 1> const step = normal.ldlt().solve(right);
  BodyFrame next;
  next.rotation = to_matrix(normalized(quat_from_rotation_vector({step[0], step[1], step[2]}))) * frame.rotation;
  next.scale = frame.scale * std::exp(step[6]);
  next.shift = frame.shift - transposed_times(next.rotation, Vec3{step[3], step[4], step[5]}) * next.scale;
  return next;
}

// The best frame on the way.
Alignment follow(PhiBatch const& phi, Alignment best, std::vector<Vec3> const& point) {
  best.rms = rms_of(phi, best.frame, point);
  BodyFrame frame = best.frame;
  for (int i = 0; i < steps; ++i) {
    frame = stepped(phi, frame, point);
    double const rms = rms_of(phi, frame, point);
    if (!std::isfinite(rms)) break;
    if (rms < best.rms) best = {frame, rms};
  }
  return best;
}

}  // namespace

Alignment align_shape(PhiBatch const& phi, TriangleMesh const& mesh) {
  Normalisation const n = normalisation_of(mesh);
  std::vector<Vec3> const coarse = surface_points(mesh, coarse_points).position;
  std::vector<Alignment> tried;
  for (Mat3 const& rotation : start_rotations(mesh, n)) {
    BodyFrame const frame{rotation, n.centroid, 1 / n.scale};
    tried.push_back({frame, rms_of(phi, frame, coarse)});
  }
  auto const less = [](Alignment const& a, Alignment const& b) { return a.rms < b.rms; };
  std::stable_sort(tried.begin(), tried.end(), less);
  tried.resize(std::min<std::size_t>(tried.size(), starts));
  for (Alignment& a : tried) a = follow(phi, a, coarse);
  return follow(phi, *std::min_element(tried.begin(), tried.end(), less), surface_points(mesh, fine_points).position);
}

}  // namespace scree
