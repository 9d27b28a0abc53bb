// integrate_test.cpp: free rotation in closed form (validation rows 9 and 10).
// SPDX-License-Identifier: Apache-2.0
#include "kernels/integrate.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

Vec3 spin(Quat q, Vec3 inertia, Vec3 l) { return divide(transposed_times(to_matrix(q), l), inertia); }  // body frame

// Dzhanibekov: omega_2 of I = (1, 2, 3) from (1e-3, 1, 1e-3) first changes sign at 14.906, then every 27.531.
TEST(Integrate, IntermediateAxisFlipsOnTime) {
  Vec3 const inertia{1, 2, 3};
  Quat q;
  Vec3 const l = multiply(inertia, Vec3{1e-3, 1, 1e-3});
  double const dt = 2e-3;
  double const energy = 0.5 * dot(l, divide(l, inertia));
  std::vector<double> flips;
  double before = 1, drift = 0;
  for (int i = 1; i * dt < 100; ++i) {
    q = rotate_free(q, inertia, l, dt);
    Vec3 const w = spin(q, inertia, l);
    if (before * w.y < 0) flips.push_back(i * dt - dt * w.y / (w.y - before));
    before = w.y;
    drift = std::max(drift, std::abs(0.5 * dot(w, multiply(inertia, w)) / energy - 1));
  }
  ASSERT_GE(flips.size(), 3u);
  EXPECT_NEAR(flips[0], 14.906, 1e-3 * 14.906);
  EXPECT_NEAR(flips[1] - flips[0], 27.531, 1e-3 * 27.531);
  EXPECT_NEAR(flips[2] - flips[1], 27.531, 1e-3 * 27.531);
  EXPECT_LT(drift, 1e-6);  // second order, bounded
}

// An axisymmetric body precesses about its angular momentum at L / I_perp.
TEST(Integrate, SymmetricBodyPrecesses) {
  Vec3 const inertia{2, 2, 1}, w{0.3, 0, 1};
  Vec3 const l = multiply(inertia, w);
  double const rate = norm(l) / inertia.x, period = 2 * 3.141592653589793 / rate;
  Quat q;
  int const steps = 5000;
  for (int i = 0; i < steps; ++i) q = rotate_free(q, inertia, l, period / steps);
  // After one precession the symmetry axis is back where it was.
  Vec3 const axis = to_matrix(q) * Vec3{0, 0, 1};
  EXPECT_LT(norm(axis - Vec3{0, 0, 1}), 1e-3);
  for (int i = 0; i < steps / 2; ++i) q = rotate_free(q, inertia, l, period / steps);
  EXPECT_GT(norm(to_matrix(q) * Vec3{0, 0, 1} - Vec3{0, 0, 1}), 0.1);
}

}  // namespace
}  // namespace scree
